/// Shaders as people write them, and what is said of those that cannot be used.

#include <chrono>

#include "gl/shaders.h"

namespace evenmesh {
namespace {

using namespace testing;

const char* const shadertoy = R"(#version 300 es
#extension GL_OES_standard_derivatives : enable
precision highp float;
// A scene as on Shadertoy.
#define ROUNDS 4
#define R(a) mat2(cos(a), sin(a), -sin(a), cos(a))
#ifndef SIZE
#define SIZE 0.5
#endif
uniform sampler2D noiseTexture;
in vec2 vUv;
out vec4 fragColor;
struct Hit { float d; int id; };
const float EPS = 1e-3;
float hash(vec3 p) { return fract(sin(dot(p, vec3(1.0, 57.0, 113.0))) * 43758.5453); }
void rotate(inout vec3 p, float a) { p.xz *= R(a); }
float box(in vec3 p, const in vec3 b) { vec3 d = abs(p) - b; return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0); }
vec2 map(in vec3 p) {
    rotate(p, iTime * 0.5 + float(iFrame) + iMouse.x + iDate.w);
    float d = box(p, vec3(SIZE));
    for (int i = 0; i < ROUNDS; i++) {
        if (i == 3) continue;
        d = min(d, length(p - vec3(float(i) * 0.1, 0.9, 0.0)) - 0.1);
    }
    int k = 0;
    do { d -= 0.0; k++; } while (k < 3);
    while (k > 0) k--;
    return vec2(d, 1.0);
}
vec3 normal(vec3 p) { return normalize(vec3(map(p + vec3(EPS, 0, 0)).x - map(p).x, dFdx(p.y), 0.0)); }
float march(vec3 o, vec3 d) { float t = 0.0; for (int i = 0; i < 100; i++) t += map(o + t * d).x; return t; }
void mainImage(out vec4 color, in vec2 at) {
    vec2 uv = at / iResolution.xy + texture(iChannel0, at).xy + vUv + texture(noiseTexture, vUv).xy;
    if (uv.x > 2.0) discard;
    color = vec4(normal(vec3(uv, march(vec3(0), vec3(1)))), gl_FragCoord.x + hash(vec3(uv, 1)));
}
void main() { mainImage(fragColor, gl_FragCoord.xy); }
)";

TEST(GlslHabits, ReadsShadertoysFiles) {
  EXPECT_NEAR(value_at(shadertoy, {1, 0, 0}), 0.5f, 1e-5);
  EXPECT_NEAR(value_at(shadertoy, {1, 0, 0}, {{"SIZE", "0.25"}}), 0.75f, 1e-5);
  EXPECT_NEAR(value_at(shadertoy, {1, 0, 0}, {{"iTime", "3.14159265"}}), 0.5f, 1e-5);
  EXPECT_NE(value_at(shadertoy, {1, 0, 0}, {{"iTime", "1"}}), value_at(shadertoy, {1, 0, 0}));
}

TEST(GlslHabits, KnowsTheNamesThatHostsSet) {
  EXPECT_EQ(value_at("uniform float iTime; uniform vec2 u_resolution; uniform float u_time;\n"
                     "float map(vec3 p) { return p.x + iTime + u_time + u_resolution.y; }",
                     {1, 0, 0}),
            1025);
  EXPECT_EQ(
      value_at("#define T iTime\nfloat map(vec3 p) { return p.x + T + iResolution.z + iChannelTime[1]; }", {1, 0, 0}),
      2);
}

