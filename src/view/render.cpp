#include "evenmesh/render.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "geometry/triangle.h"
#include "measure/topology.h"
#include "measure/triangle_quality.h"
#include "view/camera.h"
#include "view/colour.h"
#include "view/lit_mesh.h"

namespace evenmesh {
namespace {

const Colour surface_colour = from_srgb(0xe9e6e0), back_colour = from_srgb(0xd8946f), wire_colour = from_srgb(0x27303c);
const Colour sky_colour = from_srgb(0xfafbfc), floor_colour = from_srgb(0xe3e8ee);
const Colour valence5_colour = from_srgb(0x1f6fd6), valence7_colour = from_srgb(0xd8352a),
             other_valence_colour = from_srgb(0x8e35c0);

void check(const Mesh& mesh, const RenderOptions& options) {
  if (mesh.triangles.empty()) throw InvalidInput("a mesh without triangles cannot be drawn");
  if (options.width < 16 || options.width > 8192 || options.height < 16 || options.height > 8192)
    throw InvalidInput("the picture's width and height must lie between 16 and 8192 pixels");
  if (options.antialias < 1 || options.antialias > 8) throw InvalidInput("antialias must lie between 1 and 8");
  if (options.up != 'y' && options.up != 'z') throw InvalidInput("the up axis must be 'y' or 'z'");
  if (!std::isfinite(options.azimuth) || !std::isfinite(options.elevation))
    throw InvalidInput("the camera's azimuth and elevation must be numbers of degrees");
}

/// Everything that is the same for all samples of a picture.
struct Stage {
  const Mesh& mesh;
  const LitMesh& lit;
  const RenderOptions& options;
  Camera camera;
  std::vector<Vec3> screen;           ///< vertices in the picture, pixels
  std::vector<VertexState> vertices;  ///< valences; empty when not needed
  double wire_width = 1;              ///< pixels
  double dot_opacity = 0;
  double dot_radius = 0;  ///< pixels
};

/// Mean edge length in the picture, had the mesh faced the viewer everywhere.
double edge_pixels(const Stage& stage) {
  double sum = 0;
  for (const Triangle& t : stage.mesh.triangles) sum += norm(stage.mesh.vertices[t[0]] - stage.mesh.vertices[t[1]]);
  return stage.camera.scale * sum / static_cast<double>(stage.mesh.triangles.size());
}

Stage set_up(const Mesh& mesh, const LitMesh& lit, const RenderOptions& options, const ExecutionContext& context) {
  Stage stage{mesh, lit, options, fit_camera(mesh, options), {}, {}};
  stage.screen.resize(mesh.vertices.size());
  parallel_for(context, mesh.vertices.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) stage.screen[v] = stage.camera.project(mesh.vertices[v]);
  });
  const double edge = edge_pixels(stage);
  stage.wire_width = std::clamp(edge / 16, 0.8, 1.3) * std::max(1.0, options.height / 1400.0);
  if (!options.quality_colours) {
    stage.vertices = measure_topology(mesh).vertices;
    stage.dot_radius = std::clamp(0.17 * edge, 1.0, std::max(1.0, 0.007 * std::min(options.width, options.height)));
    stage.dot_opacity = 0.95 * std::clamp((edge - 2.5) / 6, 0.15, 1.0);
  }
  return stage;
}

constexpr std::uint32_t nothing = RTC_INVALID_GEOMETRY_ID;

constexpr std::size_t packet = 8;  // rays that Embree traces together

struct Sample {
  double x = 0, y = 0;               ///< pixels
  std::uint32_t triangle = nothing;  ///< the one that appears there
};

