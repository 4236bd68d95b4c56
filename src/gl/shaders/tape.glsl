// Values of a tape at points, or values and gradients. The tape itself follows as em_value() and em_gradient().
#line 1200001
layout(local_size_x = EM_GROUP) in;

layout(std430, binding = 0) readonly restrict buffer EmPoints { float em_points[]; };  // all x, all y, all z
layout(std430, binding = 1) writeonly restrict buffer EmValues { float em_values[]; };  // row after row

uniform uint em_count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= em_count) return;
  vec3 p = vec3(em_points[i], em_points[em_count + i], em_points[2u * em_count + i]);
#if EM_ROWS == 4
  vec4 f = em_gradient(p);
  em_values[i] = f.x;
  em_values[em_count + i] = f.y;
  em_values[2u * em_count + i] = f.z;
  em_values[3u * em_count + i] = f.w;
#else
  em_values[i] = map(p);
#endif
}
