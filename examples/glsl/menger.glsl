// A Menger sponge of `level` levels with side 2: a cube, less three square tunnels for every cube of every level.
uniform int level = 1;

float box(vec3 p, vec3 halfSize) {
  vec3 d = abs(p) - halfSize;
  return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0);
}

// Three square bars of infinite length through the origin, half as wide as `halfWidth` says.
float tunnels(vec3 p, float halfWidth) {
  vec3 a = abs(p);
  return min(max(a.x, a.y), min(max(a.y, a.z), max(a.z, a.x))) - halfWidth;
}

float map(vec3 p) {
  float d = box(p, vec3(1.0));
  float size = 2.0;
  for (int i = 0; i < level; ++i) {
    vec3 q = mod(p + 1.0, size) - 0.5 * size;  // repeated in cubes of this level
    d = max(d, -tunnels(q, size / 6.0));
    size /= 3.0;
  }
  return d;
}
