// A quaternion Julia set, q → q² + c, cut at w = 0.
uniform int rounds = 7;
uniform vec4 c = vec4(-0.2, 0.6, 0.2, 0.2);

vec4 square(vec4 q) { return vec4(q.x * q.x - dot(q.yzw, q.yzw), 2.0 * q.x * q.yzw); }

float map(vec3 p) {
  vec4 q = vec4(p, 0.0);
  float dq = 1.0, r = length(q);
  for (int i = 0; i < rounds; ++i) {
    if (r > 4.0) break;
    dq *= 2.0 * r;
    q = square(q) + c;
    r = length(q);
  }
  return 0.5 * log(max(r, 1e-6) / 2.0) * r / max(dq, 1e-6);
}