TEST(GlslHabits, TakesAnyEntry) {
  EXPECT_EQ(value_at("vec4 DE(const in vec3 p) { return vec4(p.y, 9, 9, 9); }", {1, 2, 3}, {}, "DE"), 2);
  EXPECT_EQ(value_at("vec3 f(vec3 p) { return p.zyx; }", {1, 2, 3}, {}, "f"), 3);
  EXPECT_EQ(value_at("float sdf(vec3 p) { return p.z; }\n#define map(q) sdf(q)\n", {1, 2, 3}), 3);
  EXPECT_EQ(value_at("float map(vec3 p); float g(vec3 p) { return map(p); } float map(vec3 p) { return p.x; }",
                     {5, 2, 3}, {}, "g"),
            5);
  EXPECT_EQ(
      value_at("float map(vec3 p, out int id) { id = 1; return p.x; }\nfloat map(vec3 p) { int i; return map(p, i) + "
               "float(i); }",
               {5, 2, 3}),
      6);
  EXPECT_EQ(value_at("float sample(vec3 p) { float buffer = p.x; float shared = buffer; return shared; }", {5, 2, 3},
                     {}, "sample"),
            5);
}

TEST(GlslHabits, KeepsConditionalPartsTogether) {
  const std::string text =
      "#if defined(A)\nfloat map(vec3 p) {\n  if (p.x > 0.0) {\n#else\nfloat map(vec3 p) {\n  if (p.x < 0.0) "
      "{\n#endif\n"
      "    return 1.0;\n  }\n  return 2.0;\n}\nvoid mainImage(out vec4 c, vec2 p) { c = texture(iChannel0, p); }\n";
  EXPECT_EQ(value_at(text, {1, 0, 0}), 2);
  EXPECT_EQ(value_at(text, {1, 0, 0}, {{"A", ""}}), 1);
  EXPECT_EQ(
      value_at(
          "float map(vec3 p) {\n  float s = 0.0;\n#ifdef B\n  for (int i = 0; i < 3; i++) {\n#else\n  for (int i = 0; "
          "i < 5; i++) {\n#endif\n    s += 1.0;\n  }\n  return s;\n}",
          {1, 0, 0}),
      5);
}

TEST(GlslUniforms, AreSetByName) {
  const std::string text =
      "uniform float k = 2.0, l;\nlayout(location = 3) uniform vec3 c;\nuniform bool on;\nuniform ivec2 n;\n"
      "uniform highp mat2 m = mat2(1.0);\nuniform float unused;\n"
      "float map(vec3 p) { return k + l + c.y + (on ? 100.0 : 0.0) + float(n.y) + (m * vec2(1.0, 2.0)).x; }";
  const Values values{{"l", "0.5"}, {"c", "1, 2.5,3"}, {"on", "true"}, {"n", "3,4"}};
  EXPECT_EQ(value_at(text, {}, values), 2 + 0.5f + 2.5f + 100 + 4 + 1);
  Values more = values;
  more["k"] = "-1e1", more["m"] = "0,0,3,0", more["c"] = "7";
  EXPECT_EQ(value_at(text, {}, more), -10 + 0.5f + 7 + 100 + 4 + 6);
}

TEST(GlslUniforms, AreRefusedWhereTheyDoNotFit) {
  const std::string text =
      "uniform float k; uniform vec3 color = vec3(1);\n#define STEPS 4\n"
      "float map(vec3 p) { return k * color.x; }";
  EXPECT_TRUE(holds(refusal<InvalidInput>(text), "float k"));
  EXPECT_TRUE(holds(refusal<InvalidInput>(text, {{"k", "one"}}), "takes a number, not 'one'"));
  EXPECT_TRUE(holds(refusal<InvalidInput>(text, {{"k", "1"}, {"color", "1,2"}}), "3 numbers"));
  EXPECT_TRUE(holds(refusal<InvalidInput>(text, {{"k", "nan"}}), "takes a number"));
  const std::string unknown = refusal<InvalidInput>(text, {{"k", "1"}, {"colour", "1"}});
  EXPECT_TRUE(holds(unknown, "did you mean color?"));
  EXPECT_TRUE(holds(unknown, "float k, vec3 color, macro STEPS"));
  EXPECT_TRUE(holds(refusal<InvalidInput>(text, {{"k", "1"}, {"STEPS", "4\n#error"}}), "STEPS takes"));
  EXPECT_TRUE(holds(refusal<InvalidInput>(sphere, {{"k", "1"}}), "it has none at all"));
  EXPECT_TRUE(
      holds(refusal<UnusableInput>("uniform float a[3]; float map(vec3 p) { return a[1]; }"), "test.glsl:1:15"));
  EXPECT_TRUE(holds(refusal<UnusableInput>("uniform B { float a; }; float map(vec3 p) { return a; }"), "one by one"));
}

