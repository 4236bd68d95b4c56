// Values of a function at points. Row 0 of the groups takes the points themselves; rows 1 to 6, if there are, take
// points moved by a step along +x, -x, +y, -y, +z, -z.
#line 1100001
layout(local_size_x = EM_GROUP) in;

layout(std430, binding = 0) readonly restrict buffer EmPoints { float em_points[]; };  // all x, all y, all z
layout(std430, binding = 1) writeonly restrict buffer EmValues { float em_values[]; };  // row after row
layout(std430, binding = 2) restrict buffer EmLate { uint em_late[]; };                 // line of a loop that did not end

uniform uint em_count;
uniform float em_level;
uniform int em_two;  // 2
uniform float em_scale;  // a power of two: steps are at least 1/1024 of it

// The largest power of two that is not above |p| or the scale, times 2^-10.
float em_step(vec3 p) {
  float size = max(max(abs(p.x), max(abs(p.y), abs(p.z))), em_scale);
  return uintBitsToFloat(floatBitsToUint(size) & 0x7f800000u) * EM_STEP;
}

void main() {
  uint i = gl_GlobalInvocationID.x, row = gl_GlobalInvocationID.y;
  if (i >= em_count) return;
  vec3 p = vec3(em_points[i], em_points[em_count + i], em_points[2u * em_count + i]);
  if (row != 0u) {
    float to = (row & 1u) != 0u ? em_step(p) : -em_step(p);
    uint axis = (row - 1u) >> 1;
    p += vec3(axis == 0u ? to : 0.0, axis == 1u ? to : 0.0, axis == 2u ? to : 0.0);
  }
  float value = em_first(EM_ENTRY(p)) - em_level;
  // llvmpipe leaves all loops after 65,535 rounds of a group of points, and says nothing: then this one stops early.
  int canary = 0;
  while (canary < em_two) ++canary;
  if (canary != em_two && em_late_line == 0u) em_late_line = EM_SOME_LOOP;
  if (em_late_line != 0u) {
    value = uintBitsToFloat(0x7fc00000u);
    em_late[0] = em_late_line;
  }
  em_values[row * em_count + i] = value;
}
