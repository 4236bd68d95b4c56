// A pseudo-Kleinian limit set: box folds and sphere inversions of a flat sheet, within a ball.
const vec3 foldSize = vec3(0.92, 0.92, 0.72);
const float thickness = 0.012;

float foldedSheet(vec3 p) {
  float scale = 1.0;
  for (int i = 0; i < 6; i++) {
    p = 2.0 * clamp(p, -foldSize, foldSize) - p;
    float k = max(0.9 / dot(p, p), 1.0);
    p *= k;
    scale *= k;
  }
  return 0.5 * abs(p.z) / scale;
}

float map(vec3 p) { return max(foldedSheet(p) - thickness, length(p) - 1.2); }
