#include "refine/patch_relaxation.h"

#include <algorithm>

#include "geometry/triangle.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr double over_relaxation = 1.3;
constexpr double least_cosine = 0.3;  ///< between the normals of a triangle and of its corners

}  // namespace

double PatchSurroundings::twice_target_at(const Vec3& p) const {
  if (sizing.uniform()) return twice_target;
  const double edge = sizing.edge(p);
  return twice_target * edge * edge;
}

void PatchRelaxation::gather_triangles_around(std::uint32_t v, std::uint32_t mark) {
  mesh_.around(v, [&](std::uint32_t h) {
    if (common_.triangle_mark[h / 3] == mark) return;
    common_.triangle_mark[h / 3] = mark;
    triangles_.push_back(h / 3);
  });
}

void PatchRelaxation::gather(std::span<const std::uint32_t> centres, int rings, EditJournal& journal) {
  ++mark_;
  vertices_.clear();
  held_centres_.clear();
  triangles_.clear();
  const auto add = [&](std::uint32_t v) {
    if (!movable(v) || common_.vertex_mark[v] == mark_) return;
    common_.vertex_mark[v] = mark_;
    vertices_.push_back(v);
  };
  for (const std::uint32_t v : centres)
    if (mesh_.vertex_in_use(v)) {
      add(v);
      if (!movable(v)) held_centres_.push_back(v);
      gather_triangles_around(v, mark_);
    }
  std::size_t begin = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = vertices_.size();
    for (; begin < end; ++begin) mesh_.around(vertices_[begin], [&](std::uint32_t h) { add(mesh_.target(h)); });
  }
  for (const std::uint32_t v : vertices_) {
    gather_triangles_around(v, mark_);
    mesh_.move(v, mesh_.position(v), journal);
  }
  find_rings();
}

void PatchRelaxation::find_rings() {
  ring_start_.clear();
  ring_.clear();
  for (const std::uint32_t v : vertices_) {
    ring_start_.push_back(static_cast<std::uint32_t>(ring_.size()));
    mesh_.around(v, [&](std::uint32_t h) { ring_.push_back(mesh_.target(h)); });
  }
  ring_start_.push_back(static_cast<std::uint32_t>(ring_.size()));
}

void PatchRelaxation::find_frames() {
  frames_.clear();
  for (const std::uint32_t v : vertices_) {
    const TangentPlane plane(facing_of(mesh_, v).normal);
    frames_.push_back({plane.u, plane.v, common_.twice_target_at(mesh_.position(v))});
  }
}

void PatchRelaxation::relax(std::size_t i) {
  const std::span<const std::uint32_t> ring(ring_.data() + ring_start_[i], ring_start_[i + 1] - ring_start_[i]);
  const Frame& frame = frames_[i];
  const Vec3 p = mesh_.position(vertices_[i]);
  flat_.clear();
  for (const std::uint32_t w : ring) {  // in the tangent plane, as far away as they are
    const Vec3 d = mesh_.position(w) - p;
    const double x = dot(d, frame.u), y = dot(d, frame.v), stretch = std::sqrt(squared_norm(d) / (x * x + y * y));
    flat_.push_back({x * stretch, y * stretch});
  }
  PlaneNewton newton(common_.energy.size_weight, frame.twice_target);
  bool well = true;
  for (std::size_t k = 0; k < flat_.size() && well; ++k)
    well = newton.add(flat_[k], flat_[k + 1 < flat_.size() ? k + 1 : 0]);
  PlanePoint step = well ? newton.step() : middle_of(flat_);
  if (well) {
    step = {over_relaxation * step.x, over_relaxation * step.y};
    double share = 1;
    for (std::size_t k = 0; k < flat_.size(); ++k)
      share = std::min(share, most_shrunk(flat_[k], flat_[k + 1 < flat_.size() ? k + 1 : 0], step));
    step = {share * step.x, share * step.y};
  }
  mesh_.place(vertices_[i], p + step.x * frame.u + step.y * frame.v);
}

void PatchRelaxation::sweep(int sweeps) {
  find_frames();
  for (int k = 0; k < sweeps; ++k)
    for (std::size_t i = 0; i < vertices_.size(); ++i) relax(i);
}

void PatchRelaxation::project() {
  if (!common_.projector) return;
  for (const std::uint32_t v : vertices_) {
    const double edge = norm(mesh_.position(mesh_.target(mesh_.outgoing(v))) - mesh_.position(v));
    mesh_.place(v, common_.projector->project(mesh_.position(v), 0.5 * edge));
  }
}

double PatchSurroundings::find_targets(const Mesh& of) {
  twice_target = 1;
  double area = 0, wanted = 0;
  for (std::size_t t = 0; t < of.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(of, t);
    area += triangle_area(a, b, c);
    wanted += twice_target_at((1.0 / 3) * (a + b + c));
  }
  twice_target = 2 * area / wanted;
  return area;
}

double PatchSurroundings::energy_of(std::uint32_t t) const {
  const auto [i, j, k] = mesh.corners(t);
  const Vec3 &a = mesh.position(i), &b = mesh.position(j), &c = mesh.position(k);
  return energy.of(squared_norm(b - a) + squared_norm(c - b) + squared_norm(a - c), norm(area_normal(a, b, c)),
                   twice_target_at((1.0 / 3) * (a + b + c)));
}

void PatchSurroundings::find_energies() {
  for (std::uint32_t t = 0; t < mesh.triangle_slots(); ++t)
    if (mesh.triangle_in_use(t)) mesh.place_energy(t, energy_of(t));
}

double PatchRelaxation::renew_energies(EditJournal& journal) {
  double growth = 0;
  for (const std::uint32_t t : triangles_) {
    const double energy = common_.energy_of(t);
    growth += energy - mesh_.energy(t);
    mesh_.set_energy(t, energy, journal);
  }
  return growth;
}

bool PatchRelaxation::faces_outwards() const {
  const auto well = [&](std::uint32_t v) { return facing_of(mesh_, v).least_cosine > least_cosine; };
  return std::all_of(vertices_.begin(), vertices_.end(), well) &&
         std::all_of(held_centres_.begin(), held_centres_.end(), well);
}

}  // namespace evenmesh
