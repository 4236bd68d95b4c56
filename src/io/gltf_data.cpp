#include "io/gltf_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/binary.h"

namespace evenmesh {
namespace {

constexpr std::uint64_t largest_number = std::uint64_t{1} << 53;

std::size_t component_size(int component) {
  switch (component) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

double component_value(const char* bytes, int component, bool normalized) {
  const auto scaled = [&](double value, double largest) {
    return normalized ? std::max(value / largest, -1.0) : value;
  };
  switch (component) {
    case 5120:
      return scaled(load<std::int8_t>(bytes), 127);
    case 5121:
      return scaled(load<std::uint8_t>(bytes), 255);
    case 5122:
      return scaled(load<std::int16_t>(bytes), 32767);
    case 5123:
      return scaled(load<std::uint16_t>(bytes), 65535);
    default:
      return load<float>(bytes);
  }
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Bytes of base64 text (RFC 4648 §4); nothing if it is malformed.
std::optional<std::string> from_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return {};
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held >= 8) bytes += static_cast<char>(bits >> (held -= 8) & 0xff);
  }
  return bytes;
}

std::optional<std::uint64_t> whole_number(const Json& value) {
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= largest_number) return value.get<std::uint64_t>();
  return {};
}

/// A whole number or `otherwise` if there is none.
std::uint64_t whole_member(const Source& source, const Json& object, const char* key, std::uint64_t otherwise) {
  if (!object.contains(key)) return otherwise;
  const auto value = whole_number(object[key]);
  if (!value) fail(source, fmt::format("'{}' in its JSON is not a whole number; export the file again", key));
  return *value;
}

}  // namespace

Vec3 Accessor::point(std::size_t i) const {
  const char* row = data + i * stride;
  const std::size_t size = component_size(component);
  return {component_value(row, component, normalized), component_value(row + size, component, normalized),
          component_value(row + 2 * size, component, normalized)};
}

std::uint32_t Accessor::integer(std::size_t i) const {
  const char* row = data + i * stride;
  return component == 5121   ? load<std::uint8_t>(row)
         : component == 5123 ? load<std::uint16_t>(row)
                             : load<std::uint32_t>(row);
}

GltfData::GltfData(const Source& source) : source_(source) {
  read_container();
}

void GltfData::read_container() {
  const std::string_view bytes = source_.bytes;
  std::string_view json = bytes, binary;
  if (bytes.starts_with("glTF")) {
    if (bytes.size() < 20) fail(source_, "is too short for a GLB file; it is truncated");
    const auto version = load<std::uint32_t>(bytes.data() + 4);
    if (version != 2) fail(source_, fmt::format("is glTF of version {}; only version 2 can be read", version));
    const std::size_t length = load<std::uint32_t>(bytes.data() + 8);
    if (length > bytes.size()) {
      fail(source_, fmt::format("announces {} bytes, but holds {}; the file is truncated", length, bytes.size()));
    }
    json = {};
    for (std::size_t at = 12; length >= 8 && at <= length - 8;) {
      const std::size_t size = load<std::uint32_t>(bytes.data() + at);
      const std::string_view type = bytes.substr(at + 4, 4);
      if (size > length - at - 8) fail(source_, "has a chunk that reaches beyond its end; the file is truncated");
      if (type == "JSON" && json.empty()) json = bytes.substr(at + 8, size);
      if (type == std::string_view("BIN\0", 4) && binary.empty()) binary = bytes.substr(at + 8, size);
      at += 8 + (size + 3) / 4 * 4;
    }
  }
  parse_json(json);
  refuse_extensions();
  read_buffers(binary);
}

void GltfData::parse_json(std::string_view text) {
  try {
    root_ = Json::parse(text);
  } catch (const Json::exception&) {  // also a number beyond the range of double
    fail(source_, "its JSON cannot be parsed; the file is truncated or damaged");
  }
  if (!root_.is_object() || !root_.contains("asset")) fail(source_, "its JSON is not that of a glTF scene");
  if (root_["asset"].is_object() && root_["asset"].contains("version") && root_["asset"]["version"].is_string() &&
      !root_["asset"]["version"].get_ref<const std::string&>().starts_with("2")) {
    fail(source_, "is not glTF of version 2; export it again as glTF 2.0");
  }
}

void GltfData::refuse_extensions() const {
  for (const Json& name : list("extensionsRequired")) {
    const std::string_view known = name.is_string() ? std::string_view(name.get_ref<const std::string&>()) : "";
    const bool harmless = known.starts_with("KHR_materials_") || known.starts_with("KHR_texture_") ||
                          known.starts_with("EXT_texture_") || known == "KHR_lights_punctual" ||
                          known == "KHR_mesh_quantization" || known == "KHR_animation_pointer";
    if (!harmless) {
      fail(source_,
           fmt::format("needs the glTF extension {}, which is not available in this version; export it without",
                       quoted(known)));
    }
  }
}

