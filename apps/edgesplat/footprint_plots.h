// Figures 4, 6, 7 and 8 of Huang, Crawfis, Stredney 1998, drawn by gnuplot from the functions the renderer uses.
#pragma once

#include <filesystem>
#include <vector>

#include "footprints/edge_warp.h"

/// Writes the four figures as PNG files into `folder` (created if it is missing) and returns their paths. A file
/// appears only when it is complete. Throws edgesplat::Error if gnuplot is missing or fails, or the folder cannot be
/// written.
std::vector<std::filesystem::path> plot_paper_figures(const std::filesystem::path& folder,
                                                      const edgesplat::EdgeBand& band);
