#include <algorithm>
#include <cmath>

#include "sample/field_parts.h"

namespace evenmesh {
namespace {

constexpr std::size_t min_batch = 1024;  // least points per evaluation: enough to hide its overhead, few for the cache
constexpr float root_tolerance = 1e-4f;  // cells
constexpr float rough = 4e-3f;           // cells; where values are dear, and f so rough that no chord finds the root
constexpr float agreement = 1e-3f;       // cells; between Newton's and the secant's guess
constexpr float beyond = 1e-3f;          // cells beyond a face of the bounds where f is asked whether it goes on
constexpr int max_steps = 40;
constexpr int bisections = 12;

bool inside(float f) {
  return f < 0.0f;
}

// As pack_normal() in float.
PackedNormal pack_normal(float x, float y, float z) {
  const float scale = 1.0f / (std::abs(x) + std::abs(y) + std::abs(z));
  float u = x * scale, v = y * scale;
  const float fu = std::copysign(1.0f - std::abs(v), u), fv = std::copysign(1.0f - std::abs(u), v);
  u = z < 0 ? fu : u;
  v = z < 0 ? fv : v;
  const auto steps = [](float c) { return static_cast<std::uint32_t>(static_cast<int>(c * 32767.0f + 32767.5f)); };
  return {steps(u) | steps(v) << 16};
}

float in_cell(float t) {
  return std::clamp(t, 0.0f, 0x1.fffffep-1f);
}

// Where the chord through the ends of the bracket is 0, or the middle when there is no such place.
float chord_root(const Bracket& b) {
  const float share = b.f_lo / (b.f_lo - b.f_hi);
  return b.t_lo + (b.t_hi - b.t_lo) * (share > 0.0f && share < 1.0f ? share : 0.5f);
}

void narrow(Bracket& b, float t, float f) {
  if (inside(f) == b.code.lower_end_inside()) {
    b.t_lo = t;
    b.f_lo = f;
  } else {
    b.t_hi = t;
    b.f_hi = f;
  }
}

}  // namespace

void RootFinder::find(const Field& field, const FieldGrid& grid, std::vector<Bracket>& brackets, FieldPart& part) {
  field_ = &field;
  grid_ = &grid;
  part_ = &part;
  for (std::vector<float>* v : {&part.x, &part.y, &part.z, &part.area}) v->resize(brackets.size());
  part.normal.resize(brackets.size());
  part.edge.resize(brackets.size());
  const std::size_t batch = std::max(min_batch, field.batch_size());
  for (std::size_t begin = 0; begin < brackets.size(); begin += batch)
    find_batch(std::span(brackets).subspan(begin, std::min(batch, brackets.size() - begin)), begin, part);
}

void RootFinder::find_batch(std::span<Bracket> brackets, std::size_t first, FieldPart& part) {
  const std::size_t n = brackets.size();
  roots_.assign(n, Root{});
  active_.clear();
  for (std::vector<float>* v : {&x_, &y_, &z_, &f_, &dx_, &dy_, &dz_})
    if (v->size() < n) v->resize(n);
  clip_to_bounds(brackets);
  if (!field_->has_gradient()) {
    bisect(brackets);
  } else if (field_->differentiates()) {
    first_guess(brackets);
    const std::vector<std::uint32_t> stubborn = active_;
    refine(brackets);
    differentiate(brackets, stubborn);
  } else {
    first_values(brackets);
    refine(brackets);
    active_.clear();
    for (std::uint32_t i = 0; i < brackets.size(); ++i)
      if (!roots_[i].synthetic) active_.push_back(i);
    differentiate(brackets, active_);
  }
  normalize(brackets);
  append(brackets, first, part);
}

// Writes the point at t on the bracket's edge into the batch.
void RootFinder::place(std::size_t slot, const Bracket& bracket, float t) {
  const SampleBlock& block = part_->blocks[bracket.block];
  const EdgeCode code = bracket.code;
  const std::uint32_t at[3] = {block.brick[0] * 8u + code.i(), block.brick[1] * 8u + code.j(),
                               block.brick[2] * 8u + code.k()};
  float p[3] = {grid_->coordinate[0][at[0]], grid_->coordinate[1][at[1]], grid_->coordinate[2][at[2]]};
  const unsigned axis = code.axis();
  const Grid& grid = grid_->grid;
  p[axis] = static_cast<float>(grid.origin[static_cast<int>(axis)] + grid.spacing * (at[axis] + double{t}));
  x_[slot] = p[0];
  y_[slot] = p[1];
  z_[slot] = p[2];
}

void RootFinder::evaluate(std::size_t n) {
  if (n == 0) return;
  field_->evaluate({std::span(x_).first(n), std::span(y_).first(n), std::span(z_).first(n)}, std::span(f_).first(n));
}

// Edges that leave the bounds: where f is still negative just beyond the face, the face is the surface.
void RootFinder::clip_to_bounds(std::span<Bracket> brackets) {
  on_bounds_.clear();
  const auto probe = [](const Bracket& b) {
    return b.code.lower_end_inside() ? std::min(b.t_hi + beyond, 1.0f) : std::max(b.t_lo - beyond, 0.0f);
  };
  for (std::uint32_t i = 0; i < brackets.size(); ++i)
    if (brackets[i].on_bounds) {
      place(on_bounds_.size(), brackets[i], probe(brackets[i]));
      on_bounds_.push_back(i);
    }
  evaluate(on_bounds_.size());
  for (std::size_t s = 0; s < on_bounds_.size(); ++s) {
    Bracket& b = brackets[on_bounds_[s]];
    Root& root = roots_[on_bounds_[s]];
    const bool up = b.code.lower_end_inside();
    const float face = up ? b.t_hi : b.t_lo;
    if (inside(f_[s])) {
      root.synthetic = true;
      root.t = face;
    } else if (up) {
      b.t_hi = probe(b);
      b.f_hi = f_[s];
    } else {
      b.t_lo = probe(b);
      b.f_lo = f_[s];
    }
  }
}

// One evaluation at the chord's root, which splits the bracket. Kept is where the next chord is 0, if that is hardly
// elsewhere, and so is the line through the other part: at kinks and jumps the steep side alone would draw the chords
// to the end of the flat one. The gradients are left for the end.
void RootFinder::first_values(std::span<Bracket> brackets) {
  for (std::uint32_t i = 0; i < brackets.size(); ++i) {
    if (roots_[i].synthetic) continue;
    roots_[i].t = chord_root(brackets[i]);
    place(active_.size(), brackets[i], roots_[i].t);
    active_.push_back(i);
  }
  evaluate(active_.size());
  std::size_t left = 0;
  for (std::size_t s = 0; s < active_.size(); ++s) {
    Bracket& b = brackets[active_[s]];
    Root& root = roots_[active_[s]];
    const bool low = inside(f_[s]) == b.code.lower_end_inside();
    const float behind_t = low ? b.t_lo : b.t_hi, behind_f = low ? b.f_lo : b.f_hi;
    const float step = f_[s] == 0.0f ? 0.0f : f_[s] * (root.t - behind_t) / (f_[s] - behind_f);
    narrow(b, root.t, f_[s]);
    const float chord = chord_root(b);
    const bool known = std::isfinite(b.f_lo) && std::isfinite(b.f_hi) && std::isfinite(behind_f);
    if (known && std::abs(chord - root.t) < agreement && std::abs(step) < agreement)
      root.t = chord;
    else
      active_[left++] = active_[s];
  }
  active_.resize(left);
}

// One evaluation with gradient at the chord's root. Newton's step from there and the chord of the narrower bracket
// enclose the root when f bends one way only; when they agree, Newton's is kept.
void RootFinder::first_guess(std::span<Bracket> brackets) {
  const std::size_t n = brackets.size();
  const float h = static_cast<float>(grid_->grid.spacing);
  for (std::size_t i = 0; i < n; ++i) {
    if (!roots_[i].synthetic) roots_[i].t = chord_root(brackets[i]);
    place(i, brackets[i], roots_[i].t);
  }
  field_->evaluate_gradient({std::span(x_).first(n), std::span(y_).first(n), std::span(z_).first(n)},
                            std::span(f_).first(n), std::span(dx_).first(n), std::span(dy_).first(n),
                            std::span(dz_).first(n));
  for (std::uint32_t i = 0; i < n; ++i) {
    Root& root = roots_[i];
    if (root.synthetic) continue;
    root.n[0] = dx_[i];
    root.n[1] = dy_[i];
    root.n[2] = dz_[i];
    narrow(brackets[i], root.t, f_[i]);
    const float newton = root.t - f_[i] / (root.n[brackets[i].code.axis()] * h), chord = chord_root(brackets[i]);
    const bool known = std::isfinite(brackets[i].f_lo) && std::isfinite(brackets[i].f_hi);
    if (known && std::abs(newton - chord) < agreement && newton >= brackets[i].t_lo && newton <= brackets[i].t_hi)
      root.t = newton;
    else
      active_.push_back(i);
  }
}

// The Illinois variant of regula falsi, with a bisection every third step, and from the seventh on only those. Guesses
// keep half a tolerance away from the ends, so that a root next to one end closes the bracket.
void RootFinder::refine(std::span<Bracket> brackets) {
  const float tolerance = field_->differentiates() ? root_tolerance : rough;
  for (int step = 0; step < max_steps && !active_.empty(); ++step) {
    for (std::size_t s = 0; s < active_.size(); ++s) {
      const Bracket& b = brackets[active_[s]];
      const float margin = std::min(0.5f * tolerance, 0.5f * (b.t_hi - b.t_lo));
      const float guess = step % 3 == 2 || step > 5 ? 0.5f * (b.t_lo + b.t_hi) : chord_root(b);
      roots_[active_[s]].t = std::clamp(guess, b.t_lo + margin, b.t_hi - margin);
      place(s, b, roots_[active_[s]].t);
    }
    evaluate(active_.size());
    std::size_t left = 0;
    for (std::size_t s = 0; s < active_.size(); ++s) {
      Bracket& b = brackets[active_[s]];
      Root& root = roots_[active_[s]];
      const bool low = inside(f_[s]) == b.code.lower_end_inside();
      narrow(b, root.t, f_[s]);
      // Halving the value at the end that stays draws the next chord towards it.
      (low ? b.f_hi : b.f_lo) *= 0.5f;
      if (b.t_hi - b.t_lo > tolerance)
        active_[left++] = active_[s];
      else
        root.t = chord_root(b);
    }
    active_.resize(left);
  }
}

void RootFinder::differentiate(std::span<const Bracket> brackets, std::span<const std::uint32_t> which) {
  const std::size_t n = which.size();
  if (n == 0) return;
  for (std::size_t s = 0; s < n; ++s) place(s, brackets[which[s]], roots_[which[s]].t);
  field_->evaluate_gradient({std::span(x_).first(n), std::span(y_).first(n), std::span(z_).first(n)},
                            std::span(f_).first(n), std::span(dx_).first(n), std::span(dy_).first(n),
                            std::span(dz_).first(n));
  for (std::size_t s = 0; s < n; ++s) {
    roots_[which[s]].n[0] = dx_[s];
    roots_[which[s]].n[1] = dy_[s];
    roots_[which[s]].n[2] = dz_[s];
  }
}

void RootFinder::bisect(std::span<Bracket> brackets) {
  for (int step = 0; step <= bisections; ++step) {
    for (std::size_t i = 0; i < brackets.size(); ++i) {
      if (!roots_[i].synthetic) roots_[i].t = 0.5f * (brackets[i].t_lo + brackets[i].t_hi);
      place(i, brackets[i], roots_[i].t);
    }
    if (step == bisections) return;
    evaluate(brackets.size());
    for (std::size_t i = 0; i < brackets.size(); ++i) narrow(brackets[i], roots_[i].t, f_[i]);
  }
}

// Unit normals; the edge's axis where f has no gradient, or the surface is a face of the bounds.
void RootFinder::normalize(std::span<const Bracket> brackets) {
  for (std::size_t i = 0; i < brackets.size(); ++i) {
    const Root& root = roots_[i];
    dx_[i] = root.n[0];
    dy_[i] = root.n[1];
    dz_[i] = root.n[2];
  }
  for (std::size_t i = 0; i < brackets.size(); ++i) {
    // Scaled by the largest component first: squares must not overflow.
    const float largest = std::max(std::max(std::abs(dx_[i]), std::abs(dy_[i])), std::abs(dz_[i]));
    const float scale = 1.0f / largest, x = dx_[i] * scale, y = dy_[i] * scale, z = dz_[i] * scale;
    const float inverse = 1.0f / std::sqrt(x * x + y * y + z * z);
    dx_[i] = x * inverse;
    dy_[i] = y * inverse;
    dz_[i] = z * inverse;
    f_[i] = inverse;
  }
  for (std::size_t i = 0; i < brackets.size(); ++i) {
    if (!roots_[i].synthetic && f_[i] > 0.0f && f_[i] <= 1.0f) continue;
    const float outward = brackets[i].code.lower_end_inside() ? 1.0f : -1.0f;
    const unsigned axis = brackets[i].code.axis();
    dx_[i] = axis == 0 ? outward : 0.0f;
    dy_[i] = axis == 1 ? outward : 0.0f;
    dz_[i] = axis == 2 ? outward : 0.0f;
  }
}

void RootFinder::append(std::span<const Bracket> brackets, std::size_t first, FieldPart& part) const {
  const float h = static_cast<float>(grid_->grid.spacing);
  constexpr float half = brick_size / 2.0f;
  for (std::size_t i = 0; i < brackets.size(); ++i) {
    const EdgeCode code = brackets[i].code;
    const unsigned axis = code.axis();
    float at[3] = {code.i() - half, code.j() - half, code.k() - half};
    at[axis] += in_cell(roots_[i].t);
    const std::size_t out = first + i;
    part.x[out] = at[0] * h;
    part.y[out] = at[1] * h;
    part.z[out] = at[2] * h;
    part.area[out] = h * h * std::abs(axis == 0 ? dx_[i] : axis == 1 ? dy_[i] : dz_[i]);
    part.normal[out] = pack_normal(dx_[i], dy_[i], dz_[i]);
    part.edge[out] = code;
    part.cut_by_bounds = part.cut_by_bounds || roots_[i].synthetic;
  }
}

}  // namespace evenmesh
