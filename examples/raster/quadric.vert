// Two boxes, one on the other, in which quadric.frag finds its surface.
uniform mat4 viewProjection;
uniform vec3 boundsLow, boundsHigh;
flat out vec3 low, high;  // of the box

void main() {
  const int corner[36] = int[36](0,2,1, 1,2,3, 4,5,6, 5,7,6, 0,1,4, 1,5,4, 2,6,3, 3,6,7, 0,4,2, 2,4,6, 1,3,5, 3,7,5);
  int c = corner[gl_VertexID % 36];
  vec3 middle = 0.5 * (boundsLow + boundsHigh), reach = 0.49 * (boundsHigh - boundsLow);
  low = middle - reach, high = middle + reach;
  if (gl_VertexID < 36) high.z = middle.z; else low.z = middle.z;
  gl_Position = viewProjection * vec4(mix(low, high, vec3(c & 1, c >> 1 & 1, c >> 2 & 1)), 1.0);
}
