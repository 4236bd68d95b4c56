// A waving sheet with a rim, made of squares without any buffer: it bounds no solid, and is meshed as the open surface it is.
//
//   evenmesh mesh --raster sheet.vert default --raster-vertices 60000 --bounds=-1.2,-1.2,-0.5,1.2,1.2,0.5 -n 4000 -o sheet.ply
uniform mat4 viewProjection;
uniform float height = 0.2;

const int across = 100;  // 100 × 100 squares × 2 triangles × 3 corners = 60000 vertices

void main() {
  const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
  int square = gl_VertexID / 6;
  ivec2 corner = ivec2(square % across, square / across) + corners[gl_VertexID % 6];
  vec2 at = 2.0 * vec2(corner) / float(across) - 1.0;
  gl_Position = viewProjection * vec4(at, height * sin(3.0 * at.x) * cos(4.0 * at.y), 1.0);
}
