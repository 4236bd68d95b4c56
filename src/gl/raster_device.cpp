#include "gl/raster_device.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "evenmesh/error.h"

namespace evenmesh::gl {
namespace {

constexpr std::size_t words_of_fragment = 3;
constexpr std::size_t first_capacity = 65'536;    ///< fragments
constexpr std::uint32_t some_loop = 0xffffffffu;  ///< instead of a line

/// Attributes: three floats for each vertex.
std::vector<float> as_floats(const std::vector<Vec3>& vectors) {
  std::vector<float> floats;
  floats.reserve(3 * vectors.size());
  for (const Vec3& v : vectors)
    for (const double x : {v.x, v.y, v.z}) floats.push_back(static_cast<float>(x));
  return floats;
}

/// Of each vertex the mean of its triangles', weighted by area.
std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 n = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    for (const std::uint32_t v : t) normals[v] += n;
  }
  for (Vec3& n : normals) n = normalized(n);
  return normals;
}

}  // namespace

struct RasterDevice::Objects {
  Program program{};
  GLuint arrays = 0, frame = 0;
  std::vector<GLuint> buffers{};
  GLsizei indices = 0;
  Buffer<std::uint32_t> state{}, fragments{};

  template <typename T>
  GLuint store(const std::vector<T>& values) {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    buffers.push_back(id);
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), 0);
    return id;
  }

  void attribute(const char* name, const std::vector<Vec3>& values) {
    const int at = program.attribute(name);
    if (at < 0) return;
    const auto slot = static_cast<GLuint>(at);
    glVertexArrayVertexBuffer(arrays, slot, store(as_floats(values)), 0, 3 * sizeof(float));
    glVertexArrayAttribFormat(arrays, slot, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(arrays, slot, slot);
    glEnableVertexArrayAttrib(arrays, slot);
  }

  void free() {
    glDeleteVertexArrays(1, &arrays);
    glDeleteFramebuffers(1, &frame);
    glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  }
};

RasterDevice::RasterDevice(std::shared_ptr<Context> context, RasterSource source, const Mesh& geometry,
                           std::size_t vertex_count)
    : source_(std::move(source)),
      context_(std::move(context)),
      objects_(std::make_unique<Objects>()),
      vertex_count_(vertex_count) {
  try {
    context_->run([&] {
      objects_->program =
          Program::drawing(context_, source_.vertex_text, source_.fragment_text, source_.fragment.text.name);
      upload(geometry);
    });
  } catch (const ShaderError& error) {
    throw UnusableInput(source_.explain(error));
  }
}

RasterDevice::~RasterDevice() {
  try {
    context_->run([&] { objects_->free(); });
  } catch (const Error&) {
    // The context is lost, and all that with it.
  }
}

void RasterDevice::upload(const Mesh& geometry) {
  Objects& o = *objects_;
  o.program.set("em_two", 2);
  glCreateVertexArrays(1, &o.arrays);
  glCreateFramebuffers(1, &o.frame);
  glNamedFramebufferParameteri(o.frame, GL_FRAMEBUFFER_DEFAULT_WIDTH, largest_view);
  glNamedFramebufferParameteri(o.frame, GL_FRAMEBUFFER_DEFAULT_HEIGHT, largest_view);
  o.state = Buffer<std::uint32_t>(context_, 3);
  o.fragments = Buffer<std::uint32_t>(context_, words_of_fragment * first_capacity);
  if (!geometry.triangles.empty()) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * geometry.triangles.size());
    for (const Triangle& t : geometry.triangles) indices.insert(indices.end(), t.begin(), t.end());
    o.indices = static_cast<GLsizei>(indices.size());
    glVertexArrayElementBuffer(o.arrays, o.store(indices));
    o.attribute("position", geometry.vertices);
    if (o.program.attribute("normal") >= 0) o.attribute("normal", vertex_normals(geometry));
  } else if (o.program.attribute("position") >= 0 || o.program.attribute("normal") >= 0) {
    throw InvalidInput(source_.vertex.text.name +
                       " reads the attributes of vertices, and there are none: give a mesh to draw");
  }
  context_->check("the vertices");
}

