/// PCD (Point Cloud Data, version 0.7, of the Point Cloud Library): ascii, binary, and binary_compressed. Positions and
/// normals are read, all other fields and the viewpoint passed over.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "io/binary.h"
#include "io/formats.h"
#include "io/text.h"

namespace evenmesh {
namespace {

struct Field {
  std::string name;
  std::size_t size = 4, count = 1;
  char type = 'F';
  std::size_t column = 0, offset = 0;  ///< of its first value among those, or among the bytes, of a point
};

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::string_view data;
  const char* body = nullptr;
  std::size_t columns = 0, stride = 0;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r\n"), line.size()));
    if (line.empty()) return words;
    words.push_back(line.substr(0, line.find_first_of(" \t\r\n")));
    line.remove_prefix(words.back().size());
  }
}

std::uint64_t whole(const Source& source, std::string_view word) {
  const char* p = word.data();
  std::int64_t value = 0;
  if (!scan_integer(p, word.data() + word.size(), value) || value < 0)
    fail_at(source, word.data(), fmt::format("expected a number, found {}", quoted(word)));
  return static_cast<std::uint64_t>(value);
}

/// Of each field one value; `set` gets the field and the word.
template <typename Set>
void read_list(const Source& source, const std::vector<std::string_view>& words, Header& header, const Set& set) {
  if (words.size() - 1 != header.fields.size())
    fail_at(
        source, words[0].data(),
        fmt::format("{} holds {} values, but there are {} fields", words[0], words.size() - 1, header.fields.size()));
  for (std::size_t i = 0; i < header.fields.size(); ++i) set(header.fields[i], words[i + 1]);
}

void settle(const Source& source, Header& header) {
  for (Field& field : header.fields) {
    const bool known = field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
    if (!known || (field.type == 'F' && field.size < 4) || field.count > 1'000'000)
      fail(source, fmt::format("field {} has an unknown type or size; export the file again", quoted(field.name)));
    field.column = header.columns;
    field.offset = header.stride;
    header.columns += field.count;
    header.stride += field.count * field.size;
  }
  if (header.points > max_vertices) fail(source, "has more than 4,294,967,295 points; split it");
}

Header parse_header(const Source& source) {
  Header header;
  std::optional<std::uint64_t> points;
  std::uint64_t width = 0, height = 1;
  for (const char* p = source.begin(); p < source.end();) {
    const char* next = next_line(p, source.end());
    const auto words = words_of({p, static_cast<std::size_t>(next - p)});
    p = next;
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::string_view key = words[0], value = words.size() > 1 ? words[1] : key.substr(key.size());
    if (key == "FIELDS" || key == "COLUMNS") {
      for (std::size_t i = 1; i < words.size(); ++i) header.fields.emplace_back().name = words[i];
    } else if (key == "SIZE") {
      read_list(source, words, header, [&](Field& f, std::string_view word) { f.size = whole(source, word); });
    } else if (key == "TYPE") {
      read_list(source, words, header, [](Field& f, std::string_view word) { f.type = word[0]; });
    } else if (key == "COUNT") {
      read_list(source, words, header, [&](Field& f, std::string_view word) { f.count = whole(source, word); });
    } else if (key == "WIDTH") {
      width = whole(source, value);
    } else if (key == "HEIGHT") {
      height = whole(source, value);
    } else if (key == "POINTS") {
      points = whole(source, value);
    } else if (key == "DATA") {
      header.data = value;
      header.body = p;
      if (height != 0 && width > max_vertices / height) fail(source, "has more than 4,294,967,295 points; split it");
      header.points = points.value_or(width * height);
      settle(source, header);
      return header;
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      fail_at(source, key.data(), fmt::format("{} is no entry of a PCD header", quoted(key)));
    }
  }
  fail(source, "the PCD header has no 'DATA'; the file is truncated");
}

/// The fields of a position or normal; none where one is missing.
using Triple = std::array<const Field*, 3>;
std::optional<Triple> triple(const Header& header, const std::array<std::string_view, 3>& names) {
  Triple found{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto field = std::find_if(header.fields.begin(), header.fields.end(),
                                    [&](const Field& f) { return f.name == names[a] && f.count == 1; });
    if (field == header.fields.end()) return {};
    found[a] = &*field;
  }
  return found;
}

double value_at(const Field& field, const char* bytes) {
  if (field.type == 'F') return field.size == 8 ? load<double>(bytes) : static_cast<double>(load<float>(bytes));
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? load<std::int8_t>(bytes) : static_cast<double>(load<std::uint8_t>(bytes));
    case 2:
      return is_signed ? load<std::int16_t>(bytes) : static_cast<double>(load<std::uint16_t>(bytes));
    case 4:
      return is_signed ? load<std::int32_t>(bytes) : static_cast<double>(load<std::uint32_t>(bytes));
    default:
      return is_signed ? static_cast<double>(load<std::int64_t>(bytes))
                       : static_cast<double>(load<std::uint64_t>(bytes));
  }
}

