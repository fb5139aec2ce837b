// Renders, times and measures Figures 9 to 12: plain splatting, the paper's own method and ours.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/paper/document.h"
#include "engine/renderer.h"

namespace edgesplat {

/// The recipe of a figure that is rendered.
struct PictureFigure {
    std::string number;       ///< "9"
    std::string title;        ///< title of its section
    std::string volume_path;  ///< "builtin:...", or relative to the folder of real volumes
    std::string volume_name;  ///< name in the page and in the pictures' metadata
    std::string text;         ///< content and assumptions
    Scene scene;
    glm::dvec3 eye{0}, direction{0}, up{0, 0, 1};  ///< voxels
    double fov_y = 45;
    bool box_filter = false;
    bool outline = true;  ///< the background is visible: edges are measured at the opaque surface's outline
    bool is_builtin() const { return volume_path.starts_with("builtin:"); }
};

/// Figures 9, 10, 11 and 12.
std::vector<PictureFigure> picture_figures();

/// Renders a figure's three pictures into `images` and describes them. `data` is the folder of real volumes.
Section picture_section(const PictureFigure& figure, Renderer& renderer, const std::filesystem::path& data,
                        const std::filesystem::path& images);

/// The seams at planes, by the measuring code of the tests.
Section seam_section();

}  // namespace edgesplat
