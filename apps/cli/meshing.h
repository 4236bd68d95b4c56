#pragma once
/// The options that all meshing commands share, and the run behind them.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "evenmesh/mesh_shape.h"
#include "input.h"

namespace evenmesh::cli {

/// Texts of the options as given; empty: not given. Each is documented once, in add_meshing_options.
struct MeshingArguments {
  std::vector<std::string> definitions;
  InputArguments input;
  std::string output, format;
  std::string vertices, edge_length, resolution, bounds, iterations, tolerance, seed = "1";
  std::string quality = "normal", optimizer = "lbfgs", start = "coarse-to-fine", placement = "quadric";
  std::string method = "auto", connect = "complex", topology = "keep", features = "auto", density = "uniform";
  std::string backend = "cpu", threads = "0", progress = "auto";
  std::string report, json;
  std::string thickness, outliers, dump_shell;
  std::string error, max_cycle, dump_dexels, entry;  ///< documented, not available yet
  bool quiet = false, verbose = false;
  bool wrap = false;
};

void add_meshing_options(CLI::App& app, MeshingArguments& arguments);

/// Reads the input, meshes it, writes mesh and reports, prints the summary; returns the exit status.
int run_meshing(MeshingArguments arguments);

}  // namespace evenmesh::cli
