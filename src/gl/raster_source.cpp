#include "gl/raster_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "evenmesh/error.h"
#include "gl/glsl_emit.h"
#include "gl/glsl_loops.h"
#include "gl/glsl_needs.h"
#include "gl/glsl_outline.h"
#include "gl/glsl_uniforms.h"
#include "gl/glsl_values.h"

namespace evenmesh::gl {
namespace {

constexpr std::string_view default_vertex = R"(in vec3 position;
in vec3 normal;
out vec3 vertex_position;
out vec3 vertex_normal;
uniform mat4 viewProjection;
void main() {
  vertex_position = position;
  vertex_normal = normal;
  gl_Position = viewProjection * vec4(position, 1.0);
}
)";
constexpr std::string_view default_fragment = "void main() {}\n";

/// What views set.
const StageUniforms& view_uniforms() {
  static const StageUniforms uniforms{{"viewProjection", "mat4"}, {"inverseViewProjection", "mat4"},
                                      {"viewDirection", "vec3"},  {"boundsLow", "vec3"},
                                      {"boundsHigh", "vec3"},     {"pixelSize", "float"},
                                      {"viewportSize", "vec2"}};
  return uniforms;
}

constexpr std::uint32_t some_loop = 0xffffffffu;  ///< instead of a line

/// What has another name in our shaders, or is reserved in desktop GLSL.
std::string_view common_replacement(std::string_view word) {
  static const std::map<std::string_view, std::string_view> words{
      {"main", "em_user_main"},         {"surface_normal", "em_surface_normal"},
      {"gl_FragColor", "em_FragColor"}, {"gl_FragData", "em_FragData"},
      {"gl_FragDepth", "em_FragDepth"}, {"attribute", "in"},
      {"sample", "em_sample"},          {"shared", "em_shared"},
      {"buffer", "em_buffer"},          {"patch", "em_patch"},
      {"subroutine", "em_subroutine"},  {"active", "em_active"},
      {"filter", "em_filter"}};
  const auto found = words.find(word);
  return found == words.end() ? word : found->second;
}
std::string_view vertex_replacement(std::string_view word) {
  return word == "varying" ? "out" : common_replacement(word);
}
std::string_view fragment_replacement(std::string_view word) {
  return word == "varying" ? "in" : common_replacement(word);
}

/// A text in the making.
struct Draft {
  GlslSource source{};
  std::vector<GlslToken> tokens{};
  GlslOutline outline{};
  Definitions given{};
  std::set<std::string> words{};   ///< all of it
  std::set<std::string> needed{};  ///< by main()
};

Draft read(GlslText text) {
  Draft draft;
  draft.source.text = std::move(text);
  draft.tokens = tokenize_glsl(draft.source.text);
  draft.outline = outline_glsl(draft.source.text, draft.tokens);
  for (const GlslToken& token : draft.tokens)
    if (token.is_word()) draft.words.insert(token.text);
  for (const auto& [name, macro] : draft.outline.macros) draft.words.insert(macro.words.begin(), macro.words.end());
  const auto is_main = [](const GlslFunction& f) { return f.name == "main" && f.arguments.empty(); };
  if (std::none_of(draft.outline.functions.begin(), draft.outline.functions.end(), is_main))
    throw InvalidInput(draft.source.text.name + ": there is no function void main()");
  return draft;
}

/// Whether a definition belongs to this text: a uniform, a macro, or what hosts of shaders set.
bool takes(const Draft& draft, const std::string& name) {
  const auto declares = [&](const GlslGlobal& global) {
    const auto begin = draft.tokens.begin() + static_cast<std::ptrdiff_t>(global.tokens.begin);
    const auto end = draft.tokens.begin() + static_cast<std::ptrdiff_t>(global.tokens.end);
    return std::any_of(begin, end, [](const GlslToken& t) { return t.is("uniform"); }) &&
           std::any_of(begin, end, [&](const GlslToken& t) { return t.is(name); });
  };
  return draft.outline.macros.contains(name) || draft.outline.conditions.contains(name) ||
         (host_type(name) && draft.words.contains(name)) ||
         std::any_of(draft.outline.globals.begin(), draft.outline.globals.end(), declares);
}

using Values = std::map<std::string, std::string>;

/// The values for each of the texts; what belongs to neither goes to the fragment shader, which refuses it.
std::pair<Values, Values> shared_out(const Draft& vertex, const Draft& fragment, const Values& definitions) {
  std::pair<Values, Values> values;
  for (const auto& [name, value] : definitions) {
    if (view_uniforms().contains(name))
      throw InvalidInput(fmt::format("-D {}: this uniform is set by the views; take another name", name));
    const bool in_vertex = takes(vertex, name);
    if (in_vertex) values.first.emplace(name, value);
    if (!in_vertex || takes(fragment, name)) values.second.emplace(name, value);
  }
  return values;
}

void finish(Draft& draft, const Values& values, Replacement replacement) {
  const GlslText& text = draft.source.text;
  draft.needed = needed_names(draft.outline, draft.tokens, "main");
  draft.given = set_uniforms(text, draft.tokens, draft.outline, draft.needed, values, &view_uniforms());
  replace_words(text, draft.tokens, replacement);
  clean_directives(draft.tokens, draft.given.macros);
  limit_loops(text, draft.tokens);
}

void check_attributes(const Draft& draft) {
  for (const auto& [name, input] : draft.given.inputs) {
    if (name != "position" && name != "normal" && draft.needed.contains(name))
      fail_in_glsl(draft.source.text, input.offset, "vertices have no such attribute; they have position and normal");
  }
}

/// The normal is a variable of ours, set in the one stage where it may be an output.
void check_normal(const Draft& draft) {
  const auto found = draft.given.outputs.find("surface_normal");
  if (found != draft.given.outputs.end() && found->second.type != "vec3")
    fail_in_glsl(draft.source.text, found->second.offset, "surface_normal is a vec3: out vec3 surface_normal");
}

std::string assembled(const GlslSource& source, std::string_view ending, Constants constants) {
  constants.emplace("EM_BUDGET", loop_budget);
  constants.emplace("EM_SOME_LOOP", some_loop);
  return assemble_shader(fmt::format("#include \"guard.glsl\"\n#line 1\n{}#include \"{}\"\n", source.code, ending),
                         constants);
}

}  // namespace

