// A small character: mirrored limbs, smooth joints, carved eyes.
float smin(float a, float b, float k) {
  float h = max(k - abs(a - b), 0.0) / k;
  return min(a, b) - h * h * k * 0.25;
}
float smax(float a, float b, float k) { return -smin(-a, -b, k); }
float ball(vec3 p, float r) { return length(p) - r; }
float capsule(vec3 p, vec3 a, vec3 b, float r) {
  vec3 pa = p - a, ba = b - a;
  return length(pa - ba * clamp(dot(pa, ba) / dot(ba, ba), 0.0, 1.0)) - r;
}
float roundBox(vec3 p, vec3 b, float r) {
  vec3 d = abs(p) - b + r;
  return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0) - r;
}

float head(vec3 p, vec3 m) {
  float d = roundBox(p, vec3(0.42, 0.34, 0.36), 0.16);
  d = smin(d, capsule(m, vec3(0.4, 0.0, 0.0), vec3(0.5, 0.0, 0.0), 0.12), 0.05);              // ears
  d = smax(d, -ball(m - vec3(0.17, 0.06, 0.38), 0.11), 0.03);                                  // eyes
  d = smax(d, -capsule(m, vec3(0.0, -0.14, 0.4), vec3(0.14, -0.11, 0.38), 0.04), 0.03);        // mouth
  d = smin(d, capsule(p, vec3(0.0, 0.3, 0.0), vec3(0.0, 0.52, 0.0), 0.035), 0.06);             // antenna
  return smin(d, ball(p - vec3(0.0, 0.56, 0.0), 0.08), 0.03);
}

float map(vec3 p) {
  vec3 m = vec3(abs(p.x), p.yz);
  float body = roundBox(p, vec3(0.34, 0.4, 0.26), 0.18);
  body = smin(body, capsule(p, vec3(0.0, 0.35, 0.0), vec3(0.0, 0.55, 0.0), 0.13), 0.08);       // neck
  float arm = capsule(m, vec3(0.36, 0.25, 0.0), vec3(0.62, -0.05, 0.08), 0.1);
  arm = smin(arm, capsule(m, vec3(0.62, -0.05, 0.08), vec3(0.6, -0.3, 0.28), 0.09), 0.05);
  arm = smin(arm, ball(m - vec3(0.6, -0.34, 0.33), 0.13), 0.05);
  float leg = capsule(m, vec3(0.18, -0.35, 0.0), vec3(0.2, -0.78, 0.0), 0.13);
  leg = smin(leg, roundBox(m - vec3(0.2, -0.9, 0.07), vec3(0.16, 0.1, 0.24), 0.09), 0.08);
  return smin(smin(body, arm, 0.08), smin(leg, head(p - vec3(0.0, 0.82, 0.0), m - vec3(0.0, 0.82, 0.0)), 0.04), 0.1);
}
