// Seven drops that flow into each other: a smooth union of balls on a path.
uniform float blend = 0.25;
uniform float time = 0.8;

float smoothUnion(float a, float b) {
  float h = clamp(0.5 + 0.5 * (b - a) / blend, 0.0, 1.0);
  return mix(b, a, h) - blend * h * (1.0 - h);
}

float map(vec3 p) {
  float d = 1e9;
  for (int i = 0; i < 7; ++i) {
    float t = time + 2.399963 * float(i);
    vec3 center = vec3(cos(t), 0.7 * sin(1.3 * t), sin(t)) * (0.25 + 0.08 * float(i));
    d = smoothUnion(d, length(p - center) - (0.42 - 0.02 * float(i)));
  }
  return d;
}