TEST(GlslEntry, IsFoundOrSuggested) {
  EXPECT_TRUE(holds(refusal<InvalidInput>("float DE(vec3 p) { return 1.0; }"),
                    "there is no function map(vec3); did you mean --entry DE?"));
  EXPECT_TRUE(holds(refusal<InvalidInput>("float blob(vec3 p) { return 1.0; }"), "blob"));
  EXPECT_TRUE(holds(refusal<InvalidInput>("int x;"), "no other function of one vec3"));
  EXPECT_TRUE(holds(refusal<InvalidInput>("float map(vec3 p, float t) { return t; }"), "map(vec3, float) is no entry"));
  EXPECT_TRUE(holds(refusal<InvalidInput>("float map(inout vec3 p) { return 1.0; }"), "map(inout vec3)"));
  EXPECT_TRUE(holds(refusal<InvalidInput>("struct H { float d; };\nH map(vec3 p) { return H(1.0); }"), "gives H"));
}

TEST(GlslErrors, NameTheLineAndTheColumn) {
  const std::string text =
      "#define TWICE(a) ((a) * 2.0)\n/* a\n comment */ float map(vec3 p) {\n  float k   =  1.0; /* x */ float q = "
      "TWICE(p.x) + "
      "undefined_thing;\n  return q;\n}\n";
  const std::string said = refusal<UnusableInput>(text);
  EXPECT_TRUE(holds(said, "test.glsl:4:52: ")) << said;
  EXPECT_TRUE(holds(said, "undefined_thing"));
  EXPECT_TRUE(holds(said, "^"));
  EXPECT_TRUE(holds(refusal<UnusableInput>("float map(vec3 p) {\n  return 1.0 +;\n}"), "test.glsl:2:15: "));
  EXPECT_TRUE(holds(refusal<UnusableInput>("float map(vec3 p) {\r\n\r\n  return foo(p);\r\n}"), "test.glsl:3:"));
  EXPECT_TRUE(
      holds(refusal<UnusableInput>("#include \"a.glsl\"\n" + sphere), "test.glsl:1:1: nothing can be included"));
  EXPECT_TRUE(
      holds(refusal<UnusableInput>("float map(vec3 p) {\n return texture(iChannel0, p.xy).x; }"), "test.glsl:2:17: "));
  EXPECT_NE(refusal<UnusableInput>("#error no\n" + sphere), "");
  EXPECT_NE(refusal<UnusableInput>("float map(vec3 p) { return 1.0; "), "");
}

TEST(GlslErrors, OfOtherDriversAreUnderstood) {
  const gl::GlslSource source = gl::prepare_glsl({"float map(vec3 p) {\n  return q;\n}", "a.glsl"}, "map", {});
  const std::size_t line =
      1 + std::distance(source.offsets.begin(), std::find(source.offsets.begin(), source.offsets.end(), 29u));
  const std::string at = std::to_string(line);
  EXPECT_TRUE(holds(source.explain("0(" + at + ") : error C1503: undefined variable \"q\"\n"),
                    "a.glsl:2:10: undefined variable"));
  EXPECT_TRUE(holds(source.explain("ERROR: 0:" + at + ": 'q' : undeclared identifier\n"), "a.glsl:2:10: 'q' : undecl"));
  EXPECT_TRUE(holds(source.explain("0:" + at + "(1): error: `q' undeclared\n"), "a.glsl:2:10: `q' undeclared"));
  EXPECT_TRUE(holds(source.explain("something else"), "something else"));
}