/// Finds the triangles that appear at up to `packet` samples.
void trace(const Stage& stage, Sample* samples, std::size_t count) {
  alignas(32) int valid[packet];
  RTCRayHit8 hits{};
  const Vec3& towards = stage.camera.towards;
  for (std::size_t i = 0; i < packet; ++i) {
    valid[i] = i < count ? -1 : 0;
    const Sample& sample = samples[std::min(i, count - 1)];
    // The mesh lies within the ball of radius 1 around the scene's origin.
    const Vec3 seen = stage.lit.scene.to_local(stage.camera.unproject(sample.x, sample.y));
    const Vec3 from = seen + (2.5 - dot(seen, towards)) * towards;
    RTCRay8& ray = hits.ray;
    ray.org_x[i] = static_cast<float>(from.x);
    ray.dir_x[i] = static_cast<float>(-towards.x);
    ray.org_y[i] = static_cast<float>(from.y);
    ray.dir_y[i] = static_cast<float>(-towards.y);
    ray.org_z[i] = static_cast<float>(from.z);
    ray.dir_z[i] = static_cast<float>(-towards.z);
    ray.tfar[i] = 10;
    ray.mask[i] = ~0u;
    hits.hit.geomID[i] = hits.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, stage.lit.scene.handle(), &context, &hits);
  for (std::size_t i = 0; i < count; ++i)
    samples[i].triangle = hits.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? nothing : hits.hit.primID[i];
}

/// A triangle in the picture, ready to answer for the samples that hit it.
struct Face {
  std::uint32_t triangle = nothing;
  std::array<Vec3, 3> corners;  ///< pixels
  std::array<double, 3> edge;   ///< lengths of the edges opposite the corners, pixels
  std::array<Vec3, 3> normals;  ///< towards the viewer
  std::array<double, 3> openness{};
  std::array<const Colour*, 3> dots{};  ///< mark of an irregular corner
  double wire_opacity = 0;
  double area = 0;  ///< twice, signed, pixels squared
  Colour colour;
};

double area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

const Colour* mark_of(const VertexState& v) {
  if (v.on_boundary || v.valence == 6) return nullptr;
  return v.valence == 5 ? &valence5_colour : v.valence == 7 ? &valence7_colour : &other_valence_colour;
}

Face prepare(const Stage& stage, std::uint32_t triangle) {
  Face face;
  face.triangle = triangle;
  const Triangle& t = stage.mesh.triangles[triangle];
  const auto [a, b, c] = corners_of(stage.mesh, triangle);
  face.normals = stage.lit.corner_normals(stage.mesh, triangle);
  const bool back = dot(area_normal(a, b, c), stage.camera.towards) < 0;
  for (int k = 0; k < 3; ++k) {
    face.corners[k] = stage.screen[t[k]];
    face.openness[k] = back ? 0.8 : stage.lit.openness[t[k]];
    if (back) face.normals[k] = -face.normals[k];
    if (!stage.vertices.empty()) face.dots[k] = mark_of(stage.vertices[t[k]]);
  }
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = face.corners[(k + 1) % 3] - face.corners[(k + 2) % 3];
    face.edge[k] = std::hypot(e.x, e.y);
  }
  face.area = area_of(face.corners[0], face.corners[1], face.corners[2]);
  // Wires fade where a triangle is but a few pixels wide in the picture.
  const double longest = *std::max_element(face.edge.begin(), face.edge.end());
  const double altitude = longest > 0 ? std::abs(face.area) / longest : 0;
  if (stage.options.wireframe) face.wire_opacity = 0.74 * std::clamp((altitude - 1.5) / 7, 0.0, 1.0);
  const bool by_quality = stage.options.quality_colours;
  face.colour = by_quality ? quality_colour(triangle_quality(a, b, c).q) : back ? back_colour : surface_colour;
  return face;
}

double to_the_32nd(double x) {
  for (int i = 0; i < 5; ++i) x *= x;
  return x;
}

/// Key light from the upper left, a cooler fill from the right, sky and floor; a faint highlight.
Colour shade(const Stage& stage, const Colour& colour, const Vec3& normal, double openness) {
  const Camera& c = stage.camera;
  const Vec3 n{dot(normal, c.right), dot(normal, c.up), dot(normal, c.towards)};
  const Vec3 key = normalized(Vec3{-0.55, 0.75, 0.85}), fill = normalized(Vec3{0.9, -0.1, 0.55});
  const double sky = 0.5 + 0.5 * n.y;
  // Soft lights: they still reach a little around the edge.
  const double key_light = std::max(0.0, (dot(n, key) + 0.15) / 1.15), fill_light = std::max(0.0, dot(n, fill));
  const double open = openness * (0.4 + 0.6 * openness);
  const Colour ambient = mix(Colour{0.16, 0.155, 0.15}, Colour{0.33, 0.36, 0.40}, sky) * open;
  const Colour lights = Colour{0.80, 0.77, 0.72} * key_light + Colour{0.12, 0.15, 0.20} * fill_light;
  const Colour direct = lights * (0.3 + 0.7 * open);
  const Vec3 half = normalized(key + Vec3{0, 0, 1});
  const double highlight = 0.06 * to_the_32nd(std::max(0.0, dot(n, half))) * open;
  return times(colour, ambient + direct) + Colour{highlight, highlight, highlight};
}