void RasterDevice::set_view(const RasterView& view) const {
  const Program& p = objects_->program;
  p.set_matrix("viewProjection", view.view_projection);
  p.set_matrix("inverseViewProjection", view.inverse);
  p.set("viewDirection", view.direction);
  p.set("boundsLow", view.low);
  p.set("boundsHigh", view.high);
  p.set("pixelSize", view.pixel_size);
  p.set("viewportSize", std::array<float, 2>{static_cast<float>(view.width), static_cast<float>(view.height)});
  p.set("em_back_x", view.back[0]);
  p.set("em_back_y", view.back[1]);
  p.set("em_back_z", view.back[2]);
  p.set("em_axis", view.axis);
  p.set("em_cells", view.cells);
  p.set("em_width", static_cast<std::uint32_t>(view.width));
  p.set("em_capacity", static_cast<std::uint32_t>(objects_->fragments.size() / words_of_fragment));
}

/// Returns how many fragments there were, in the list or not.
std::size_t RasterDevice::draw_once(const RasterView& view) {
  Objects& o = *objects_;
  o.state.fill_with_zeros();
  o.state.bind(0);
  o.fragments.bind(1);
  set_view(view);
  o.program.use();
  glBindFramebuffer(GL_FRAMEBUFFER, o.frame);
  glBindVertexArray(o.arrays);
  glViewport(0, 0, view.width, view.height);
  glFrontFace(view.clockwise ? GL_CW : GL_CCW);
  for (const GLenum off : {GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_BLEND}) glDisable(off);
  glEnable(GL_DEPTH_CLAMP);  // what lies beyond the grid is wanted, too
  const auto count = static_cast<GLsizei>(vertex_count_);
  context_->step("drawing", [indices = o.indices, count] {
    if (indices > 0) {
      glDrawElements(GL_TRIANGLES, indices, GL_UNSIGNED_INT, nullptr);
    } else {
      glDrawArrays(GL_TRIANGLES, 0, count);
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  });
  context_->check("drawing");
  std::array<std::uint32_t, 3> state{};
  o.state.download(state);
  refuse_endless_loops(state[1], state[2]);
  return state[0];
}

void RasterDevice::refuse_endless_loops(std::uint32_t vertex_line, std::uint32_t fragment_line) const {
  if (vertex_line == 0 && fragment_line == 0) return;
  const std::string& name = (vertex_line != 0 ? source_.vertex : source_.fragment).text.name;
  const std::uint32_t line = vertex_line != 0 ? vertex_line : fragment_line;
  throw UnusableInput(
      fmt::format("{}: {} does not end after {} rounds (all loops together); bound it, for instance "
                  "for (int i = 0; i < 100; i++)",
                  line == some_loop ? name : fmt::format("{}:{}", name, line),
                  line == some_loop ? "a loop" : "this loop", loop_budget));
}

bool RasterDevice::draw(const RasterView& view, std::vector<RasterFragment>& fragments) {
  static_assert(sizeof(RasterFragment) == words_of_fragment * sizeof(std::uint32_t));
  bool fits = true;
  context_->run([&] {
    std::size_t count = draw_once(view);
    const std::size_t most = context_->largest_block() / sizeof(RasterFragment);
    while (fits && count * words_of_fragment > objects_->fragments.size()) {
      fits = count <= most;
      if (!fits) return;
      const std::size_t room = std::min(most, count + count / 4);
      objects_->fragments = {};
      objects_->fragments = Buffer<std::uint32_t>(context_, words_of_fragment * room);
      count = draw_once(view);
    }
    std::vector<std::uint32_t> words(words_of_fragment * count);
    objects_->fragments.download(words);
    fragments.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      fragments[i] = {words[3 * i], std::bit_cast<float>(words[3 * i + 1]), words[3 * i + 2]};
  });
  return fits;
}

}  // namespace evenmesh::gl
