#pragma once
/// A place in a JSON scene: the value and its path, which every complaint begins with.

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "evenmesh/mesh.h"
#include "evenmesh/solid.h"
#include "io/source.h"

namespace evenmesh {

/// A value with the way to it. Places form a chain on the stack; nothing is copied until somebody complains.
class JsonPlace {
 public:
  JsonPlace(const Source& source, const nlohmann::json& value) : source_(source), value_(value) {}

  const nlohmann::json& value() const { return value_; }
  bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
  /// A member, which must be there (see has), or an element.
  JsonPlace member(const char* key) const { return {*this, value_.at(key), key, 0}; }
  JsonPlace element(std::size_t index) const { return {*this, value_.at(index), nullptr, index}; }

  /// Throws UnusableInput "file: path: what".
  [[noreturn]] void refuse(std::string_view what) const;
  /// "file: path: "
  std::string prefix() const;

  /// @throws UnusableInput  it is something else
  double number() const;
  std::string text() const;
  Vec3 vector() const;
  /// `count` numbers.
  template <std::size_t count>
  std::array<double, count> numbers() const {
    std::array<double, count> values{};
    fill(values.data(), count);
    return values;
  }
  /// All members must be among these.
  void only(std::initializer_list<const char*> keys) const;

 private:
  JsonPlace(const JsonPlace& outer, const nlohmann::json& value, const char* key, std::size_t index)
      : source_(outer.source_), value_(value), outer_(&outer), key_(key), index_(index) {}
  void fill(double* values, std::size_t count) const;
  std::string path() const;

  const Source& source_;
  const nlohmann::json& value_;
  const JsonPlace* outer_ = nullptr;
  const char* key_ = nullptr;  ///< of a member; nullptr: an element
  std::size_t index_ = 0;
};

/// What the value of "transform" stands for: scale, rotate, translate in this order, or a matrix.
/// @throws UnusableInput  it is something else, or has no inverse
Affine read_transform(const JsonPlace& transform);

}  // namespace evenmesh
