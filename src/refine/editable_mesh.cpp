#include "refine/editable_mesh.h"

#include <algorithm>
#include <cmath>

namespace evenmesh {

EditableMesh::EditableMesh(const Mesh& mesh, std::size_t room, const ExecutionContext& context)
    : origin_(3 * (mesh.triangles.size() + 2 * room), none),
      opposite_(origin_.size(), none),
      outgoing_(mesh.vertices.size() + room, none),
      valence_(outgoing_.size(), 0),
      position_(mesh.vertices),
      energy_(mesh.triangles.size() + 2 * room, 0.0) {
  position_.resize(outgoing_.size());
  const HalfEdges edges(mesh.triangles, mesh.vertices.size(), context);
  for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    origin_[h] = mesh.triangles[h / 3][h % 3];
    opposite_[h] = edges.opposite(h);
    outgoing_[origin_[h]] = h;
    ++valence_[origin_[h]];
  }
  for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h)
    if (opposite_[h] == none) valence_[origin_[h]] = valence_[target(h)] = 0;
}

std::size_t EditableMesh::vertices_in_use() const {
  return outgoing_.size() - static_cast<std::size_t>(std::count(outgoing_.begin(), outgoing_.end(), none));
}

bool EditableMesh::joined(std::uint32_t a, std::uint32_t b) const {
  bool found = false;
  around(a, [&](std::uint32_t h) { found |= target(h) == b; });
  return found;
}

void EditableMesh::set_triangle(std::uint32_t t, const Triangle& corners, EditJournal& journal) {
  for (std::uint32_t c = 0; c < 3; ++c) write(origin_[3 * t + c], corners[c], journal);
}

void EditableMesh::flip(std::uint32_t h, EditJournal& journal) {
  const std::uint32_t o = opposite_[h];
  const std::uint32_t hn = next(h), hp = previous(h), on = next(o), op = previous(o);
  const std::uint32_t a = origin_[h], b = origin_[o], c = origin_[hp], d = origin_[op];
  const std::uint32_t bc = opposite_[hn], ca = opposite_[hp], ad = opposite_[on], db = opposite_[op];
  const auto set = [&](std::uint32_t e, std::uint32_t v) {
    write(origin_[e], v, journal);
    write(outgoing_[v], e, journal);
  };
  set(h, d);
  set(hn, c);
  set(hp, a);
  set(o, c);
  set(on, d);
  set(op, b);
  link(hn, ca, journal);
  link(hp, ad, journal);
  link(on, db, journal);
  link(op, bc, journal);
  for (const std::uint32_t v : {a, b}) write(valence_[v], valence_[v] - 1, journal);
  for (const std::uint32_t v : {c, d}) write(valence_[v], valence_[v] + 1, journal);
}

bool EditableMesh::may_collapse(std::uint32_t h) const {
  const std::uint32_t b = target(h);
  int common = 0;
  around(origin_[h], [&](std::uint32_t e) { common += joined(b, target(e)); });
  return common == 2;
}

void EditableMesh::collapse(std::uint32_t h, EditJournal& journal, FreeSlots& slots) {
  const std::uint32_t o = opposite_[h], a = origin_[h], b = target(h), c = apex(h), d = apex(o);
  const std::uint32_t bc = opposite_[next(h)], ca = opposite_[previous(h)];
  const std::uint32_t ad = opposite_[next(o)], db = opposite_[previous(o)];
  std::uint32_t e = h;
  do {
    const std::uint32_t after = rotated(e);
    write(origin_[e], b, journal);
    e = after;
  } while (e != h);
  link(bc, ca, journal);
  link(ad, db, journal);
  write(outgoing_[b], ca, journal);
  write(outgoing_[c], bc, journal);
  write(outgoing_[d], ad, journal);
  write(outgoing_[a], none, journal);
  write(valence_[b], valence_[a] + valence_[b] - 4, journal);
  for (const std::uint32_t v : {c, d}) write(valence_[v], valence_[v] - 1, journal);
  for (const std::uint32_t t : {h / 3, o / 3}) {
    set_triangle(t, {none, none, none}, journal);
    slots.triangles.push_back(t);
  }
  slots.vertices.push_back(a);
}

std::uint32_t EditableMesh::split(std::uint32_t first, std::uint32_t last, EditJournal& journal, FreeSlots& slots) {
  const std::uint32_t v = origin_[first], a = target(first), b = target(last);
  const std::uint32_t w = slots.vertices.back(), t1 = slots.triangles.back();
  slots.vertices.pop_back();
  slots.triangles.pop_back();
  const std::uint32_t t2 = slots.triangles.back();
  slots.triangles.pop_back();
  const std::uint32_t av = opposite_[first], bv = opposite_[last];
  std::uint32_t moved = 0;
  for (std::uint32_t e = first; e != last; ++moved) {
    const std::uint32_t after = rotated(e);
    write(origin_[e], w, journal);
    e = after;
  }
  set_triangle(t1, {v, a, w}, journal);
  set_triangle(t2, {w, b, v}, journal);
  link(3 * t1, av, journal);
  link(3 * t1 + 1, first, journal);
  link(3 * t1 + 2, 3 * t2 + 2, journal);
  link(3 * t2, bv, journal);
  link(3 * t2 + 1, last, journal);
  write(outgoing_[v], last, journal);
  write(outgoing_[w], first, journal);
  write(valence_[v], valence_[v] - moved + 2, journal);
  write(valence_[w], moved + 2, journal);
  for (const std::uint32_t u : {a, b}) write(valence_[u], valence_[u] + 1, journal);
  move(w, position_[v], journal);
  return w;
}

void EditableMesh::commit(EditJournal& journal) const {
  journal.words_.clear();
  journal.places_.clear();
  journal.energies_.clear();
}

void EditableMesh::roll_back(EditJournal& journal) const {
  for (std::size_t i = journal.words_.size(); i-- > 0;) *journal.words_[i].at = journal.words_[i].before;
  for (std::size_t i = journal.places_.size(); i-- > 0;) *journal.places_[i].at = journal.places_[i].before;
  for (std::size_t i = journal.energies_.size(); i-- > 0;) *journal.energies_[i].at = journal.energies_[i].before;
  commit(journal);
}

Facing facing_of(const EditableMesh& mesh, std::uint32_t v) {
  const Vec3& p = mesh.position(v);
  const auto normal = [&](std::uint32_t h) {
    return cross(mesh.position(mesh.target(h)) - p, mesh.position(mesh.apex(h)) - p);
  };
  Facing facing;
  mesh.around(v, [&](std::uint32_t h) { facing.normal += normal(h); });
  facing.normal = normalized(facing.normal);
  mesh.around(v, [&](std::uint32_t h) {
    const Vec3 n = normal(h);
    const double length = norm(n);
    facing.least_cosine = std::min(facing.least_cosine, length > 0 ? dot(n, facing.normal) / length : -1);
  });
  return facing;
}

}  // namespace evenmesh
