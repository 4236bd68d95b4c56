// A ball whose surface is displaced along its normals: a height map, computed here.
//
//   evenmesh gallery sphere -n 20000 -o ball.ply
//   evenmesh mesh --raster dimples.vert default ball.ply --bounds=-1.4,-1.4,-1.4,1.4,1.4,1.4 -n 30000 -o dimples.ply
in vec3 position;
uniform mat4 viewProjection;
uniform float height = 0.15;    // -D height=0.25
uniform float frequency = 5.0;  // bumps per radian

float bumps(vec3 n) {
  vec3 w = sin(frequency * n);
  return w.x * w.y + w.y * w.z + w.z * w.x;
}

void main() {
  vec3 n = normalize(position);
  gl_Position = viewProjection * vec4(n * (1.0 + height * bumps(n)), 1.0);
}
