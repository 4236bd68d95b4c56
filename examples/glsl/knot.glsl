// A torus knot: a tube of round section along a (2, 3) curve. Sweeping the section by an angle gives the strands.
uniform float radius = 0.22;
uniform float p_turns = 2.0;
uniform float q_turns = 3.0;

float map(vec3 p) {
  float angle = atan(p.z, p.x), d = 1e9;
  vec2 section = vec2(length(p.xz) - 1.0, p.y);
  for (int strand = 0; strand < int(p_turns); ++strand) {
    float a = q_turns / p_turns * (angle + 6.2831853 * float(strand));
    d = min(d, length(section - 0.42 * vec2(cos(a), sin(a))) - radius);
  }
  return 0.6 * d;
}
