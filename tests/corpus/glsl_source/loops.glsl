#define EVER for (;;)
#define REPEAT(n) for (int i = 0; i < n; ++i)
float f(inout vec3 p) { do { p.x += 1.0; } while (p.x < 9.0); while (bool b = p.y < 1.0) p.y++; return p.x; }
float map(vec3 p) { EVER { break; } REPEAT(3) f(p); for (int i = 0, j = 3; i < j; i++) p *= 2.0; return p.x; }
