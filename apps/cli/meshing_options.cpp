#include "evenmesh/names.h"
#include "meshing.h"

namespace evenmesh::cli {
namespace {

void add_what(CLI::App& app, MeshingArguments& a) {
  const std::string group = "What comes out";
  const auto option = [&](const char* name, std::string& text, const char* type, const std::string& description) {
    app.add_option(name, text, description)->type_name(type)->group(group);
  };
  option("-o,--output", a.output, "FILE", "mesh to write: .ply .obj .stl .off .glb .3mf, or - for standard output");
  option("--format", a.format, "FORMAT",
         "format of the output, " + joined_names<MeshFormat>("|") + "; default: by extension, ply for -");
  option(
      "-n,--vertices", a.vertices, "N",
      "number of vertices, 4 to 1000000000, met within 0.5 % unless the\ntopology needs more; default: estimated from "
      "area and curvature");
  option("-l,--edge-length", a.edge_length, "L", "mean edge length in model units, above 0; instead of -n");
  option("--error", a.error, "E", "largest deviation as a fraction of the diagonal; not available in this version");
  option("-r,--resolution", a.resolution, "R",
         "samples along the longest side of the bounds, 8 to 8192;\ndefault: 100 samples per vertex or more");
  option(
      "--bounds", a.bounds, "BOX",
      "x0,y0,z0,x1,y1,z1 in model units: where the surface is sought;\na surface cut by it is capped; default: found");
  option("--unit", a.unit, "UNIT",
         "unit of all lengths, in the output and in options: micron|mm|cm|m|in|ft. Inputs\nin another one (3MF, GLB, "
         "scenes) are converted, others taken to be in it;\ndefault: that of the input");
  option("--topology", a.topology, "RULE",
         "keep: add vertices where the topology needs them; simplify: keep the number of\nvertices and fill small "
         "tunnels and gaps of the solid instead; default keep");
  app.add_option("--regularize", a.regularize,
                 "first close and open the solid by balls of radius R, model units: what is\nnarrower than 2 R is "
                 "filled or cut off; default: not")
      ->type_name("global R")
      ->expected(2)
      ->allow_extra_args(false)
      ->group(group);
  option("--features", a.features, "ANGLE",
         "sharp edges: where the surface turns by more than ANGLE degrees, 0 to 180,\nthe mesh has an edge: auto = 40, "
         "or off; solids only; default auto");
  option("--density", a.density, "uniform",
         "vertices per area: uniform, or EXPR in x, y, z, compared with elsewhere\n(curvature, FILE: not available)");
}

void add_effort(CLI::App& app, MeshingArguments& a) {
  const std::string group = "Optimization";
  const auto option = [&](const char* name, std::string& text, const char* type, const std::string& description) {
    app.add_option(name, text, description)->type_name(type)->group(group);
  };
  option("--quality", a.quality, "EFFORT",
         joined_names<Quality>("|") + " (high anneals: more regular, several times slower);\ndefault normal");
  option("--evenness", a.evenness, "E",
         "where triangles cannot have both: equal angles (0) or equal sizes (1);\ndefault 0.5");
  option("--method", a.method, "METHOD",
         "sampling: " + joined_names<Method>("|") +
             "; auto takes the shell for points and for\nopen or broken sheets; default auto");
  option("--optimizer", a.optimizer, "NAME", joined_names<Optimizer>("|") + "; default lbfgs");
  option("--iterations", a.iterations, "N",
         "evaluations of the energy per level at most, 0 to 10000;\ndefault: by --quality");
  option("--tolerance", a.tolerance, "T",
         "stop when the mean vertex moves less than this share of an edge,\nabove 0, below 1; default 0.0001");
  option("--start", a.start, "NAME", joined_names<Start>("|") + "; default coarse-to-fine");
  option("--seed", a.seed, "S", "of the random numbers, 0 to 18446744073709551615; default 1");
  option("--placement", a.placement, "NAME", "of the vertices: " + joined_names<Placement>("|") + "; default quadric");
  option(
      "--connect", a.connect, "NAME",
      "cells to triangles: complex (by the nearest vertex), flood (by the first\nalong the surface), fragments (from "
      "unordered samples); default complex");
  option("--thickness", a.thickness, "D",
         "half width of the shell in voxels, 1 to 20: gaps narrower than twice\nthat are bridged; default 2, for "
         "points by their spacing");
  option("--outliers", a.outliers, "S",
         "leave out points whose mean distance to their neighbours is more than S\nstandard deviations above the mean, "
         "0 to "
         "100, e.g. 3; default: none");
  option("--max-cycle", a.max_cycle, "N",
         "--connect fragments: the longest gap in edges that triangles fill, 3 to 8; default 5");
}

void add_how(CLI::App& app, MeshingArguments& a) {
  const std::string group = "How it runs (the mesh does not depend on it)";
  const auto option = [&](const char* name, std::string& text, const char* type, const std::string& description) {
    app.add_option(name, text, description)->type_name(type)->group(group);
  };
  option("-j,--threads", a.threads, "N", "number of threads, 0 to 1024; default 0 = one per processor");
  option("--backend", a.backend, "NAME", "what evaluates expressions: cpu|gl (OpenGL, see --gl-device); default cpu");
  option("--report", a.report, "FILE", "write pictures and figures of the run as one HTML page");
  option("--json", a.json, "FILE", "write the figures of the run as JSON, - for standard output");
  option("--dump-dexels", a.dump_dexels, "FILE", "write the sampled solid as dexels (.tdx), an input again");
  option("--dump-shell", a.dump_shell, "FILE",
         "write the shell (.vdb): distance of its voxels from the surface, model units");
  option("--progress", a.progress, "WHEN", "progress bar: auto|on|off; default auto = on a terminal");
  app.add_flag("-q,--quiet", a.quiet, "say nothing but errors and broken promises")->group(group);
  app.add_flag("-v,--verbose", a.verbose, "also say what each stage does")->group(group);
}

}  // namespace

void add_input_options(CLI::App& app, MeshingArguments& a, const std::string& what) {
  const std::string group = "What goes in";
  app.add_option("INPUT", a.input.positional, what)->type_name("");
  app.add_option("-e,--expression", a.input.expressions,
                 "solid where an expression in x, y, z is below 0, instead of INPUT")
      ->type_name("EXPR")
      ->allow_extra_args(false)
      ->group(group);
  app.add_option(
         "-D,--define", a.definitions,
         "value of a parameter of the expression, or of a uniform or macro of the\nshader, e.g. -D a=0.5 -D size=1,2,1")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group(group);
  const auto option = [&](const char* name, std::string& text, const char* type, const std::string& description) {
    app.add_option(name, text, description)->type_name(type)->group(group);
  };
  option("--entry", a.entry, "NAME", "shader: the function of a vec3 that is negative inside; default map");
  option(
      "--lipschitz", a.lipschitz, "L",
      "shader: values differ by L times the distance of their points at most,\n1 for a true distance: empty space is "
      "skipped; default: not known");
  option("--level", a.level, "V", "shader: the surface is where the function has this value; default 0");
  option("--gl-device", a.gl_device, "NAME",
         "renderer that runs shaders, and expressions with --backend gl: 0, 1, …, software, or part of a "
         "name;\ndefault: the best there is");
}

void add_raster_options(CLI::App& app, MeshingArguments& a) {
  const std::string group = "What goes in";
  app.add_option("--raster", a.input.raster,
                 "the solid that a vertex and a fragment shader draw, files or 'default': with the\nmesh INPUT as "
                 "their triangles, or without one")
      ->type_name("VERT FRAG")
      ->expected(2)
      ->allow_extra_args(false)
      ->group(group);
  app.add_option("--raster-vertices", a.raster_vertices,
                 "--raster without INPUT: how many vertices are drawn, three for each triangle;\nneeds --bounds")
      ->type_name("N")
      ->group(group);
}

void add_meshing_options(CLI::App& app, MeshingArguments& a) {
  add_what(app, a);
  add_effort(app, a);
  add_how(app, a);
}

}  // namespace evenmesh::cli