void GltfData::read_buffers(std::string_view binary) {
  const Json& buffers = list("buffers");
  decoded_.reserve(buffers.size());  // views into these must not move
  for (const Json& buffer : buffers) {
    if (!buffer.contains("uri")) {
      buffers_.push_back(buffers_.empty() ? binary : std::string_view{});
      continue;
    }
    const std::string_view uri =
        buffer["uri"].is_string() ? std::string_view(buffer["uri"].get_ref<const std::string&>()) : "";
    const std::size_t mark = uri.find(";base64,");
    if (!uri.starts_with("data:") || mark == std::string_view::npos) {
      fail(source_,
           fmt::format("keeps its data in another file, {}, which is not read; save it as one .glb file", quoted(uri)));
    }
    auto bytes = from_base64(uri.substr(mark + 8));
    if (!bytes) fail(source_, "has a buffer with malformed base64 text; export the file again");
    decoded_.push_back(std::move(*bytes));
    buffers_.push_back(decoded_.back());
  }
}

const Json& GltfData::list_in(const Json& object, const char* key) const {
  static const Json empty = Json::array();
  if (!object.is_object() || !object.contains(key)) return empty;
  if (!object[key].is_array()) fail(source_, fmt::format("'{}' in its JSON is not a list; export the file again", key));
  return object[key];
}

std::optional<std::size_t> GltfData::index(const Json& object, const char* key, std::size_t limit) const {
  if (!object.is_object() || !object.contains(key)) return {};
  const auto value = whole_number(object[key]);
  if (!value || *value >= limit) {
    fail(source_, fmt::format("'{}' in its JSON is not a number below {}; export the file again", key, limit));
  }
  return *value;
}

std::vector<std::size_t> GltfData::indices(const Json& object, const char* key, std::size_t limit) const {
  const Json& list = list_in(object, key);
  std::vector<std::size_t> found;
  found.reserve(list.size());
  for (const Json& item : list) {
    const auto value = whole_number(item);
    if (!value || *value >= limit) {
      fail(source_, fmt::format("'{}' in its JSON holds something else than numbers below {}", key, limit));
    }
    found.push_back(*value);
  }
  return found;
}

void GltfData::fill(const Json& list, const char* key, double* values, std::size_t count) const {
  bool valid = list.is_array() && list.size() == count;
  for (std::size_t i = 0; valid && i < count; ++i) {
    valid = list[i].is_number();
    if (valid) values[i] = list[i].get<double>();
  }
  if (!valid)
    fail(source_, fmt::format("'{}' in its JSON does not hold {} numbers; export the file again", key, count));
}

std::string_view GltfData::buffer_view(const Json& accessor, std::size_t number, std::size_t& stride) const {
  const Json& views = list("bufferViews");
  const auto view_index = index(accessor, "bufferView", views.size());
  if (!view_index || accessor.contains("sparse")) {
    fail(source_, fmt::format("accessor {} is sparse or without data, which is not available in this version", number));
  }
  const Json& view = views[*view_index];
  const auto buffer = index(view, "buffer", buffers_.size());
  if (!buffer) fail(source_, fmt::format("buffer view {} names no buffer; export the file again", *view_index));
  const std::uint64_t offset = whole_member(source_, view, "byteOffset", 0);
  const std::uint64_t length = whole_member(source_, view, "byteLength", 0);
  stride = whole_member(source_, view, "byteStride", 0);
  const std::string_view bytes = buffers_[*buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    fail(source_, fmt::format("buffer view {} lies outside of its buffer of {} bytes; the file is truncated or damaged",
                              *view_index, bytes.size()));
  }
  return bytes.substr(offset, length);
}

Accessor GltfData::accessor(std::size_t number, std::size_t components) const {
  const Json& object = list("accessors")[number];
  const auto damaged = [&](std::string_view what) { fail(source_, fmt::format("accessor {} {}", number, what)); };
  std::size_t stride = 0;
  const std::string_view view = buffer_view(object, number, stride);
  Accessor found;
  found.component = static_cast<int>(index(object, "componentType", 5127).value_or(0));
  found.normalized = object.contains("normalized") && object["normalized"] == true;
  const std::size_t row = components * component_size(found.component);
  if (row == 0 || object.value("type", Json()) != (components == 3 ? "VEC3" : "SCALAR")) {
    damaged("has another type than its use asks for; export the file again");
  }
  found.stride = stride == 0 ? row : stride;
  found.count = whole_member(source_, object, "count", 0);
  const std::uint64_t offset = whole_member(source_, object, "byteOffset", 0);
  // Rows that overlap would let few bytes stand for many vertices.
  const bool fits = found.count == 0 || (found.stride >= row && offset <= view.size() && row <= view.size() - offset &&
                                         (found.count - 1) <= (view.size() - offset - row) / found.stride);
  if (!fits) damaged(fmt::format("announces {} rows, more than its buffer holds; the file is damaged", found.count));
  found.data = view.data() + (found.count == 0 ? 0 : offset);
  return found;
}

Accessor GltfData::positions(std::size_t number) const {
  const Accessor found = accessor(number, 3);
  if (found.component == 5125) fail(source_, "has positions of type uint32; export the file again");
  return found;
}

Accessor GltfData::indices_of(std::size_t number) const {
  const Accessor found = accessor(number, 1);
  if (found.component != 5121 && found.component != 5123 && found.component != 5125) {
    fail(source_, "has vertex indices of another type than uint8, uint16, uint32; export the file again");
  }
  return found;
}

}  // namespace evenmesh
