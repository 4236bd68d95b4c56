// What surrounds a user's function: loops that end, names that pictures use, and the first component of any result.
#line 1000001
int em_rounds = 0;       // of all loops, for one point
uint em_late_line = 0u;  // of the loop that went on after the budget was spent, or 0

// The condition of a loop: false once the budget is spent, so that all loops end.
bool em_tick(bool go_on, uint line) {
  if (++em_rounds > EM_BUDGET) {
    if (em_late_line == 0u) em_late_line = line;
    return false;
  }
  return go_on;
}

float em_first(float f) { return f; }
float em_first(vec2 f) { return f.x; }
float em_first(vec3 f) { return f.x; }
float em_first(vec4 f) { return f.x; }

// There is no picture: no pixels, nothing varies between them.
const vec4 em_FragCoord = vec4(0.5, 0.5, 0.0, 1.0);
vec4 em_FragColor;
vec4 em_FragData[8];
float em_FragDepth;
vec3 em_surface_normal;
float em_derivative(float f) { return 0.0; }
vec2 em_derivative(vec2 f) { return vec2(0.0); }
vec3 em_derivative(vec3 f) { return vec3(0.0); }
vec4 em_derivative(vec4 f) { return vec4(0.0); }
