#include "scene/json_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"

namespace evenmesh {

using Json = nlohmann::json;

std::string JsonPlace::path() const {
  // From the inside out, as deep as a scene may be.
  std::vector<const JsonPlace*> steps;
  for (const JsonPlace* step = this; step->outer_ != nullptr; step = step->outer_) steps.push_back(step);
  std::string path;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if ((*step)->key_ == nullptr) {
      path += fmt::format("[{}]", (*step)->index_);
    } else {
      path += path.empty() ? (*step)->key_ : fmt::format(".{}", (*step)->key_);
    }
  }
  constexpr std::size_t longest = 400;  // bytes; the end tells more
  return path.size() > longest ? "…" + path.substr(path.size() - longest) : path;
}

std::string JsonPlace::prefix() const {
  const std::string where = path();
  return fmt::format("{}: {}{}", source_.name, where, where.empty() ? "" : ": ");
}

void JsonPlace::refuse(std::string_view what) const {
  throw UnusableInput(fmt::format("{}{}", prefix(), what));
}

double JsonPlace::number() const {
  if (!value_.is_number() || !std::isfinite(value_.get<double>())) refuse("needs a number");
  return value_.get<double>();
}

std::string JsonPlace::text() const {
  if (!value_.is_string() || value_.get_ref<const std::string&>().empty()) refuse("needs a text in quotes");
  return value_.get<std::string>();
}

void JsonPlace::fill(double* values, std::size_t count) const {
  const auto numeric = [](const Json& v) { return v.is_number() && std::isfinite(v.get<double>()); };
  if (!value_.is_array() || value_.size() != count || !std::all_of(value_.begin(), value_.end(), numeric)) {
    refuse(fmt::format("needs {} numbers", count == 3 ? "three" : std::to_string(count)));
  }
  for (std::size_t i = 0; i < count; ++i) values[i] = value_[i].get<double>();
}

Vec3 JsonPlace::vector() const {
  const auto v = numbers<3>();
  return {v[0], v[1], v[2]};
}

void JsonPlace::only(std::initializer_list<const char*> keys) const {
  std::string list;
  for (const char* key : keys) list += (list.empty() ? "'" : ", '") + std::string(key) + "'";
  if (!value_.is_object()) refuse("needs an object with " + list);
  for (const auto& [key, unused] : value_.items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      refuse(fmt::format("has the unknown key {}; known are {}", evenmesh::quoted(key), list));
    }
  }
}

namespace {

Affine read_matrix(const JsonPlace& place) {
  std::array<double, 16> m{};
  if (place.value().is_array() && place.value().size() == 4) {
    for (std::size_t row = 0; row < 4; ++row) {
      const auto values = place.element(row).numbers<4>();
      std::copy(values.begin(), values.end(), m.begin() + static_cast<std::ptrdiff_t>(4 * row));
    }
  } else if (place.value().is_array() && place.value().size() == 16) {
    m = place.numbers<16>();
  } else {
    place.refuse("needs 16 numbers, row by row, or four rows of four");
  }
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
    place.refuse("needs 0, 0, 0, 1 in its last row; projections are not possible");
  }
  return {{Vec3{m[0], m[4], m[8]}, Vec3{m[1], m[5], m[9]}, Vec3{m[2], m[6], m[10]}}, {m[3], m[7], m[11]}};
}

Vec3 read_scale(const JsonPlace& place) {
  Vec3 scale;
  if (place.value().is_number()) {
    const double all = place.number();
    scale = {all, all, all};
  } else if (place.value().is_array() && place.value().size() == 3) {
    scale = place.vector();
  } else {
    place.refuse("needs a number, or three for x, y, z");
  }
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) place.refuse("must not be 0, that would flatten the shape");
  return scale;
}

Affine read_rotation(const JsonPlace& place) {
  place.only({"axis", "degrees"});
  if (!place.has("axis") || !place.has("degrees")) place.refuse("needs 'axis' and 'degrees'");
  const JsonPlace axis = place.member("axis");
  if (!axis.value().is_array() || axis.value().size() != 3) axis.refuse("needs three numbers, not all zero");
  const Vec3 direction = axis.vector();
  if (!(norm(direction) > 0) || !std::isfinite(norm(direction))) axis.refuse("needs three numbers, not all zero");
  return Affine::rotate(direction, place.member("degrees").number());
}

}  // namespace

Affine read_transform(const JsonPlace& place) {
  place.only({"scale", "rotate", "translate", "matrix"});
  if (place.value().empty()) place.refuse("needs 'scale', 'rotate', 'translate', or 'matrix'");
  Affine transform;
  if (place.has("matrix")) {
    if (place.value().size() > 1) place.refuse("has 'matrix' and more; put one transform around the other");
    transform = read_matrix(place.member("matrix"));
  } else {
    if (place.has("scale")) transform = Affine::scale(read_scale(place.member("scale")));
    if (place.has("rotate")) transform = read_rotation(place.member("rotate")).after(transform);
    if (place.has("translate")) {
      transform = Affine::translate(place.member("translate").vector()).after(transform);
    }
  }
  try {
    transform.inverse();
  } catch (const Error&) {
    place.refuse("has no inverse: it would flatten the shape, or its numbers are too large or too small");
  }
  return transform;
}

}  // namespace evenmesh
