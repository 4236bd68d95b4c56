#include "sample/projector.h"

#include "evenmesh/error.h"
#include "geometry/closest_point.h"
#include "refine/refine_testing.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

TEST(MeshProjector, FindsTheClosestPointWithinTheLimit) {
  evenmesh::ExecutionContext context(1);
  const Mesh mesh = make_torus();
  const Shape shape = shape_from_mesh(mesh);
  const auto projector = make_projector(shape, shape.bounds, context);
  const SurfaceQuery surface(mesh);
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const double x = 3 * random.uniform() - 1.5, y = 3 * random.uniform() - 1.5, z = random.uniform() - 0.5;
    const Vec3 p{x, y, z}, q = projector->project(p, 0.2);
    if (surface.closest(p, 0.2).found())
      EXPECT_LT(surface.closest(q).squared_distance, 1e-20);
    else
      EXPECT_EQ(q, p);
  }
}

TEST(MeshProjector, CapsAreFacesOfTheBounds) {
  evenmesh::ExecutionContext context(1);
  const Shape shape = shape_from_mesh(make_icosphere(4));
  const Box bounds{{-2, -2, -2}, {0.5, 2, 2}};
  const auto projector = make_projector(shape, bounds, context);
  const auto expect_near = [](const Vec3& p, const Vec3& q) { EXPECT_LT(norm(p - q), 0.004); };  // of the faceted ball
  expect_near(projector->project({0.53, 0.2, 0.1}, 0.2), {0.5, 0.2, 0.1});
  expect_near(projector->project({0.45, 0.2, 0.1}, 0.2), {0.5, 0.2, 0.1});
  expect_near(projector->project({0, 0, 1.03}, 0.2), {0, 0, 1});
  expect_near(projector->project({-1.1, 0, 0}, 0.2), {-1, 0, 0});
  const Vec3 rim{0.5, std::sqrt(0.75), 0};
  EXPECT_LT(norm(projector->project(rim + Vec3{0.05, 0.02, 0}, 0.2) - rim), 0.06);
  EXPECT_LE(projector->project(rim + Vec3{0.05, -0.01, 0}, 0.2).x, 0.5);
  const Vec3 middle{0, 0, 0};
  EXPECT_EQ(projector->project(middle, 0.2), middle) << "no surface within the limit";
}

TEST(FieldProjector, LandsOnTheZeroSet) {
  evenmesh::ExecutionContext context(1);
  for (const char* name : {"sphere", "torus", "tangle", "octic", "heart"}) {
    const Shape shape = gallery_shape(name);
    const auto projector = make_projector(shape, shape.bounds, context);
    const SampleSet samples = sample_shape(shape, make_grid(shape.bounds, 24), context);
    const double h = samples.grid.spacing;
    Random random(2);
    std::size_t missed = 0;
    for (const SampleBlock& block : samples.blocks)
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const double x = random.uniform() - 0.5, y = random.uniform() - 0.5, z = random.uniform() - 0.5;
        const Vec3 p =
            samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]} + 0.2 * h * Vec3{x, y, z};
        const Vec3 q = projector->project(p, h);
        ASSERT_LE(norm(q - p), h * (1 + 1e-9));
        Vec3 gradient;
        const double value = shape.field()->evaluate(q, &gradient);
        missed += std::abs(value) > 1e-6 * h * norm(gradient) + 1e-12;
      }
    EXPECT_LE(missed, samples.size() / 100) << name;
  }
}

TEST(FieldProjector, FindsTheSphereInDoublePrecision) {
  evenmesh::ExecutionContext context(1);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context);
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian(), r = 0.95 + 0.1 * random.uniform();
    EXPECT_NEAR(norm(projector->project(r * normalized({x, y, z}), 0.1)), 1, 1e-12);
  }
  const Vec3 far{0.2, 0.1, 0};
  EXPECT_EQ(projector->project(far, 0.1), far) << "no surface within the limit";
}

TEST(FieldProjector, CapsAreFacesOfTheBounds) {
  evenmesh::ExecutionContext context(1);
  // A ball cut flat at x = 0.5.
  const Box bounds{{-1.1, -1.1, -1.1}, {0.5, 1.1, 1.1}};
  const Shape shape = shape_from_expression("r - 1", {}, bounds);
  const auto projector = make_projector(shape, bounds, context);
  for (const double y : {0.0, 0.3, -0.6})
    for (const double x : {0.47, 0.5, 0.53}) EXPECT_NEAR(projector->project({x, y, 0.1}, 0.2).x, 0.5, 1e-12);
  EXPECT_NEAR(norm(projector->project({-0.9, 0.1, 0.4}, 0.2)), 1, 1e-12);
  // Around the rim: on the ball and not beyond the cap, or on the cap and not outside the ball.
  Random random(4);
  for (int n = 0; n < 200; ++n) {
    const double angle = 6.283 * random.uniform(), dx = 0.06 * (random.uniform() - 0.5),
                 dr = 0.06 * (random.uniform() - 0.5);
    const double rim = std::sqrt(0.75) + dr;
    const Vec3 q = projector->project({0.5 + dx, rim * std::cos(angle), rim * std::sin(angle)}, 0.2);
    EXPECT_NEAR(std::max(norm(q) - 1, q.x - 0.5), 0, 1e-6);
  }
}

TEST(StepOnto, LandsWhatIsNearAndLeavesTheRest) {
  const double h = 0.02;
  const Shape shape = gallery_shape("torus");
  const Field& field = *shape.field();
  Random random(5);
  std::vector<Vec3> near, far;
  const auto somewhere = [&] { return 2 * random.uniform() - 1; };
  while (near.size() < 300) {
    Vec3 gradient, p{somewhere(), somewhere(), somewhere()};
    for (int step = 0; step < 20; ++step) {
      const double value = field.evaluate(p, &gradient);
      p -= gradient * (value / squared_norm(gradient));
    }
    if (!(std::abs(field.evaluate(p, &gradient)) < 1e-9)) continue;
    near.push_back(p + normalized(gradient) * (h * somewhere()));
    far.push_back(p + normalized(gradient) * (5 * h));
  }
  const std::vector<Vec3> left = far;
  const Box everywhere{{-9, -9, -9}, {9, 9, 9}};
  step_onto(near, field, everywhere, 2 * h);
  step_onto(far, field, everywhere, 2 * h);
  EXPECT_EQ(far, left);
  for (const Vec3& p : near) {
    Vec3 gradient;
    const double value = field.evaluate(p, &gradient);
    EXPECT_LT(std::abs(value) / norm(gradient), 1e-2 * h * h);
  }
  // Near faces of the bounds, which may be the surface, nothing moves.
  std::vector<Vec3> capped = near;
  for (Vec3& p : capped) p *= 1.001;
  const std::vector<Vec3> before = capped;
  Box bounds;
  for (const Vec3& p : capped) bounds.add(p);
  step_onto(capped, field, bounds, 2 * h);
  for (std::size_t i = 0; i < capped.size(); ++i)
    for (int a = 0; a < 3; ++a)
      if (std::min(before[i][a] - bounds.lo[a], bounds.hi[a] - before[i][a]) < h) {
        EXPECT_EQ(capped[i], before[i]);
      }
}

TEST(Projector, IndicatorsHaveNone) {
  evenmesh::ExecutionContext context(1);
  const Shape shape =
      shape_from_indicator([](const Vec3& p) { return norm(p) < 1; }, {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}});
  EXPECT_EQ(make_projector(shape, shape.bounds, context), nullptr);
}

}  // namespace
}  // namespace evenmesh
