/// Dexel files: a header of 96 bytes, then 16 for each crossing (docs/formats.md).

#include <fmt/format.h>

#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "io/binary.h"
#include "io/bytes.h"
#include "io/source.h"

namespace evenmesh {
namespace {

constexpr std::string_view family = "evenmesh dexels", magic = "evenmesh dexels 1\n";
constexpr std::size_t header_size = 96, crossing_size = 16, origin_at = 32;

}  // namespace

bool is_dexel_file(std::string_view bytes) {
  return bytes.starts_with(family);
}

Dexels parse_dexels(std::string_view bytes, std::string_view name) {
  const Source source{bytes, name};
  if (!bytes.starts_with(magic)) {
    if (!bytes.empty() && magic.starts_with(bytes)) fail(source, "is truncated; write it again with --dump-dexels");
    fail(source,
         "is no dexel file of this version: it must begin with 'evenmesh dexels 1'; write it again with "
         "--dump-dexels");
  }
  if (bytes.size() < header_size)
    fail(source, "is truncated: its header has 96 bytes; write it again with --dump-dexels");
  const char* at = bytes.data() + origin_at;
  Dexels dexels;
  for (int a = 0; a < 3; ++a) dexels.origin[a] = load<double>(at + 8 * a);
  dexels.spacing = load<double>(at + 24);
  for (std::size_t a = 0; a < 3; ++a) dexels.size[a] = load<std::uint32_t>(at + 32 + 4 * a);
  const auto count = load<std::uint64_t>(at + 48);
  if (count != (bytes.size() - header_size) / crossing_size || (bytes.size() - header_size) % crossing_size != 0)
    fail(source,
         fmt::format("says {} crossings, but holds {} bytes of them, 16 each; write it again with --dump-dexels", count,
                     bytes.size() - header_size));
  dexels.crossings.resize(count);
  at = bytes.data() + header_size;
  for (Dexels::Crossing& c : dexels.crossings) {
    for (std::size_t a = 0; a < 3; ++a) c.point[a] = load<std::uint16_t>(at + 2 * a);
    const auto what = load<std::uint8_t>(at + 6);
    c.axis = what & 3;
    c.leaves = (what & 4) != 0;
    c.t = load<float>(at + 8);
    c.normal = load<std::uint32_t>(at + 12);
    at += crossing_size;
  }
  return dexels;
}

Dexels read_dexels(const std::filesystem::path& path, ExecutionContext& context) {
  context.throw_if_cancelled();
  const FileBytes bytes = load_file(path);
  return parse_dexels(bytes.view(), name_of_input(path));
}

std::string serialize_dexels(const Dexels& dexels) {
  ByteWriter out(header_size + crossing_size * dexels.crossings.size());
  out.put(magic);
  out.skip(origin_at - magic.size());
  for (int a = 0; a < 3; ++a) out.put(dexels.origin[a]);
  out.put(dexels.spacing);
  for (const std::uint32_t n : dexels.size) out.put(n);
  out.skip(4);
  out.put(static_cast<std::uint64_t>(dexels.crossings.size()));
  out.skip(header_size - origin_at - 56);
  for (const Dexels::Crossing& c : dexels.crossings) {
    for (const std::uint16_t p : c.point) out.put(p);
    out.put(static_cast<std::uint8_t>(c.axis | (c.leaves ? 4 : 0)));
    out.skip(1);
    out.put(c.t);
    out.put(c.normal);
  }
  return out.take();
}

}  // namespace evenmesh
