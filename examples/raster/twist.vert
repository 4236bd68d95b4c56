// A twisted ring of square section without any buffer: the place of each vertex follows from its number.
//
//   evenmesh mesh --raster twist.vert default --raster-vertices 12288 --bounds=-1.5,-1.5,-0.5,1.5,1.5,0.5 -n 20000 -o twist.ply
uniform mat4 viewProjection;
uniform float turns = 1.25;  // of the section on its way around; a multiple of 1/4 closes the ring

const int around = 512;  // 512 pieces × 4 sides × 2 triangles × 3 corners = 12288 vertices

vec3 place(int piece, int corner) {
  // The last piece ends where the first begins: with the same corner, so that both are the very same point.
  if (piece == around) piece = 0, corner += int(round(4.0 * turns));
  float t = 6.2831853 * float(piece) / float(around), s = turns * t + 1.5707963 * float(corner & 3);
  vec2 section = 0.4 * vec2(cos(s), sin(s));
  float r = 1.0 + section.x;
  return vec3(r * cos(t), r * sin(t), section.y);
}

void main() {
  const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
  int quad = gl_VertexID / 6;
  ivec2 c = corners[gl_VertexID % 6];
  gl_Position = viewProjection * vec4(place(quad / 4 + c.x, quad % 4 + c.y), 1.0);
}
