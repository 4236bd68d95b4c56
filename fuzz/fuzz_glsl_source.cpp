/// Fuzzes what turns a user's shader into ours, without compiling it; seeds are in tests/corpus/glsl_source.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "evenmesh/error.h"
#include "gl/glsl_source.h"

namespace {

/// Any bytes give a source whose lines are all accounted for, or a sentence.
void check(const std::string& text, const std::string& entry, const std::map<std::string, std::string>& definitions) {
  try {
    const evenmesh::gl::GlslSource source = evenmesh::gl::prepare_glsl({text, "fuzz.glsl"}, entry, definitions);
    const auto lines = std::count(source.code.begin(), source.code.end(), '\n');
    if (static_cast<std::size_t>(lines) != source.offsets.size()) std::abort();
    for (const std::size_t offset : source.offsets) {
      if (offset > text.size()) std::abort();
    }
    (void)source.explain("0:" + std::to_string(1 + lines / 2) + "(1): error: x\n");
    (void)source.explain(text);
  } catch (const evenmesh::UnusableInput&) {
  } catch (const evenmesh::InvalidInput&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  check(text, "map", {});
  check(text, "map", {{"k", "1"}, {"c", "1,2,3"}, {"SIZE", "0.5"}});
  return 0;
}
