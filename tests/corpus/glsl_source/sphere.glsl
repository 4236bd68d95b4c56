uniform float k; uniform vec3 c = vec3(1.0);
#ifndef SIZE
#define SIZE 1.0
#endif
float map(vec3 p) { return length(p * c) - SIZE * k; }
