#include "gl/program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gl/shader_files.h"

namespace evenmesh::gl {
namespace {

std::string_view file_named(std::string_view name) {
  for (const ShaderFile& file : shader_files()) {
    if (file.name == name) return file.text;
  }
  throw UnusableInput(fmt::format("there is no shader file '{}' in this program", name));
}

void append_with_includes(std::string& out, std::string_view text, int depth) {
  constexpr std::string_view word = "#include \"";
  if (depth > 16) throw UnusableInput("a shader file includes itself");
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with(word) && line.ends_with('"')) {
      append_with_includes(out, file_named(line.substr(word.size(), line.size() - word.size() - 1)), depth + 1);
    } else {
      out.append(line) += '\n';
    }
  }
}

std::string literal(const std::variant<std::int32_t, std::uint32_t, float, std::string>& value) {
  if (const auto* i = std::get_if<std::int32_t>(&value)) return fmt::format("({})", *i);
  if (const auto* u = std::get_if<std::uint32_t>(&value)) return fmt::format("{}u", *u);
  if (const auto* f = std::get_if<float>(&value)) return fmt::format("float({:.9g})", *f);
  return std::get<std::string>(value);
}

std::string log_of(unsigned id, bool is_program) {
  GLint length = 0;
  is_program ? glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length) : glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> log(static_cast<std::size_t>(std::max(length, 1)) + 1, '\0');
  const GLsizei room = static_cast<GLsizei>(log.size());
  is_program ? glGetProgramInfoLog(id, room, nullptr, log.data()) : glGetShaderInfoLog(id, room, nullptr, log.data());
  return log.data();
}

}  // namespace

std::string assemble_shader(std::string_view text, const Constants& constants) {
  std::string out = "#version 450 core\n";
  for (const auto& [name, value] : constants) out += fmt::format("#define {} {}\n", name, literal(value));
  append_with_includes(out, text, 0);
  return out;
}

Program Program::compute(std::shared_ptr<Context> context, const std::string& text, const std::string& name) {
  return link(std::move(context), {{GL_COMPUTE_SHADER, &text}}, name);
}

Program Program::drawing(std::shared_ptr<Context> context, const std::string& vertex, const std::string& fragment,
                         const std::string& name) {
  return link(std::move(context), {{GL_VERTEX_SHADER, &vertex}, {GL_FRAGMENT_SHADER, &fragment}}, name);
}

Program Program::link(std::shared_ptr<Context> context, const std::map<unsigned, const std::string*>& stages,
                      const std::string& name) {
  Program program;
  program.context_ = std::move(context);
  program.id_ = glCreateProgram();
  for (const auto& [kind, text] : stages) {
    const GLuint shader = glCreateShader(kind);
    const char* begin = text->data();
    const GLint length = static_cast<GLint>(text->size());
    glShaderSource(shader, 1, &begin, &length);
    program.context_->step("the compiler of shaders", [shader] { glCompileShader(shader); });
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    const std::string log = good ? "" : log_of(shader, false);
    glAttachShader(program.id_, shader);
    glDeleteShader(shader);  // with the program
    const Stage stage = kind == GL_VERTEX_SHADER     ? Stage::vertex
                        : kind == GL_FRAGMENT_SHADER ? Stage::fragment
                                                     : Stage::compute;
    if (!good) throw ShaderError(name, log, stage);
  }
  program.context_->step("the compiler of shaders", [id = program.id_] { glLinkProgram(id); });
  GLint good = 0;
  glGetProgramiv(program.id_, GL_LINK_STATUS, &good);
  if (!good) throw ShaderError(name, log_of(program.id_, true), Stage::all);
  program.context_->check("the shader");
  return program;
}

Program::~Program() {
  if (id_ == 0) return;
  try {
    context_->run([&] { glDeleteProgram(id_); });
  } catch (const Error&) {
    // The context is lost, and the program with it.
  }
}

int Program::location(const char* uniform) const {
  return glGetUniformLocation(id_, uniform);
}

int Program::attribute(const char* name) const {
  return glGetAttribLocation(id_, name);
}

void Program::set(const char* uniform, float value) const {
  glProgramUniform1f(id_, location(uniform), value);
}

void Program::set(const char* uniform, std::int32_t value) const {
  glProgramUniform1i(id_, location(uniform), value);
}

void Program::set(const char* uniform, std::uint32_t value) const {
  glProgramUniform1ui(id_, location(uniform), value);
}

void Program::set(const char* uniform, const std::array<float, 2>& value) const {
  glProgramUniform2fv(id_, location(uniform), 1, value.data());
}

void Program::set(const char* uniform, const std::array<float, 3>& value) const {
  glProgramUniform3fv(id_, location(uniform), 1, value.data());
}

void Program::set(const char* uniform, const std::array<float, 4>& value) const {
  glProgramUniform4fv(id_, location(uniform), 1, value.data());
}

void Program::set_matrix(const char* uniform, const std::array<float, 16>& value) const {
  glProgramUniformMatrix4fv(id_, location(uniform), 1, GL_FALSE, value.data());
}

void Program::use() const {
  glUseProgram(id_);
}

void Program::dispatch(std::string_view what, unsigned groups_x, unsigned groups_y, unsigned groups_z) const {
  use();
  context_->step(what, [groups_x, groups_y, groups_z] {
    glDispatchCompute(groups_x, groups_y, groups_z);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  });
  context_->check(what);
}

}  // namespace evenmesh::gl
