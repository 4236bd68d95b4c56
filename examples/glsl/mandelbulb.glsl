// The Mandelbulb of degree `power`: z → z^power + c in spherical coordinates, which never escapes from inside.
// `rounds` says how much of it is seen: more of them, more detail.
uniform float power = 8.0;
uniform int rounds = 2;
uniform float skin = 0.02;

float map(vec3 p) {
  vec3 z = p;
  float dr = 1.0, r = length(z);
  for (int i = 0; i < rounds && r < 8.0; ++i) {
    float theta = power * acos(clamp(z.z / r, -1.0, 1.0)), phi = power * atan(z.y, z.x);
    dr = power * pow(r, power - 1.0) * dr + 1.0;
    z = pow(r, power) * vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)) + p;
    r = length(z);
  }
  // A distance outside; what did not escape is inside, and as far from it as the last step went.
  return 0.5 * log(max(r, 1e-4) / 1.3) * r / dr - skin;
}
