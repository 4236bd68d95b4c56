#include "refine/shape_smoothing.h"

#include "core/lbfgs.h"
#include "refine/placement.h"
#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

/// Means over the triangles: 4√3·A / (l₁² + l₂² + l₃²), 1 where all are equilateral; and how much areas vary.
struct Evenness {
  explicit Evenness(const Mesh& mesh) {
    double sum = 0, squares = 0;
    const auto n = static_cast<double>(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const double area = 0.5 * norm(cross(b - a, c - a));
      shape += 4 * std::numbers::sqrt3 * area / (squared_norm(b - a) + squared_norm(c - b) + squared_norm(a - c)) / n;
      sum += area;
      squares += area * area;
    }
    area_variation = std::sqrt(squares * n / (sum * sum) - 1);
  }
  double shape = 0, area_variation = 0;
};

struct SmoothedSphere {
  explicit SmoothedSphere(const ShapeSmoothingOptions& options, unsigned threads = 2,
                          Mesh start = perturbed_sphere(4, 0.012, 3))
      : mesh(std::move(start)) {
    ExecutionContext context(threads);
    const Shape shape = gallery_shape("sphere");
    const auto projector = make_projector(shape, shape.bounds, context);
    result = smooth_shapes(mesh, projector.get(), SizingField(1), options, context);
  }
  Mesh mesh;
  ShapeSmoothingResult result;
};

TEST(ShapeSmoothing, MakesTrianglesMoreEquilateralOnTheSurface) {
  const Mesh before = perturbed_sphere(4, 0.012, 3);
  const SmoothedSphere after({.evaluations = 60});
  EXPECT_LT(after.result.energy, 0.25 * after.result.energy_before);
  EXPECT_LE(after.result.evaluations, 70u);
  EXPECT_EQ(after.mesh.triangles, before.triangles);
  EXPECT_GT(Evenness(after.mesh).shape, 0.99);
  EXPECT_GT(worst_score(after.mesh), 1);
  for (const Vec3& v : after.mesh.vertices) EXPECT_NEAR(norm(v), 1, 1e-9);
}

TEST(ShapeSmoothing, TheDialChoosesBetweenShapeAndSize) {
  const auto with = [](double evenness) {
    return Evenness(SmoothedSphere({.size_weight = size_weight_of(evenness), .evaluations = 200}).mesh);
  };
  const Evenness shapes = with(0), sizes = with(1);
  EXPECT_GT(shapes.shape, sizes.shape);
  EXPECT_GT(shapes.area_variation, sizes.area_variation);
  EXPECT_NEAR(size_weight_of(0.5), 0.1, 1e-12);
}

TEST(ShapeSmoothing, ThreadsDoNotMatter) {
  const SmoothedSphere one({}, 1), many({}, 7);
  EXPECT_EQ(one.mesh.vertices, many.mesh.vertices);
  EXPECT_EQ(one.result.energy, many.result.energy);
}

TEST(ShapeSmoothing, BoundariesAndDegenerateTrianglesDoNotMove) {
  ExecutionContext context(2);
  Mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0.4, 0}}, .triangles = {}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}};
  const Mesh before = mesh;
  smooth_shapes(mesh, nullptr, SizingField(1), {}, context);
  for (const Vec3& v : mesh.vertices) EXPECT_TRUE(is_finite(v));
  EXPECT_EQ(mesh.vertices[3], before.vertices[3]);
  Mesh none;
  EXPECT_EQ(smooth_shapes(none, nullptr, SizingField(1), {}, context).evaluations, 0u);
}

/// A roof: planes that meet in the ridge y = 0.
TEST(ShapeSmoothing, PlanesHoldVerticesToRidges) {
  ExecutionContext context(2);
  constexpr int n = 9, middle = n / 2;
  Mesh roof;
  Random random(2);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = i + 0.5 * (j % 2) + 0.1 * random.gaussian(), y = 0.87 * (j - middle);
      roof.vertices.push_back({x, y, -std::abs(y)});
    }
  for (std::uint32_t j = 0; j + 1 < n; ++j)
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t a = j * n + i, b = a + 1, c = a + n, d = c + 1;
      if (j % 2 == 0)
        roof.triangles.insert(roof.triangles.end(), {{a, b, c}, {b, d, c}});
      else
        roof.triangles.insert(roof.triangles.end(), {{a, b, d}, {a, d, c}});
    }
  std::vector<CellPlanes> planes;
  for (const Vec3& v : roof.vertices) {
    planes.push_back({v, {}});
    for (const double side : {-0.4, 0.4}) {
      const double y = v.y + side, way = std::abs(y) < 1e-9 ? 0 : y > 0 ? 1 : -1;
      planes.back().quadric.add_plane({0, side, -std::abs(y) - v.z}, normalized({0, way, 1}), 0.5);
    }
  }
  const auto off_ridge = [&](std::span<const CellPlanes> of) {
    Mesh mesh = roof;
    smooth_shapes(mesh, nullptr, SizingField(1), {.evaluations = 40, .planes = of}, context);
    double most = 0;
    for (std::size_t i = 1; i + 1 < n; ++i) most = std::max(most, std::abs(mesh.vertices[middle * n + i].y));
    return most;
  };
  EXPECT_LT(off_ridge(planes), 0.5 * off_ridge({}));
}

struct Scalar {
  double x = 0;
  Scalar& operator+=(Scalar o) {
    x += o.x;
    return *this;
  }
  Scalar& operator-=(Scalar o) {
    x -= o.x;
    return *this;
  }
  Scalar& operator*=(double s) {
    x *= s;
    return *this;
  }
  friend Scalar operator*(double s, Scalar a) { return a *= s; }
  friend double dot(Scalar a, Scalar b) { return a.x * b.x; }
};

TEST(LimitedMemoryHessian, LeadsToTheMinimumOfAQuadric) {
  ExecutionContext context(1);
  const VariableAlgebra<Scalar> algebra(context);
  LimitedMemoryHessian<Scalar> hessian(algebra);
  const std::vector<double> curvature{1, 10, 4, 0.5};
  std::vector<Scalar> at(4), gradient(4);
  for (std::size_t i = 0; i < 4; ++i) {
    at[i].x = 1;
    gradient[i].x = curvature[i];
  }
  for (int step = 0; step < 30; ++step) {
    const std::vector<Scalar> direction = hessian.direction(gradient, std::vector<double>(4, 0.1));
    std::vector<Scalar> change(4);
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] += direction[i];
      change[i].x = curvature[i] * direction[i].x;
      gradient[i] += change[i];
    }
    hessian.add(direction, change);
  }
  for (const Scalar& a : at) EXPECT_NEAR(a.x, 0, 1e-6);
}

}  // namespace
}  // namespace evenmesh
