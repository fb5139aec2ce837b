// Figures 9 to 12: plain splatting, the paper's own method and ours, rendered, timed and measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/paper/document.h"
#include "engine/renderer.h"

namespace edgesplat {

/// A picture figure as it is to be made.
struct PictureFigure {
    std::string number;       ///< "9"
    std::string title;        ///< of its section
    std::string volume_path;  ///< "builtin:...", or below the folder of real volumes
    std::string volume_name;  ///< as the page and the pictures' metadata call it
    std::string text;         ///< what it shows and how sure that is
    Scene scene;
    glm::dvec3 eye{0}, direction{0}, up{0, 0, 1};  ///< voxels
    double fov_y = 45;
    bool box_filter = false;
    bool outline = true;  ///< the background is seen: edges are measured on the opaque surface's outline
    bool is_builtin() const { return volume_path.starts_with("builtin:"); }
};

/// Figures 9, 10, 11 and 12.
std::vector<PictureFigure> picture_figures();

/// Renders a figure's three pictures into `images` and describes them. `data` is the folder of real volumes.
Section picture_section(const PictureFigure& figure, Renderer& renderer, const std::filesystem::path& data,
                        const std::filesystem::path& images);

/// The seams at planes, from the measuring code of the tests.
Section seam_section();

}  // namespace edgesplat
