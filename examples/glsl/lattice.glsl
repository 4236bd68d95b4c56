// Struts and balls, repeated through space and cut to a cube with round edges: a printable lattice.
uniform float cell = 0.64;
uniform float strut = 0.15;

float smin(float a, float b, float k) {
  float h = max(k - abs(a - b), 0.0);
  return min(a, b) - 0.25 * h * h / k;
}

vec3 repeat(vec3 p) { return mod(p + 0.5 * cell, cell) - 0.5 * cell; }

float frame(vec3 p) {
  float struts = min(length(p.xy), min(length(p.yz), length(p.zx))) - strut;
  return smin(struts, length(p) - 2.1 * strut, 0.4 * strut);
}

float roundCube(vec3 p, float side, float r) {
  vec3 d = abs(p) - side + r;
  return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0) - r;
}

float map(vec3 p) { return -smin(-frame(repeat(p)), -roundCube(p, 0.9, 0.15), 0.08); }
