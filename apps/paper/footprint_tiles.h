// The footprints of the four splats around an edge, side by side.
#pragma once

#include <filesystem>

namespace edgesplat {

struct FootprintTiles {
    double edge = 0.45;          ///< where it lies between voxels 0 and 1
    double degrees = 45;         ///< between the edge's normal and the ray, in the lower rows
    double short_cut_error = 0;  ///< paper family: largest error of the two-dimensional short cut there, share of g(0)
    double no_warp_error = 0;    ///< and of no warp at all
    double edge_on_difference = 0;  ///< largest difference of the short cut seen edge-on
};

/// Draws them as a PNG and measures.
FootprintTiles draw_footprint_tiles(const std::filesystem::path& target);

}  // namespace edgesplat
