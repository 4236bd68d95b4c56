#include "refine/dislocation_moves.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr int highest_cost = 8;  ///< of a chain on its way
constexpr int rings = 3;
constexpr int first_sweeps = 4, last_sweeps = 10;
constexpr double hopeless = 0.5;  ///< energy that the last sweeps cannot gain

double weight_of(int cost) {
  static const std::array<double, 33> table = [] {
    std::array<double, 33> weights{};
    for (int i = 0; i < 33; ++i) weights[static_cast<std::size_t>(i)] = std::exp(-0.8 * (i - 16));
    return weights;
  }();
  return cost > 16 ? 0 : table[static_cast<std::size_t>(std::max(cost, -16) + 16)];
}

}  // namespace

bool DislocationMoves::made_here(std::uint32_t a, std::uint32_t b) const {
  return std::find(made_.begin(), made_.end(), std::array{std::min(a, b), std::max(a, b)}) != made_.end();
}

void DislocationMoves::consider(const Edit& edit, double share) {
  if (cost_ + edit.cost > highest_cost) return;
  const double weight = share * weight_of(edit.cost);
  weight_ += weight;
  if (random_.uniform() * weight_ < weight) chosen_ = edit;
}

void DislocationMoves::consider_flip(std::uint32_t h) {
  const std::uint32_t o = mesh_.opposite(h);
  const std::uint32_t a = mesh_.origin(h), b = mesh_.origin(o), c = mesh_.apex(h), d = mesh_.apex(o);
  if (!mine(a) || !mine(b) || !mine(c) || !mine(d)) return;
  if (constraints_.edge(a, b) || made_here(a, b)) return;
  consider({Kind::flip, h, none, change(a, -1) + change(b, -1) + change(c, 1) + change(d, 1)}, 1);
}

void DislocationMoves::consider_collapse(std::uint32_t h) {
  const std::uint32_t o = mesh_.opposite(h);
  const std::uint32_t a = mesh_.origin(h), b = mesh_.origin(o), c = mesh_.apex(h), d = mesh_.apex(o);
  if (!mine(a) || !mine(b) || !mine(c) || !mine(d) || common_.held[a] || made_here(a, b)) return;
  const int cost = valence_cost(mesh_.valence(a) + mesh_.valence(b) - 4) - valence_cost(mesh_.valence(a)) -
                   valence_cost(mesh_.valence(b)) + change(c, -1) + change(d, -1);
  consider({Kind::collapse, h, none, cost}, climb_share_);
}

/// Those of which one of the two vertices that get another edge is `wing`, any if it is none.
void DislocationMoves::consider_splits(std::uint32_t v, std::uint32_t wing) {
  if (!mine(v) || common_.held[v] || slots_.vertices.empty() || slots_.triangles.size() < 2) return;
  std::array<std::uint32_t, 9> fan;
  std::size_t n = 0;
  mesh_.around(v, [&](std::uint32_t h) {
    if (n < fan.size()) fan[n] = h;
    ++n;
  });
  if (n > fan.size()) return;
  const int before = valence_cost(static_cast<std::uint32_t>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t a = mesh_.target(fan[i]);
    if (!mine(a) || (wing != none && a != wing)) continue;
    for (std::size_t k = 2; k + 2 <= n; ++k) {
      const std::uint32_t last = fan[(i + k) % n], b = mesh_.target(last);
      if (!mine(b)) continue;
      const int cost = valence_cost(static_cast<std::uint32_t>(k + 2)) +
                       valence_cost(static_cast<std::uint32_t>(n - k + 2)) - before + change(a, 1) + change(b, 1);
      consider({Kind::split, fan[i], last, cost}, climb_share_);
    }
  }
}

bool DislocationMoves::choose(std::uint32_t v, Edit& edit) {
  weight_ = 0;
  chosen_ = {};
  const std::uint32_t valence = mesh_.valence(v);
  mesh_.around(v, [&](std::uint32_t h) {
    consider_flip(h);
    consider_collapse(h);
    consider_collapse(mesh_.opposite(h));
    if (valence < 6) {
      consider_flip(mesh_.next(h));
      consider_splits(mesh_.target(h), v);
    } else if (valence > 6) {
      consider_collapse(mesh_.next(h));
    }
  });
  if (valence > 6) consider_splits(v, none);
  edit = chosen_;
  return edit.first != none;
}

void DislocationMoves::touch(std::uint32_t v) {
  if (std::find(touched_.begin(), touched_.end(), v) == touched_.end()) touched_.push_back(v);
}

