#pragma once
/// Sampling of implicit surfaces, piece by piece of the grid.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"
#include "shape/field.h"

namespace evenmesh {

/// Grid points per side of a node, for which a field may be specialized.
constexpr unsigned node_side = 64;

/// A cube of grid points: those from the corner on, and the side's next.
struct GridCube {
  std::array<std::uint32_t, 3> corner{};
  unsigned side = 0;     ///< in cells: a power of two, 8 or more
  bool unknown = false;  ///< the field tells nothing about it
};

/// Coordinates of all grid points, rounded once, so that every brick hands the very same floats to the field, and the
/// range of grid points that lie within the bounds.
struct FieldGrid {
  Grid grid;
  std::array<std::vector<float>, 3> coordinate;  ///< a multiple of a brick, and one more, of entries
  std::array<std::int32_t, 3> first{}, last{};   ///< grid points within the bounds, inclusive
  std::array<double, 3> face_lo{}, face_hi{};    ///< faces of the bounds in cells from the origin

  bool within(unsigned axis, std::int32_t i) const { return i >= first[axis] && i <= last[axis]; }
  bool within(const GridCube& cube) const;
};
FieldGrid make_field_grid(const Grid& grid, const Box& bounds);

/// A sign change on one grid edge, with what is known of f along it. Positions are in cells from the edge's lower end.
struct Bracket {
  EdgeCode code;
  bool on_bounds = false;  ///< one end lies beyond the bounds: its position is that of the face
  std::uint32_t block = 0;
  float t_lo = 0, t_hi = 1;
  float f_lo = 0, f_hi = 0;
};

/// Samples of a few neighbouring bricks, in their final order.
struct FieldPart : SampleColumns {
  std::vector<SampleBlock> blocks;  ///< ranges count from this part's first sample
  bool cut_by_bounds = false;
};

/// Finds the edges in cubes of bricks on which f changes its sign.
class TileScanner {
 public:
  /// Appends the brackets of the cubes, which are in Morton order, in that order of their bricks, and the blocks to
  /// `part`. Of each cube only the points within the bounds and next to them are evaluated, as many by one call as go
  /// into the field's batch. A field that wants batches is asked once for points that neighbours share.
  void scan(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes, std::vector<Bracket>& brackets,
            FieldPart& part);

 private:
  /// A box of grid points, z fastest, that holds those of some cubes.
  struct Tile {
    std::span<const GridCube> cubes;
    std::array<std::uint32_t, 3> start{}, points{};
    std::size_t at = 0;  ///< of the first point in f_ and inside_
    std::size_t count() const { return std::size_t{points[0]} * points[1] * points[2]; }
    std::size_t index(const std::array<std::uint32_t, 3>& p) const {
      return at + (std::size_t{p[0] - start[0]} * points[1] + (p[1] - start[1])) * points[2] + (p[2] - start[2]);
    }
  };
  static Tile tile_of(std::span<const GridCube> cubes, const FieldGrid& grid);
  std::size_t evaluate_all(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes);
  std::size_t evaluate_shared(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes);
  void reserve(std::size_t points, std::size_t asked);
  void place(const Tile& tile, const FieldGrid& grid);
  void place_shared(const Tile& tile, const FieldGrid& grid);
  bool has_border(const Tile& tile, const FieldGrid& grid);
  void scan_cube(const Tile& tile, const GridCube& cube, const FieldGrid& grid, std::vector<Bracket>& brackets,
                 FieldPart& part);
  void scan_brick(const Tile& tile, const FieldGrid& grid, const std::array<std::uint32_t, 3>& corner,
                  std::vector<Bracket>& brackets, FieldPart& part);

  std::vector<Tile> tiles_;
  std::vector<float> x_, y_, z_, f_, values_;
  std::vector<std::uint8_t> inside_;
  std::vector<std::size_t> asked_;  ///< where in f_ the values go
};

/// Finds where f = 0 on each bracket, to 1e-4 cells, with its normal, and fills in the arrays of `part`; to 4e-3 cells
/// where gradients are dear and f is so rough that no chord finds the root.
/// Fields without gradient are bisected to 2^-12 cells and get the edge's axis as their normal. Calls of the field: two
/// or three, and one for each step that the slowest root of a batch takes, at most 40.
class RootFinder {
 public:
  void find(const Field& field, const FieldGrid& grid, std::vector<Bracket>& brackets, FieldPart& part);

 private:
  struct Root {
    float t = 0;
    float n[3] = {};
    bool synthetic = false;
  };
  void find_batch(std::span<Bracket> brackets, std::size_t first, FieldPart& part);
  void place(std::size_t slot, const Bracket& bracket, float t);
  void evaluate(std::size_t count);
  void clip_to_bounds(std::span<Bracket> brackets);
  void first_guess(std::span<Bracket> brackets);
  void first_values(std::span<Bracket> brackets);
  void refine(std::span<Bracket> brackets);
  void differentiate(std::span<const Bracket> brackets, std::span<const std::uint32_t> which);
  void bisect(std::span<Bracket> brackets);
  void normalize(std::span<const Bracket> brackets);
  void append(std::span<const Bracket> brackets, std::size_t first, FieldPart& part) const;

  const Field* field_ = nullptr;
  const FieldGrid* grid_ = nullptr;
  const FieldPart* part_ = nullptr;
  std::vector<Root> roots_;
  std::vector<std::uint32_t> active_, on_bounds_;
  std::vector<float> x_, y_, z_, f_, dx_, dy_, dz_;
};

/// Bricks without samples that the surface goes on into from bricks with samples.
///
/// A brick's samples tell the signs at its grid points and those one step beyond; where the ones on a face differ, the
/// surface goes through it. @param fresh  the parts from this one on are looked at
std::vector<GridCube> surface_continuation(std::span<const FieldPart> parts, std::size_t fresh,
                                           const ExecutionContext& context);

/// Samples where f changes its sign on the grid and within the bounds (empty: the grid's), without sources.
///
/// Fields that want batches and tell nothing about boxes are not asked at every point of grids with 640 points or more
/// along a side: a surface that is seen at one of 240 points along it or more is found whole, smaller pieces that lie
/// apart may be missed. They would be smaller than the cells of a mesh.
SampleSet sample_field(const Field& field, const Grid& grid, const Box& bounds, const ExecutionContext& context);

/// Normals and areas from the positions of the samples around each: least-squares planes, oriented by the edges' codes.
void fit_normals(SampleSet& set, const ExecutionContext& context);
/// The same for the samples whose normal is no_normal (tri_dexel.h), without their total area.
void fit_missing_normals(SampleSet& set, const ExecutionContext& context);

}  // namespace evenmesh
