#version 300 es
#extension GL_OES_standard_derivatives : enable
precision highp float;
layout(location = 0) out vec4 color; in vec2 uv; uniform sampler2D tex;
struct Hit { float d; int id; };
vec2 map(in vec3 p) {
#ifdef HQ
  if (p.x > 0.0) {
#else
  if (p.x < 0.0) {
#endif
    p.x += iTime; }
  return vec2(length(p) - 1.0, \
    1.0); }
/* picture */ void mainImage(out vec4 c, vec2 at) { c = texture(iChannel0, at) + gl_FragCoord.x + dFdx(at.x); }
void main() { mainImage(color, uv); } // end
