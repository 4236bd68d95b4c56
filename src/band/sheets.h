#pragma once
/// Which part of a shell's surface becomes the mesh: one of the two sides of every sheet.

#include <cstdint>
#include <vector>

#include "band/band_surface.h"

namespace evenmesh {

struct Sheets {
  std::vector<char> chosen;  ///< by sample of the shell's surface
  std::vector<char> border;  ///< chosen samples with a neighbour that is not
  std::size_t sheets = 0;    ///< connected pieces that were chosen, whole or in part
  std::size_t dropped = 0;   ///< sheets that were too small
  std::size_t cut = 0;  ///< of them those that had to end where other sheets go on: fins, crossings, one-sided ones
};

/// Chooses parts of the shell's surface that cover every site once, as far as possible in whole sheets.
///
/// The surface of the shell around a closed surface has parts that see it from one side only: the outer one is taken.
/// Around an open surface one part sees both sides; it is cut along the rims, where it faces neither, and the larger
/// side, or that in front of the input's triangles, is taken. Where several sheets meet, each later one ends where the
/// sites are covered already.
///
/// @param least_area  of a sheet worth keeping, model units squared
/// Guarantee: same result for any number of threads. Cost: about 0.2 µs per sample.
Sheets choose_sheets(const BandSurface& surface, const SiteVoxels& sites, double min_area, ExecutionContext& context);

/// The parts that border on the outside: where what floods in from the grid's border comes to an end. Nothing is cut.
Sheets outer_sheets(const BandSurface& surface, ExecutionContext& context);

}  // namespace evenmesh