TEST(GlslLoops, EndOrAreAnError) {
  const std::vector<std::string> endless{
      "float map(vec3 p) {\n for (;;) { p.x += 1.0; }\n return p.x; }",
      "float map(vec3 p) {\n while (true) p.x += 1.0;\n return p.x; }",
      "float map(vec3 p) {\n do { p.x += 1.0; }\n while (p.x == p.x); return p.x; }",
      "#define EVER for(;;)\nfloat map(vec3 p) { EVER { p.x += 1.0; if (p.x < -1e30) break; } return p.x; }",
      "#define LOOP(c) while (c)\nfloat map(vec3 p) { LOOP(p.y < 1e30) { p.x += 1.0; } return p.x; }",
      "float map(vec3 p) {\n for (int i = 0; i < 10; i += 0) p.x += 1.0;\n return p.x; }",
      "float map(vec3 p) {\n while (bool go = p.x < 1e30) p.y += 1.0;\n return p.x; }",
      "float f(float x) {\n for (int i = 0; i < 1000; ++i) for (int k = 0; k < 1000; ++k) x += sin(x);\n return x; }\n"
      "float map(vec3 p) { return f(p.x); }",
  };
  for (const std::string& text : endless) {
    const auto start = std::chrono::steady_clock::now();
    const std::string said = refusal<UnusableInput>(text);
    EXPECT_TRUE(holds(said, "65000 rounds")) << text;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 15) << text;
  }
  EXPECT_TRUE(holds(refusal<UnusableInput>(endless[0]), "test.glsl:2:"));
  EXPECT_EQ(value_at("float map(vec3 p) { float s = 0.0; for (int i = 0; i < 60000; i++) s += 1.0; return s; }", {}),
            60000);
  EXPECT_TRUE(holds(
      refusal<UnusableInput>("#define HALF for (int i = 0;\nfloat map(vec3 p) { HALF i < 3; i++) ; return 1.0; }"),
      "write it out"));
}

TEST(GlslLoops, AreFoundLater) {
  const Shape shape = shader("float map(vec3 p) { while (p.x > 100.0) p.y += 1.0; return p.x; }");
  EXPECT_THROW(shape.field()->evaluate(Vec3{200, 0, 0}, nullptr), UnusableInput);
  EXPECT_EQ(shape.field()->evaluate(Vec3{2, 0, 0}, nullptr), 2);
}

TEST(GlslGarbage, IsRefused) {
  EXPECT_TRUE(holds(refusal<UnusableInput>(std::string("\x7f"
                                                       "ELF\0\0\1",
                                                       7)),
                    "not text"));
  EXPECT_TRUE(holds(refusal<UnusableInput>("float map(vec3 p) { return \xe2\x82\xac; }"), "test.glsl:1:28"));
  EXPECT_TRUE(holds(refusal<UnusableInput>("/* open\n" + sphere), "never closed"));
  EXPECT_TRUE(holds(refusal<UnusableInput>(std::string(1'000'001, ' ')), "at most"));
  EXPECT_TRUE(holds(refusal<UnusableInput>("float map(vec3 p) { return " + std::string(5000, '(') + "1.0" +
                                           std::string(5000, ')') + "; }"),
                    "too deep"));
  EXPECT_TRUE(holds(refusal<UnusableInput>(" \n"), "is empty"));
  std::string sum = "p.x";
  for (int i = 0; i < 8000; ++i) sum += " + p.y";
  EXPECT_EQ(value_at("float map(vec3 p) { return " + sum + "; }", {1, 0, 0}), 1);
  // A name in UTF-8 within a comment is fine, and so is a byte order mark.
  EXPECT_EQ(value_at("\xef\xbb\xbf// caf\xc3\xa9\n" + sphere, {2, 0, 0}), 1);
}

TEST(GlslFiles, AreRecognized) {
  EXPECT_TRUE(is_glsl("a/b.glsl", ""));
  EXPECT_TRUE(is_glsl("B.FRAG", ""));
  EXPECT_TRUE(is_glsl("-", "#version 300 es\n"));
  EXPECT_TRUE(is_glsl("x", sphere));
  EXPECT_FALSE(is_glsl("x.obj", "v 0 0 0\n"));
  EXPECT_FALSE(is_glsl("x.csg", "sphere(r = 1);"));
}

}  // namespace
}  // namespace evenmesh