std::string RasterSource::explain(const ShaderError& error) const {
  if (error.stage() == Stage::all)
    return fmt::format("{} and {} do not fit together: {}", vertex.text.name, fragment.text.name,
                       std::string_view(error.log()).substr(0, 500));
  return (error.stage() == Stage::vertex ? vertex : fragment).explain(error.log());
}

RasterSource prepare_raster(GlslText vertex, GlslText fragment, const Values& definitions) {
  if (vertex.text.empty()) vertex.text = default_vertex;
  if (fragment.text.empty()) fragment.text = default_fragment;
  RasterSource raster;
  Draft first = read(std::move(vertex)), second = read(std::move(fragment));
  const auto [of_vertex, of_fragment] = shared_out(first, second, definitions);
  finish(first, of_vertex, vertex_replacement);
  finish(second, of_fragment, fragment_replacement);
  check_attributes(first);
  check_normal(second);
  emit_glsl(first.source, first.tokens, first.outline, first.given);
  emit_glsl(second.source, second.tokens, second.outline, second.given);
  raster.vertex = std::move(first.source);
  raster.fragment = std::move(second.source);
  raster.vertex_text = assembled(raster.vertex, "raster_vertex.glsl", {});
  raster.fragment_text = assembled(raster.fragment, "raster_fragment.glsl",
                                   {{"EM_WRITES_DEPTH", second.words.contains("gl_FragDepth") ? 1 : 0},
                                    {"EM_WRITES_NORMAL", second.words.contains("surface_normal") ? 1 : 0}});
  return raster;
}

}  // namespace evenmesh::gl
