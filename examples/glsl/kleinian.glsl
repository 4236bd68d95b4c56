// A pseudo-Kleinian shape: box folds and sphere inversions of a flat sheet, within a ball.
uniform vec3 fold = vec3(0.9, 0.9, 0.75);
uniform float thickness = 0.05;
uniform int rounds = 4;

float foldedSheet(vec3 p) {
  float scale = 1.0;
  for (int i = 0; i < rounds; i++) {
    p = 2.0 * clamp(p, -fold, fold) - p;
    float k = max(0.7 / dot(p, p), 1.0);
    p *= k;
    scale *= k;
  }
  return 0.5 * abs(p.z) / scale;
}

float map(vec3 p) { return max(foldedSheet(p) - thickness, length(p) - 1.2); }
