#pragma once
/// The data of a glTF file behind checks: no index, size or type of the JSON text is believed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/source.h"

namespace evenmesh {

using Json = nlohmann::json;

/// A column of numbers in a buffer; rows lie within it.
struct Accessor {
  const char* data = nullptr;
  std::size_t count = 0, stride = 0;
  int component = 0;        ///< 5120 … 5126: int8, uint8, int16, uint16, –, uint32, float
  bool normalized = false;  ///< whole numbers stand for [0, 1] or [−1, 1] (KHR_mesh_quantization)

  Vec3 point(std::size_t i) const;
  std::uint32_t integer(std::size_t i) const;
};

class GltfData {
 public:
  /// @param source  a GLB file or glTF JSON text; must outlive the data
  /// @throws UnusableInput  damaged, not version 2, a buffer outside of the file, or a required extension not known
  /// here
  explicit GltfData(const Source& source);

  const Json& root() const { return root_; }
  /// Array `key` of the root or of `object`, empty if there is none.
  const Json& list(const char* key) const { return list_in(root_, key); }
  const Json& list_in(const Json& object, const char* key) const;
  /// Member `key` as an index below `limit`, nothing if there is none.
  std::optional<std::size_t> index(const Json& object, const char* key, std::size_t limit) const;
  /// Member `key` as a list of such.
  std::vector<std::size_t> indices(const Json& object, const char* key, std::size_t limit) const;
  /// Member `key` as N finite numbers.
  template <std::size_t N>
  std::array<double, N> numbers(const Json& object, const char* key, std::array<double, N> otherwise) const {
    if (object.contains(key)) fill(object[key], key, otherwise.data(), N);
    return otherwise;
  }

  Accessor positions(std::size_t accessor) const;
  Accessor indices_of(std::size_t accessor) const;

 private:
  void read_container();
  void parse_json(std::string_view text);
  void read_buffers(std::string_view binary);
  void refuse_extensions() const;
  void fill(const Json& list, const char* key, double* values, std::size_t count) const;
  std::string_view buffer_view(const Json& accessor, std::size_t number, std::size_t& stride) const;
  Accessor accessor(std::size_t number, std::size_t components) const;

  const Source& source_;
  Json root_;
  std::vector<std::string_view> buffers_;
  std::vector<std::string> decoded_;
};

}  // namespace evenmesh
