// A user's fragment shader, whose fragments go into a list in any order: pixel and whether it enters, place along the
// view, normal.
#line 1300001
layout(std430, binding = 0) restrict buffer EmState { uint em_count, em_late_vertex, em_late_fragment; };
layout(std430, binding = 1) writeonly restrict buffer EmFragments { uint em_fragments[]; };

in vec2 em_clip;
flat in uint em_vertex_late;

uniform uint em_capacity;  // fragments that the list has room for
uniform uint em_width;     // pixels in a row
uniform float em_cells;    // cells from the grid's first to its last point along the view
uniform int em_axis;       // of the view
uniform vec3 em_back_x, em_back_y, em_back_z;  // columns of the matrix from the world to the model
uniform int em_two;                            // 2

bool em_is_finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

// Octahedral, as pack_normal(); all bits where there is none.
uint em_pack(vec3 n) {
  n = normalize(n / max(max(abs(n.x), abs(n.y)), abs(n.z)));
  if (!em_is_finite(n)) return 0xffffffffu;
  vec2 u = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) u = (1.0 - abs(u.yx)) * vec2(u.x < 0.0 ? -1.0 : 1.0, u.y < 0.0 ? -1.0 : 1.0);
  uvec2 bits = uvec2(floor((u * 0.5 + 0.5) * 65534.0 + 0.5));
  return bits.x | bits.y << 16;
}

// Of a surface that rises by these many cells per pixel.
vec3 em_sloped(vec2 slope) {
  if (em_axis == 0) return vec3(1.0, -slope.x, -slope.y);
  if (em_axis == 1) return vec3(-slope.x, 1.0, -slope.y);
  return vec3(-slope.x, -slope.y, 1.0);
}

void main() {
  float along = em_clip.x / em_clip.y;  // -1 to 1 from the grid's first to its last point
  vec2 slope = vec2(dFdx(along), dFdy(along));
  bool enters = gl_FrontFacing;
  em_FragDepth = gl_FragCoord.z;
#if EM_WRITES_NORMAL
  em_surface_normal = vec3(0.0);
#endif
  em_user_main();
#if EM_WRITES_DEPTH
  if (em_FragDepth != gl_FragCoord.z) along = 2.0 * em_FragDepth - 1.0;
  slope = vec2(dFdx(along), dFdy(along));
#endif
  uint normal = 0xffffffffu;
#if EM_WRITES_NORMAL
  vec3 n = vec3(dot(em_back_x, em_surface_normal), dot(em_back_y, em_surface_normal), dot(em_back_z, em_surface_normal));
  normal = em_pack(n);
#if EM_WRITES_DEPTH
  float towards = n[em_axis];
  if (normal != 0xffffffffu && towards != 0.0) enters = towards < 0.0;
#endif
#endif
  if (normal == 0xffffffffu) normal = em_pack(em_sloped(slope * (0.5 * em_cells)));
  // llvmpipe leaves all loops after 65,535 rounds of a group of pixels, and says nothing: then this one stops early.
  int canary = 0;
  while (canary < em_two) ++canary;
  if (canary != em_two && em_late_line == 0u) em_late_line = EM_SOME_LOOP;
  if (em_late_line != 0u) em_late_fragment = em_late_line;
  if (em_vertex_late != 0u) em_late_vertex = em_vertex_late;
  uint place = atomicAdd(em_count, 1u);
  if (place >= em_capacity) return;
  uint pixel = uint(gl_FragCoord.y) * em_width + uint(gl_FragCoord.x);
  em_fragments[3u * place] = pixel | (enters ? 0x80000000u : 0u);
  em_fragments[3u * place + 1u] = floatBitsToUint(along);
  em_fragments[3u * place + 2u] = normal;
}
