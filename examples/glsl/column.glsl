// A twisted, fluted column on a base, with the habits of a page of Shadertoy: mainImage() is not needed here and left out.
#define TURNS 0.9
#define rot(a) mat2(cos(a), -sin(a), sin(a), cos(a))

float roundBox(vec3 p, vec3 b, float r) {
  vec3 d = abs(p) - b + r;
  return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0) - r;
}

float smin(float a, float b, float k) {
  float h = max(k - abs(a - b), 0.0) / k;
  return min(a, b) - h * h * k * 0.25;
}

void twist(inout vec3 p, float amount) { p.xz = rot(amount * p.y) * p.xz; }

float map(vec3 p) {
  vec3 q = p;
  twist(q, TURNS * 3.14159265 / 2.0);
  float angle = atan(q.z, q.x), radius = length(q.xz);
  float shaft = max(radius - 0.42 - 0.06 * cos(6.0 * angle), abs(p.y) - 1.5) * 0.7;
  vec3 end = vec3(p.x, abs(p.y) - 1.5, p.z);
  float plates = roundBox(end, vec3(0.72, 0.14, 0.72), 0.06);
  return smin(shaft, plates, 0.12);
}

vec3 normal(vec3 p) {
  vec2 e = vec2(1e-3, 0.0);
  return normalize(vec3(map(p + e.xyy) - map(p - e.xyy), map(p + e.yxy) - map(p - e.yxy), map(p + e.yyx) - map(p - e.yyx)));
}

void mainImage(out vec4 color, in vec2 pixel) {
  vec2 uv = (2.0 * pixel - iResolution.xy) / iResolution.y;
  vec3 eye = vec3(4.0 * sin(iTime), 1.0, 4.0 * cos(iTime)), way = normalize(vec3(uv, -2.0));
  float t = 0.0;
  for (int i = 0; i < 90; i++) t += map(eye + t * way);
  color = vec4(0.5 + 0.5 * normal(eye + t * way), 1.0);
}