/// How much of a line of the given width covers a sample at `distance` from its middle, all in pixels; `blur` is the
/// distance between samples.
double coverage(double distance, double width, double blur) {
  return std::clamp((0.5 * width - distance) / blur + 0.5, 0.0, 1.0);
}

Colour colour_at(const Stage& stage, const Face& face, double x, double y) {
  const Vec3 p{x, y, 0};
  std::array<double, 3> weight;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    // The ray was traced in float: the sample may lie a hair outside.
    weight[k] = std::max(0.0, area_of(p, face.corners[(k + 1) % 3], face.corners[(k + 2) % 3]) / face.area);
    sum += weight[k];
  }
  if (!(sum > 0) || !std::isfinite(sum)) {
    weight = {1, 1, 1};
    sum = 3;
  }
  Vec3 normal;
  double openness = 0, to_edge = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    weight[k] /= sum;
    normal += weight[k] * face.normals[k];
    openness += weight[k] * face.openness[k];
    if (face.edge[k] > 0) to_edge = std::min(to_edge, weight[k] * std::abs(face.area) / face.edge[k]);
  }
  Colour colour = face.colour;
  const double blur = 1.0 / stage.options.antialias;
  colour = mix(colour, wire_colour, face.wire_opacity * coverage(to_edge, stage.wire_width, blur));
  for (int k = 0; k < 3; ++k)
    if (face.dots[k]) {
      const double distance = std::hypot(x - face.corners[k].x, y - face.corners[k].y);
      colour = mix(colour, *face.dots[k], stage.dot_opacity * coverage(distance, 2 * stage.dot_radius, blur));
    }
  return shade(stage, colour, normalized(normal), openness);
}

/// All samples of a row of pixels, those of a pixel together.
std::vector<Sample> trace_row(const Stage& stage, int row) {
  const int n = stage.options.antialias;
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(stage.options.width * n * n));
  for (int column = 0; column < stage.options.width; ++column)
    for (int i = 0; i < n * n; ++i) samples.push_back({column + (i % n + 0.5) / n, row + (i / n + 0.5) / n});
  for (std::size_t i = 0; i < samples.size(); i += packet)
    trace(stage, samples.data() + i, std::min(packet, samples.size() - i));
  return samples;
}

void render_row(const Stage& stage, int row, std::uint8_t* to) {
  const std::vector<Sample> samples = trace_row(stage, row);
  const Colour background = mix(sky_colour, floor_colour, (row + 0.5) / stage.options.height);
  const auto per_pixel = static_cast<std::size_t>(stage.options.antialias * stage.options.antialias);
  Face face;
  for (std::size_t first = 0; first < samples.size(); first += per_pixel) {
    Colour sum;
    for (std::size_t i = first; i < first + per_pixel; ++i) {
      const auto& [x, y, triangle] = samples[i];
      if (triangle != nothing && triangle != face.triangle) face = prepare(stage, triangle);
      sum += triangle == nothing ? background : colour_at(stage, face, x, y);
    }
    for (int k = 0; k < 3; ++k) *to++ = to_srgb_byte(sum[k] / static_cast<double>(per_pixel));
  }
}

}  // namespace

Image render_lit(const Mesh& mesh, const LitMesh& lit, const RenderOptions& options, const ExecutionContext& context) {
  check(mesh, options);
  return with_threads(context, [&] {
    const Stage stage = set_up(mesh, lit, options, context);
    Image image{options.width, options.height, {}};
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(options.width);
    image.rgb.resize(row_bytes * static_cast<std::size_t>(options.height));
    parallel_for(context, static_cast<std::size_t>(options.height), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        render_row(stage, static_cast<int>(row), image.rgb.data() + row * row_bytes);
    });
    return image;
  });
}

Image render_mesh(const Mesh& mesh, const RenderOptions& options, ExecutionContext& context) {
  check(mesh, options);
  return render_lit(mesh, light_mesh(mesh, context), options, context);
}

}  // namespace evenmesh
