// A user's vertex shader, and what the fragments need of it.
#line 1200001
noperspective out float em_along;  // place along the view, -1 to 1 from the grid's first to its last point
flat out uint em_vertex_late;      // line of a loop that did not end

void main() {
  em_user_main();
  em_along = gl_Position.z / gl_Position.w;
  em_vertex_late = em_late_line;
}