bool DislocationMoves::apply(const Edit& edit) {
  const std::uint32_t h = edit.first, o = mesh_.opposite(h);
  const std::uint32_t a = mesh_.origin(h), b = mesh_.target(h), c = mesh_.apex(h), d = mesh_.apex(o);
  if (edit.kind == Kind::flip) {
    if (c == d || mesh_.joined(c, d)) return false;
    mesh_.flip(h, journal_);
    made_.push_back({std::min(c, d), std::max(c, d)});
    for (const std::uint32_t v : {a, b, c, d}) touch(v);
  } else if (edit.kind == Kind::collapse) {
    if (!mesh_.may_collapse(h)) return false;
    mesh_.collapse(h, journal_, slots_);
    --added_;
    gone_.push_back(h / 3);
    gone_.push_back(o / 3);
    std::erase(touched_, a);
    if (!common_.held[b]) mesh_.move(b, 0.5 * (mesh_.position(a) + mesh_.position(b)), journal_);
    for (const std::uint32_t v : {b, c, d}) touch(v);
  } else {
    const std::uint32_t far = mesh_.target(edit.last);
    const std::uint32_t w = mesh_.split(h, edit.last, journal_, slots_);
    ++added_;
    common_.part[w] = part_;
    common_.held[w] = 0;
    made_.push_back({std::min(a, w), std::max(a, w)});
    const auto towards_ring = [&](std::uint32_t v, std::uint32_t other) {
      Vec3 sum;
      double n = 0;
      mesh_.around(v, [&](std::uint32_t e) {
        if (mesh_.target(e) == other) return;
        sum += mesh_.position(mesh_.target(e));
        ++n;
      });
      return mesh_.position(v) + 0.4 * (sum / n - mesh_.position(v));
    };
    const Vec3 to = towards_ring(w, a), back = towards_ring(a, w);
    mesh_.move(w, to, journal_);
    mesh_.move(a, back, journal_);
    for (const std::uint32_t v : {a, w, b, far}) touch(v);
  }
  cost_ += edit.cost;
  return true;
}

bool DislocationMoves::grow_chain(std::uint32_t v, const MoveParameters& parameters) {
  for (int length = 0; length < parameters.longest_chain; ++length) {
    Edit edit;
    if (!choose(v, edit) || !apply(edit)) return false;
    if (cost_ <= 0) return true;
    std::uint32_t irregular = 0;
    for (const std::uint32_t w : touched_)
      if (mesh_.valence(w) != 6 && random_.below(++irregular) == 0) v = w;
    if (irregular == 0) return false;
  }
  return false;
}

bool DislocationMoves::settle(const MoveParameters& parameters) {
  ++counts.relaxed;
  const double surplus_before = surplus, surplus_now = surplus + added_;
  const double gain = 0.5 * parameters.irregular_cost * cost_ +
                      parameters.count_cost * (surplus_now * surplus_now - surplus_before * surplus_before);
  const double allowed = -parameters.temperature * std::log(1 - random_.uniform());
  patch_.gather(touched_, rings, journal_);
  double lost = 0;
  for (const std::uint32_t t : gone_)
    if (!mesh_.triangle_in_use(t)) {
      lost -= mesh_.energy(t);
      mesh_.set_energy(t, 0, journal_);
    }
  patch_.sweep(first_sweeps);
  double growth = lost + patch_.renew_energies(journal_);
  if (!(growth + gain < allowed + hopeless)) return false;
  ++counts.finished;
  patch_.sweep(last_sweeps);
  patch_.project();
  growth += patch_.renew_energies(journal_);
  if (!(growth + gain < allowed) || !patch_.faces_outwards()) return false;
  std::vector<std::uint32_t> before(patch_.triangles().begin(), patch_.triangles().end());
  for (const std::uint32_t t : gone_)
    if (!mesh_.triangle_in_use(t)) before.push_back(t);
  std::sort(before.begin(), before.end());
  before.erase(std::unique(before.begin(), before.end()), before.end());
  if (points_.hand_over(mesh_, before, patch_.triangles(), parameters.tolerance)) return true;
  ++counts.bent;
  return false;
}

bool DislocationMoves::attempt(std::uint32_t v, const MoveParameters& parameters) {
  ++counts.attempts;
  touched_.clear();
  gone_.clear();
  made_.clear();
  cost_ = added_ = 0;
  climb_share_ = parameters.climb_share;
  slots_before_ = slots_;
  if (!grow_chain(v, parameters) || !settle(parameters)) {
    mesh_.roll_back(journal_);
    slots_ = slots_before_;
    return false;
  }
  mesh_.commit(journal_);
  surplus += added_;
  ++counts.accepted;
  return true;
}

void DislocationMoves::attempt_any(std::vector<std::uint32_t>& irregular, const MoveParameters& parameters) {
  const std::size_t i = random_.below(irregular.size());
  const std::uint32_t v = irregular[i];
  if (!mesh_.vertex_in_use(v) || mesh_.valence(v) == 6) {
    irregular.erase(irregular.begin() + static_cast<std::ptrdiff_t>(i));
    return;
  }
  if (!attempt(v, parameters)) return;
  for (const std::uint32_t w : touched_)
    if (mesh_.valence(w) != 6 && std::find(irregular.begin(), irregular.end(), w) == irregular.end())
      irregular.push_back(w);
}

}  // namespace evenmesh
