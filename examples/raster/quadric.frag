// Quadrics hit by rays: only boxes are drawn, and the surface is found within their faces. Front faces look for where a
// ray enters the solid, back faces for where it leaves; a ray along an axis does so once in each half of the box.
//
//   evenmesh mesh --raster quadric.vert quadric.frag --raster-vertices 72 --bounds=-1,-1,-1,1,1,1 -o ellipsoid.ply
//   evenmesh mesh --raster quadric.vert quadric.frag --raster-vertices 72 --bounds=-1,-1,-1,1,1,1 -D form=6,6,-4 -o hyperboloid.ply
flat in vec3 low, high;
out vec3 surface_normal;
uniform mat4 viewProjection, inverseViewProjection;
uniform vec3 viewDirection;
uniform vec2 viewportSize;
uniform vec3 form = vec3(1.2, 2.0, 4.0);  // the solid form.x x² + form.y y² + form.z z² < 1 within the boxes

void main() {
  // The ray through the pixel, the same for front and back faces.
  vec3 d = viewDirection, o = (inverseViewProjection * vec4(2.0 * gl_FragCoord.xy / viewportSize - 1.0, 0.0, 1.0)).xyz;
  // Within the box: from this t to that.
  vec3 a = (low - o) / d, b = (high - o) / d, first = min(a, b), last = max(a, b);
  if (d.x == 0.0) first.x = -1e9, last.x = 1e9;
  if (d.y == 0.0) first.y = -1e9, last.y = 1e9;
  if (d.z == 0.0) first.z = -1e9, last.z = 1e9;
  float near = max(first.x, max(first.y, first.z)), far = min(last.x, min(last.y, last.z));
  float box = gl_FrontFacing ? near : far;
  // Within the quadric: A t² + 2 B t + C < 0.
  float A = dot(form * d, d), B = dot(form * o, d), C = dot(form * o, o) - 1.0, h = B * B - A * C;
  if (A > 0.0) {
    if (h < 0.0) discard;
    near = max(near, (-B - sqrt(h)) / A), far = min(far, (-B + sqrt(h)) / A);
  } else if (h > 0.0) {  // all but what is between the roots
    float r1 = (-B + sqrt(h)) / A, r2 = (-B - sqrt(h)) / A;
    if (near + far < r1 + r2) far = min(far, r1); else near = max(near, r2);
  }
  if (near >= far) discard;
  float t = gl_FrontFacing ? near : far;
  vec3 p = o + t * d;
  surface_normal = t != box ? form * p : gl_FrontFacing ? -d : d;
  gl_FragDepth = (viewProjection * vec4(p, 1.0)).z * 0.5 + 0.5;
}
