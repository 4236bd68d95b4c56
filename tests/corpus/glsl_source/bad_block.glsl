layout(std140) uniform B { float k; };
uniform float a[3];
float map(vec3 p, float k) { return p.x; }
#define X(