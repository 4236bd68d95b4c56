/// evenmesh render: a picture of a mesh.

#include "evenmesh/render.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "input.h"
#include "interrupt.h"
#include "output.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

struct RenderArguments {
  std::string mesh, other, output;
  std::string width = "1200";
  std::string height = "900";
  std::string view = "30,20";
  std::string up = "y";
  std::string wireframe = "on";
  std::string antialias = "3";
  std::string threads = "0";
  bool quality = false;
};

RenderOptions render_options(const RenderArguments& a) {
  RenderOptions options;
  options.width = static_cast<int>(whole_number("--width", a.width, 16, 8192));
  options.height = static_cast<int>(whole_number("--height", a.height, 16, 8192));
  options.antialias = static_cast<int>(whole_number("--antialias", a.antialias, 1, 8));
  const std::vector<double> view = real_numbers("--view", a.view, 2);
  options.azimuth = real_number("--view AZIMUTH", fmt::format("{}", view[0]), -360, 360);
  options.elevation = real_number("--view ELEVATION", fmt::format("{}", view[1]), -90, 90);
  options.up = choice("--up", a.up, {"y", "z"}) == 0 ? 'y' : 'z';
  options.wireframe = choice("--wireframe", a.wireframe, {"on", "off"}) == 0;
  options.quality_colours = a.quality;
  return options;
}

int run_render(const RenderArguments& a) {
  const RenderOptions options = render_options(a);
  if (a.output.empty()) throw InvalidInput("no output; give -o FILE.png, or -o - for standard output");
  check_output("-o", a.output);
  ExecutionContext context(static_cast<unsigned>(whole_number("-j", a.threads, 0, 1024)));
  const CancelOnInterrupt interrupt(context);
  std::vector<Image> images;
  images.push_back(render_mesh(read_mesh_file("render", a.mesh, context), options, context));
  if (!a.other.empty()) images.push_back(render_mesh(read_mesh_file("render", a.other, context), options, context));
  const std::string png = encode_png(images.size() == 1 ? images[0] : beside(images));
  const WritingGuard guard;
  write_output(a.output, png);
  return Status::done;
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "a picture of a mesh, without a display");
  const auto option = [&](const char* name, std::string& text, const char* type, const char* description) {
    return command->add_option(name, text, description)->type_name(type);
  };
  option("MESH", a->mesh, "", "mesh file, or - for standard input")->required();
  option("-o,--output", a->output, "PNG", "picture to write, - for standard output");
  option("--compare", a->other, "OTHER", "a second mesh, shown beside the first from the same direction");
  command->add_flag(
      "--quality", a->quality,
      "colour triangles by Q: red (0.5 and less) over yellow to green (1);\ndefault: grey, irregular vertices marked");
  option("--width", a->width, "PIXELS", "of each picture, 16 to 8192; default 1200");
  option("--height", a->height, "PIXELS", "16 to 8192; default 900");
  option("--view", a->view, "AZ,EL",
         "direction of the camera in degrees, azimuth -360 to 360,\nelevation -90 to 90; default 30,20");
  option("--up", a->up, "AXIS", "axis that points up: y|z; default y");
  option("--wireframe", a->wireframe, "WHEN", "draw the edges: on|off; default on");
  option("--antialias", a->antialias, "N", "samples along each side of a pixel, 1 to 8; default 3");
  option("-j,--threads", a->threads, "N", "number of threads, 0 to 1024; default 0 = one per processor");
  command->callback([a, &action] { action = [a] { return run_render(*a); }; });
}

}  // namespace evenmesh::cli