/// Unpacks LZF (Lehmann's liblzf): runs of bytes, and copies of 3 to 264 bytes that lie up to 8192 back.
std::string unpacked(const Source& source, std::string_view packed, std::size_t size) {
  std::string out;
  out.reserve(std::min(size, 264 * packed.size()));
  const auto require = [&](bool valid) {
    if (!valid) fail(source, "its packed points are damaged; export the file again");
  };
  for (std::size_t i = 0; i < packed.size();) {
    const std::size_t control = static_cast<unsigned char>(packed[i++]);
    if (control < 32) {
      require(control + 1 <= packed.size() - i && control + 1 <= size - out.size());
      out.append(packed.substr(i, control + 1));
      i += control + 1;
      continue;
    }
    std::size_t length = control / 32;
    if (length == 7) {
      require(i < packed.size());
      length += static_cast<unsigned char>(packed[i++]);
    }
    require(i < packed.size());
    const std::size_t back = (control % 32) * 256 + static_cast<unsigned char>(packed[i++]) + 1;
    length += 2;
    require(back <= out.size() && length <= size - out.size());
    for (std::size_t k = 0; k < length; ++k) out += out[out.size() - back];
  }
  require(out.size() == size);
  return out;
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), header_(parse_header(source)) {
    const auto position = triple(header_, {"x", "y", "z"});
    if (!position) fail(source, "its points have no fields x, y and z; export the file again, with positions");
    position_ = *position;
    normal_ = triple(header_, {"normal_x", "normal_y", "normal_z"});
  }

  PointCloud read() {
    if (header_.data == "ascii") {
      read_text();
    } else if (header_.data == "binary") {
      read_rows({header_.body, left()});
    } else if (header_.data == "binary_compressed") {
      read_columns();
    } else {
      fail(source_, fmt::format("holds data of the kind {}; convert it: pcl_convert_pcd_ascii_binary in.pcd out.pcd 0",
                                quoted(header_.data)));
    }
    return std::move(cloud_);
  }

 private:
  std::size_t left() const { return static_cast<std::size_t>(source_.end() - header_.body); }
  void require_bytes(std::size_t there) const {
    if (header_.points <= there / header_.stride) return;
    fail(source_, fmt::format("announces {} points, but holds {}; the file is truncated", header_.points,
                              there / header_.stride));
  }

  /// value(field, point) gives the numbers.
  template <typename Value>
  void fill(const Value& value) {
    cloud_.points.resize(header_.points);
    if (normal_) cloud_.normals.resize(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i) {
      if (i % (1 << 16) == 0) source_.context->throw_if_cancelled();
      for (std::size_t a = 0; a < 3; ++a) {
        cloud_.points[i][static_cast<int>(a)] = value(*position_[a], i);
        if (normal_) cloud_.normals[i][static_cast<int>(a)] = value(*(*normal_)[a], i);
      }
    }
  }

  void read_rows(std::string_view bytes) {
    require_bytes(bytes.size());
    fill([&](const Field& field, std::size_t i) {
      return value_at(field, bytes.data() + i * header_.stride + field.offset);
    });
  }

  /// Packed, field after field.
  void read_columns() {
    if (left() < 8) fail(source_, "ends before its points; the file is truncated");
    const std::size_t packed = load<std::uint32_t>(header_.body), size = load<std::uint32_t>(header_.body + 4);
    if (packed > left() - 8) fail(source_, "ends within its points; the file is truncated");
    const std::string bytes = unpacked(source_, {header_.body + 8, packed}, size);
    require_bytes(bytes.size());
    fill([&](const Field& field, std::size_t i) {
      return value_at(field, bytes.data() + header_.points * field.offset + i * field.size);
    });
  }

  void read_text() {
    const char* p = header_.body;
    if (header_.points > left() / (2 * header_.columns) + 1)
      fail(source_,
           fmt::format("announces {} points, but only {} bytes follow; the file is truncated", header_.points, left()));
    std::vector<double> row(header_.columns);
    std::size_t read = 0;
    fill([&](const Field& field, std::size_t i) {
      if (i == read) {
        read_row(p, row);
        ++read;
      }
      return row[field.column];
    });
  }

  void read_row(const char*& p, std::vector<double>& row) const {
    for (double& value : row) {
      while (p < source_.end() && (is_blank(*p) || *p == '\n')) ++p;
      const char* from = p;
      if (!scan_number(p, source_.end(), value))
        fail_at(source_, from, fmt::format("expected a number, found {}", found_at(source_, from)));
    }
  }

  const Source& source_;
  Header header_;
  Triple position_{};
  std::optional<Triple> normal_;
  PointCloud cloud_;
};

}  // namespace

bool is_pcd(std::string_view bytes) {
  bytes = bytes.substr(0, 4096);
  return bytes.starts_with("# .PCD") || (bytes.starts_with("VERSION ") && bytes.find("\nFIELDS ") != bytes.npos);
}

PointCloud read_pcd(const Source& source) {
  return Reader(source).read();
}

}  // namespace evenmesh
