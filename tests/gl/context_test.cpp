/// A context works from any thread, and gives up what does not come back.

#include "gl/context.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/glsl.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_files.h"

namespace evenmesh::gl {
namespace {

TEST(Context, IsThereAndHasAName) {
  const std::string renderer = gl_renderer();
  EXPECT_NE(renderer.find("OpenGL 4."), std::string::npos) << renderer;
  EXPECT_EQ(shared_context(""), shared_context(""));
  EXPECT_GE(shared_context("")->largest_block(), std::size_t{1} << 24);
  EXPECT_NO_THROW(Context("0"));
  EXPECT_NO_THROW(Context("software"));
  EXPECT_THROW(Context("no such device"), InvalidInput);
  EXPECT_THROW(Context("99"), InvalidInput);
}

TEST(Context, RunsJobsOfManyThreadsAndPassesErrorsOn) {
  const std::shared_ptr<Context> context = shared_context("");
  int sum = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 100; ++i) context->run([&] { ++sum; });
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(sum, 800);
  EXPECT_THROW(context->run([] { throw std::runtime_error("mine"); }), std::runtime_error);
  bool nested = false;
  context->run([&] { context->run([&] { nested = true; }); });
  EXPECT_TRUE(nested);
}

TEST(Context, GivesUpWhatDoesNotComeBack) {
  const auto context = std::make_shared<Context>("", 2);  // enough for everything else on busy machines, too
  const auto asleep = [] { std::this_thread::sleep_for(std::chrono::seconds(5)); };
  bool touched = false;
  std::vector<std::thread> threads;
  std::array<std::string, 3> said;
  for (std::string& words : said) {
    threads.emplace_back([&] {
      try {
        context->run([&] {
          context->step("the shader", asleep);
          touched = true;
        });
      } catch (const UnusableInput& error) {
        words = error.what();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& words : said)
    EXPECT_NE(words.find("did not come back within 2 s"), std::string::npos) << words;
  EXPECT_TRUE(context->lost());
  EXPECT_TRUE(stuck());
  EXPECT_THROW(context->run([] {}), UnusableInput);
  std::this_thread::sleep_for(std::chrono::milliseconds(4500));
  EXPECT_FALSE(touched);
  EXPECT_FALSE(shared_context("")->lost());
}

TEST(Buffer, KeepsWhatIsWritten) {
  const std::shared_ptr<Context> context = shared_context("");
  context->run([&] {
    Buffer<float> buffer(context, 100);
    buffer.fill_with_zeros();
    const std::vector<float> in{1, 2, 3};
    buffer.upload(in, 97);
    std::vector<float> out(4);
    buffer.download(out, 96);
    EXPECT_EQ(out, (std::vector<float>{0, 1, 2, 3}));
    EXPECT_THROW(buffer.upload(in, 98), UnusableInput);
    EXPECT_THROW(Buffer<float>(context, context->largest_block()), UnusableInput);
  });
}

TEST(Program, TakesConstantsUniformsAndIncludes) {
  const std::shared_ptr<Context> context = shared_context("");
  const std::string text = assemble_shader(
      "layout(local_size_x = GROUP) in;\nlayout(std430, binding = 0) buffer B { float b[]; };\nuniform float k;\n"
      "uniform vec3 v;\nuniform int n;\nvoid main() { b[gl_GlobalInvocationID.x] = k + v.y + float(n) + OFFSET; }\n",
      {{"GROUP", 8u}, {"OFFSET", 0.5f}});
  context->run([&] {
    const Program program = Program::compute(context, text, "sum");
    Buffer<float> buffer(context, 16);
    buffer.bind(0);
    program.set("k", 1.0f), program.set("v", std::array<float, 3>{0, 2, 0}), program.set("n", 3),
        program.set("none", 1.0f);
    program.dispatch("the sum", 2);
    std::vector<float> out(16);
    buffer.download(out);
    EXPECT_EQ(out, std::vector<float>(16, 6.5f));
    EXPECT_THROW(Program::compute(context, assemble_shader("void main() { x = 1; }"), "bad"), ShaderError);
    EXPECT_NO_THROW(Program::drawing(context, assemble_shader("void main() { gl_Position = vec4(0); }"),
                                     assemble_shader("out vec4 c; void main() { c = vec4(1); }"), "picture"));
  });
  EXPECT_THROW(assemble_shader("#include \"nothing.glsl\"\n"), UnusableInput);
  EXPECT_GE(shader_files().size(), 2u);
}

}  // namespace
}  // namespace evenmesh::gl
