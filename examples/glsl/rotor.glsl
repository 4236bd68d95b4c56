// A rotor of modelling operators: polar repetition, mirrored domains, chamfered and grooved unions.
const float pi = 3.14159265;

void rotate(inout vec2 p, float a) { p = cos(a) * p + sin(a) * vec2(p.y, -p.x); }

// Folds the plane into one of `n` sectors around its x axis; returns which.
float sectors(inout vec2 p, float n) {
  float width = 2.0 * pi / n, a = atan(p.y, p.x) + 0.5 * width, r = length(p), id = floor(a / width);
  a = mod(a, width) - 0.5 * width;
  p = r * vec2(cos(a), sin(a));
  return id;
}

float mirror(inout float x) { float side = sign(x); x = abs(x); return side; }

float tube(vec3 p, float r, float h) {
  vec2 d = vec2(length(p.xz) - r, abs(p.y) - h) + 0.06;  // rounded
  return length(max(d, 0.0)) + min(max(d.x, d.y), 0.0) - 0.06;
}

float box(vec3 p, vec3 b) { vec3 d = abs(p) - b; return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0); }

float unionChamfer(float a, float b, float r) { return min(min(a, b), (a - r + b) * 0.70710678); }
float unionRound(float a, float b, float r) {
  vec2 u = max(vec2(r - a, r - b), vec2(0.0));
  return max(r, min(a, b)) - length(u);
}
float groove(float a, float b, float depth, float width) {
  float bottom = a + depth, wall = width - abs(b);
  return unionRound(-a, -unionRound(bottom, wall, 0.03), 0.03) * -1.0;
}

float map(vec3 p) {
  float hub = tube(p, 0.42, 0.3);
  vec3 q = p;
  sectors(q.xz, 3.0);
  q.x -= 0.85;
  rotate(q.yz, 0.5);
  float blade = box(q, vec3(0.5, 0.08, 0.2)) - 0.09;
  float d = unionRound(hub, blade, 0.1);
  float rim = length(vec2(max(abs(length(p.xz) - 1.32) - 0.06, 0.0), max(abs(p.y) - 0.18, 0.0))) - 0.06;
  d = unionChamfer(d, rim, 0.05);
  d = groove(d, p.y, 0.05, 0.08);
  vec3 m = p;
  mirror(m.y);
  return max(d, -tube(m, 0.18, 1.0));
}
