// A triangle mesh again, by plain rasterization. This is the built-in fragment shader, so 'default' does the same.
//
//   evenmesh mesh --raster default plain.frag model.obj -n 20000 -o even.ply
void main() {}
