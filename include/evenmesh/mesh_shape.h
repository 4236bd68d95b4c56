#pragma once
/// The main job: any shape in, an even, closed, two-manifold triangle mesh out.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evenmesh/dexels.h"
#include "evenmesh/execution_context.h"
#include "evenmesh/findings.h"
#include "evenmesh/measure.h"
#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"
#include "evenmesh/volume.h"

namespace evenmesh {

/// How the surface is sampled: by rays through a solid, or by a thin shell of voxels around any surface. Automatic: the
/// shell for point clouds and for triangle meshes that have no inside to speak of (solidity() below 0.6).
enum class Method { automatic, raster, shell };
enum class Quality { fast, normal, high };
enum class Optimizer { lbfgs, lloyd };
enum class Start { random, blue_noise, coarse_to_fine };
/// How cells are told apart before they become triangles: by the nearest seed, disconnected pieces becoming cells of
/// their own; or by the seed that reaches them along the surface. Fragments: not at all, triangles come from seeds that
/// are about equally near to a sample.
enum class Connect { complex, flood, fragments };
/// What gives way where the vertices asked for are too few for the topology: their number, or the topology of a solid.
enum class TopologyRule { keep, simplify };
enum class Placement { centroid, constrained, quadric };

/// What the mesh shall be like. Nothing in here depends on the machine.
struct MeshOptions {
  /// How fine; at most one of the two. Neither: estimated from area, curvature and the thinnest part.
  std::optional<std::size_t> vertices{};  ///< vertex count, [4, 1e9]; met within 0.5 % unless the topology needs more
  std::optional<double> edge_length{};    ///< mean edge length in model units, > 0
  std::optional<std::size_t>
      resolution{};  ///< samples along the longest side of the bounds, [8, 8192]; default: α ≥ 100 samples per seed
  Method method = Method::automatic;
  std::optional<unsigned> thickness{};  ///< half width d of the shell in voxels, [1, 20]: holes and gaps narrower than
                                        ///< 2d are bridged; default 2, for point clouds by their spacing
  /// Sharp edges: where the surface turns by more than this, degrees in (0, 180), the mesh gets an edge. None: off.
  std::optional<double> feature_angle{40};
  /// Of solids, keep what the outside reaches: their outer hull. Of these and wraps, fill gaps narrower than 0.9 edges
  /// where they hide more than 5 % of the surface.
  bool fill_cavities = false;
  bool wrap = false;                  ///< a closed mesh one voxel around the surface instead, by the shell
  Density density{};                  ///< none: even. Smooth, and at most a hundred times its mean
  std::optional<Box> bounds{};        ///< replaces the shape's own; a surface cut by it is capped
  Quality quality = Quality::normal;  ///< effort of the optimization
  /// Where triangles cannot have both: shape (0) or equal size (1), [0, 1]. On curved surfaces no mesh has a mean Q of
  /// 0.98 and equal areas (docs/quality.md).
  double evenness = 0.5;
  Optimizer optimizer = Optimizer::lbfgs;
  Start start = Start::coarse_to_fine;
  Connect connect = Connect::complex;
  std::size_t max_cycle = 5;  ///< of Connect::fragments: the longest gap that triangles fill, in edges, [3, 8]
  TopologyRule topology = TopologyRule::keep;
  Placement placement = Placement::quadric;
  std::optional<std::size_t>
      iterations{};         ///< evaluations of the energy per level at most, [0, 10000]; default by quality
  double tolerance = 1e-4;  ///< stop when the mean seed moves less than this share of the seed spacing, (0, 1)
  std::uint64_t seed = 1;   ///< of the random numbers
};

/// What a run did.
struct Report {
  MeshQuality quality;                 ///< of the mesh returned
  std::size_t self_intersections = 0;  ///< pairs of triangles
  std::size_t seeds_asked = 0;         ///< vertex count aimed at
  std::size_t seeds = 0;               ///< vertices returned
  std::size_t samples = 0;
  double alpha = 0;              ///< samples per seed
  std::size_t resolution = 0;    ///< grid cells along the longest side
  double spacing = 0;            ///< grid spacing h, model units
  double energy_ratio = 0;       ///< F·k/A² / (5/(18√3)); 1 = perfect hexagonal tiling
  std::vector<double> energies;  ///< energy ratio after every evaluation, all levels in turn
  std::size_t evaluations = 0;
  std::size_t filled_cavities = 0;     ///< parts of surface within the solid, left out
  std::size_t disagreements = 0;       ///< grid points whose inside differed between ray directions, settled by vote
  std::size_t unresolved = 0;          ///< crossings left out where a grid edge held several: thinner than a cell
  std::size_t dropped_components = 0;  ///< small components: pieces of surface smaller than a cell, left out
  std::size_t sites = 0;               ///< shell: voxels that the surface touches
  std::size_t shell_voxels = 0;        ///< shell: voxels within the thickness
  unsigned thickness = 0;              ///< shell: half its width in voxels
  std::size_t sheets = 0;              ///< shell: connected pieces of surface
  std::size_t cuts = 0;          ///< shell: sheets that had to end where others meet them, and vertices that were split
  std::size_t merges = 0;        ///< shell: gaps between sheets that it fills, hiding surface
  unsigned thickness_apart = 0;  ///< shell: the largest thickness that fills none of them; 0: the voxels are too large
  std::size_t crease_vertices = 0;  ///< vertices fixed on sharp edges
  double crease_length = 0;         ///< of the sharp edges, model units
  std::size_t inserted_seeds = 0;   ///< added because the topology needed them
  std::size_t regularization_rounds = 0;
  std::vector<double> cycle_shares;  ///< Connect::fragments: edges from cycles of 3, 4, … of all, in [0, 1]
  std::vector<std::pair<std::string, double>> seconds;  ///< wall time per stage, in order
  std::size_t peak_memory_bytes = 0;                    ///< of the process, so far
  std::vector<Finding> findings;  ///< in the order of the stages; a broken promise: the mesh is not what it should be
};

struct MeshResult {
  Mesh mesh;
  Report report;
};

/// What a run makes on its way and keeps on request. A member that holds something (`kept.shell.emplace()`) is asked
/// for; after the run it holds what was made, or nothing where the method makes no such thing.
struct Artifacts {
  std::optional<Dexels> dexels;  ///< the crossings that a solid was meshed from; sheets have none
  /// The voxels of the shell; values: exact distance from the nearest voxel that the surface touches, centre to centre,
  /// model units. Solids meshed by rays have none.
  std::optional<SparseVolume> shell;
  std::optional<SparseVolume> shell_cut;  ///< of these the middle layer across the shortest side of the bounds
};

/// Samples a shape's surface, spreads seeds evenly over it (centroidal Voronoi tessellation) and connects them.
///
/// Guarantee: closed, two-manifold, oriented outward, without self-intersections; what could not be kept is a finding
/// of severity broken_promise. The shell method gives a boundary where the surface is open. Same bytes for any number
/// of threads. Triangles of closed solids have Q ≥ 0.7 and angles ≥ 38° where sharp edges and thin parts allow it
/// (docs/quality.md). Cost: two cores take about 0.1 ms and 7 kB per vertex, Quality::high up to five times as long.
/// @param kept  may be null: nothing is kept
/// @throws InvalidInput   options out of range
/// @throws UnusableInput  no surface within the bounds, or their longest side is not between 1e-8 and 1e10
/// @throws Cancelled      through `context`
/// Based on Martínez, Claux, Lefebvre, Raster2Mesh, Inria RR-8684, 2015, and, for the shell, on Leung, Wang, He, Liu,
/// Wang, A unified framework for isotropic meshing based on narrow-banded Euclidean distance transformation,
/// Computational Visual Media 1(3), 2015.
MeshResult mesh_shape(const Shape& shape, const MeshOptions& options = {},
                      ExecutionContext& context = ExecutionContext::silent(), Artifacts* kept = nullptr);

/// A line per figure, `"key": value`, as one JSON object (keys of the command line's --json).
std::string report_json(const Report& report);

}  // namespace evenmesh
