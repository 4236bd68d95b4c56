// A ball carved into walls along a gyroid. Its value is no distance: only where it changes its sign matters.
uniform float period = 1.3;
uniform float wall = 0.6;

float gyroid(vec3 p) { return dot(sin(p), cos(p.yzx)); }

vec2 map(vec3 p) {  // x: the surface, y: a material, which nobody asks for here
  float carved = abs(gyroid(6.2831853 / period * p)) - wall;
  float ball = 4.0 * (length(p) - 1.0);
  return carved > ball ? vec2(carved, 1.0) : vec2(ball, 2.0);
}
