// A user's vertex shader, and what the fragments need of it.
#line 1200001
// Depth and what divides it. Not their quotient with noperspective: Mesa's clipper loses precision there, where an edge
// runs almost along y.
out vec2 em_clip;
flat out uint em_vertex_late;  // line of a loop that did not end

void main() {
  em_user_main();
  em_clip = gl_Position.zw;
  em_vertex_late = em_late_line;
}
