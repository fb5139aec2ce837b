// Draws and measures the footprints of the four splats around an edge.
#pragma once

#include <filesystem>

namespace edgesplat {

struct FootprintTiles {
    double edge = 0.45;             ///< its place between voxels 0 and 1
    double degrees = 45;            ///< between the edge's normal and the ray, in the lower rows
    double short_cut_error = 0;     ///< paper family: largest error of the two-dimensional short cut there, over g(0)
    double no_warp_error = 0;       ///< the same without any warp
    double edge_on_difference = 0;  ///< largest difference of the short cut edge-on, over g(0)
};

/// Draws the tiles as a PNG and measures their errors.
FootprintTiles draw_footprint_tiles(const std::filesystem::path& target);

}  // namespace edgesplat
