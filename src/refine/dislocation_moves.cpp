#include "refine/dislocation_moves.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr int highest_cost = 8;    ///< of a chain on its way
constexpr int longest_chain = 16;  ///< edits
constexpr int rings = 3;
constexpr int first_sweeps = 4, last_sweeps = 10;
constexpr double hopeless = 0.15;  ///< energy that the last sweeps cannot gain

double weight_of(int cost) {
  static const std::array<double, 33> table = [] {
    std::array<double, 33> weights{};
    for (int i = 0; i < 33; ++i) weights[static_cast<std::size_t>(i)] = std::exp(-0.8 * (i - 16));
    return weights;
  }();
  const int i = std::max(cost, -16) + 16;
  return cost > 16 ? 0 : table[static_cast<std::size_t>(i)];
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
  if (o == none) return;
  const std::uint32_t a = mesh_.origin(h), b = mesh_.origin(o), c = mesh_.apex(h), d = mesh_.apex(o);
  if (!mine(a) || !mine(b) || !mine(c) || !mine(d)) return;
  if (constraints_.edge(a, b) || made_here(a, b)) return;
  consider({Kind::flip, h, none, change(a, -1) + change(b, -1) + change(c, 1) + change(d, 1)}, 1);
}

void DislocationMoves::consider_collapse(std::uint32_t h) {
  const std::uint32_t o = mesh_.opposite(h);
  if (o == none) return;
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

bool DislocationMoves::flip(std::uint32_t h) {
  const std::uint32_t o = mesh_.opposite(h), c = mesh_.apex(h), d = mesh_.apex(o);
  if (c == d || mesh_.joined(c, d)) return false;
  for (const std::uint32_t v : {mesh_.origin(h), mesh_.origin(o), c, d}) touch(v);
  mesh_.flip(h, journal_);
  made_.push_back({std::min(c, d), std::max(c, d)});
  return true;
}

bool DislocationMoves::collapse(std::uint32_t h) {
  if (!mesh_.may_collapse(h)) return false;
  const std::uint32_t o = mesh_.opposite(h), a = mesh_.origin(h), b = mesh_.origin(o);
  for (const std::uint32_t v : {b, mesh_.apex(h), mesh_.apex(o)}) touch(v);
  std::erase(touched_, a);
  gone_.insert(gone_.end(), {h / 3, o / 3});
  mesh_.collapse(h, journal_, slots_);
  --added_;
  if (!common_.held[b]) mesh_.move(b, 0.5 * (mesh_.position(a) + mesh_.position(b)), journal_);
  return true;
}

void DislocationMoves::split(std::uint32_t first, std::uint32_t last) {
  const std::uint32_t v = mesh_.origin(first), a = mesh_.target(first), b = mesh_.target(last);
  const std::uint32_t w = mesh_.split(first, last, journal_, slots_);
  ++added_;
  common_.part[w] = part_;
  common_.held[w] = 0;
  made_.push_back({std::min(v, w), std::max(v, w)});
  const auto apart_from = [&](std::uint32_t u, std::uint32_t other) {
    constexpr double share = 0.4;  // of the way to the middle of its other neighbours
    Vec3 sum;
    mesh_.around(u, [&](std::uint32_t e) { sum += mesh_.position(mesh_.target(e)) - mesh_.position(u); });
    sum -= mesh_.position(other) - mesh_.position(u);
    return mesh_.position(u) + share / (mesh_.valence(u) - 1) * sum;
  };
  const Vec3 to = apart_from(w, v), back = apart_from(v, w);
  mesh_.move(w, to, journal_);
  mesh_.move(v, back, journal_);
  for (const std::uint32_t u : {v, w, a, b}) touch(u);
}

bool DislocationMoves::apply(const Edit& edit) {
  if (edit.kind == Kind::flip && !flip(edit.first)) return false;
  if (edit.kind == Kind::collapse && !collapse(edit.first)) return false;
  if (edit.kind == Kind::split) split(edit.first, edit.last);
  cost_ += edit.cost;
  return true;
}

bool DislocationMoves::grow_chain(std::uint32_t v) {
  for (int length = 0; length < longest_chain; ++length) {
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

double DislocationMoves::energy_of_gone() {
  double energy = 0;
  for (const std::uint32_t t : gone_)
    if (!mesh_.triangle_in_use(t)) {
      energy += mesh_.energy(t);
      mesh_.set_energy(t, 0, journal_);
    }
  return energy;
}

bool DislocationMoves::settle(const MoveParameters& parameters) {
  ++counts.relaxed;
  const double before = surplus_, after = surplus_ + added_;
  const double cost =
      0.5 * parameters.irregular_cost * cost_ + parameters.count_cost * (after * after - before * before);
  const double allowed = -parameters.temperature * std::log(1 - random_.uniform()) - cost;
  patch_.gather(touched_, rings, journal_);
  patch_.sweep(first_sweeps);
  double growth = patch_.renew_energies(journal_) - energy_of_gone();
  if (!(growth < allowed + hopeless)) return false;
  patch_.sweep(last_sweeps);
  patch_.project();
  growth += patch_.renew_energies(journal_);
  return growth < allowed && patch_.faces_outwards() && stays_near(parameters.tolerance);
}

bool DislocationMoves::stays_near(double tolerance) {
  const auto sort = [](std::vector<std::uint32_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  std::vector<std::uint32_t> now(patch_.triangles().begin(), patch_.triangles().end()), before = gone_, changed;
  before.insert(before.end(), now.begin(), now.end());
  for (const std::uint32_t v : touched_) mesh_.around(v, [&](std::uint32_t h) { changed.push_back(h / 3); });
  sort(before);
  sort(now);
  sort(changed);
  if (points_.hand_over(mesh_, before, now, changed, tolerance)) return true;
  ++counts.off_surface;
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
  if (!grow_chain(v) || !settle(parameters)) {
    mesh_.roll_back(journal_);
    slots_ = slots_before_;
    return false;
  }
  mesh_.commit(journal_);
  surplus_ += added_;
  ++counts.accepted;
  return true;
}

void DislocationMoves::attempt_any(const MoveParameters& parameters) {
  const std::size_t i = random_.below(irregular_.size());
  const std::uint32_t v = irregular_[i];
  if (!mesh_.vertex_in_use(v) || mesh_.valence(v) == 6) {
    irregular_.erase(irregular_.begin() + static_cast<std::ptrdiff_t>(i));
    return;
  }
  if (!attempt(v, parameters)) return;
  for (const std::uint32_t w : touched_)
    if (mesh_.valence(w) != 6 && std::find(irregular_.begin(), irregular_.end(), w) == irregular_.end())
      irregular_.push_back(w);
}

}  // namespace evenmesh
