#pragma once
/// The options that all meshing commands share, and the run behind them.

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evenmesh/mesh_shape.h"
#include "input.h"
#include "output.h"
#include "terminal.h"

namespace evenmesh::cli {

/// Texts of the options as given; empty: not given. Each is documented once, in add_meshing_options.
struct MeshingArguments {
  std::vector<std::string> definitions;
  InputArguments input;
  std::string output, format;
  std::string vertices, edge_length, resolution, bounds, iterations, tolerance, evenness;
  std::string seed = "1";
  std::string quality = "normal";
  std::string optimizer = "lbfgs";
  std::string start = "coarse-to-fine";
  std::string placement = "quadric";
  std::string method = "auto";
  std::string connect = "complex";
  std::string topology = "keep";
  std::string features = "auto";
  std::string density = "uniform";
  std::string backend = "cpu";
  std::string threads = "0";
  std::string progress = "auto";
  std::string report, json;
  std::string thickness, outliers, dump_shell;
  std::vector<std::string> regularize;  ///< "global", radius
  std::string unit;
  std::string max_cycle;
  std::string dump_dexels;
  std::string entry = "map";
  std::string lipschitz, level, gl_device;
  std::string raster_vertices;
  std::string error;  ///< documented, not available yet
  bool quiet = false, verbose = false;
  bool wrap = false;
};

/// What a command makes of its inputs before they are meshed.
struct Operation {
  InputCount inputs{};
  /// The shape to mesh; none: the only input as it is.
  std::function<Shape(std::vector<Shape>)> combine{};
  /// Changes the shape and the options, once the shape is known.
  std::function<void(Shape&, MeshOptions&, Talk, ExecutionContext&)> prepare{};
  std::map<std::string, std::string> options{};  ///< of the command itself, for --json
};

/// INPUT, -e and -D. @param what  help of INPUT, which may be several files
void add_input_options(CLI::App& app, MeshingArguments& arguments, const std::string& what);
/// --raster, of commands that take one input.
void add_raster_options(CLI::App& app, MeshingArguments& arguments);
void add_meshing_options(CLI::App& app, MeshingArguments& arguments);

/// What the checks of the command line leave to do.
struct Plan {
  MeshOptions options;
  std::optional<double> outliers;    ///< standard deviations
  std::optional<double> regularize;  ///< radius
  std::optional<LengthUnit> unit;
  MeshOutput output;
  unsigned threads = 0;
  bool on_gl = false;  ///< expressions too
  Talk talk = Talk::normal;
};

/// Checks all arguments before anything is read, and fills in `arguments.input`.
/// @throws InvalidInput, NotAvailable
Plan check(MeshingArguments& arguments, const Operation& operation);

/// How many of the outputs go to standard output.
int outputs_to_standard_output(const MeshingArguments& arguments);

/// The figures of a run, with the version and the options given; for --json.
std::string run_json(const MeshResult& result, const MeshingArguments& arguments, const Operation& operation,
                     const Plan& plan);

/// Reads the inputs, makes the shape, meshes it, writes mesh and reports, prints the summary; returns the exit status.
int run_meshing(MeshingArguments arguments, const Operation& operation = {});

}  // namespace evenmesh::cli
