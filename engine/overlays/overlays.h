// Draws overlays over a finished picture: orientation marker, scale bar, legend.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/overlays/canvas.h"
#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// An axis of the orientation marker in orthographic projection.
struct MarkerAxis {
    glm::dvec2 along{0};             ///< projection of its unit vector to the screen, x to the right, y down
    double towards_eye = 0;          ///< component towards the eye, -1..1
    std::string positive, negative;  ///< labels of its two ends; `negative` may be empty
};

/// The patient axes L/R, P/A, H/F for volumes in patient coordinates, else the volume's axes X, Y, Z.
std::array<MarkerAxis, 3> marker_axes(const Volume& volume, const Camera& camera);

/// A round length in mm and its length in the picture.
struct ScaleBar {
    double millimetres = 0;  ///< 1, 2 or 5 times a power of ten
    double pixels = 0;  ///< its length in pixels at the depth of the volume's centre, perpendicular to the view axis
};

/// The longest bar of at most `most` pixels; none if the volume's centre is not in front of the eye.
std::optional<ScaleBar> scale_bar(const Volume& volume, const Camera& camera, int height, double most);
/// The longest bar for a given pixel size; none unless that is above 0 and finite.
std::optional<ScaleBar> scale_bar(double mm_per_pixel, double most);

/// Draws the overlays of scene.effects.overlays over a picture in linear light (RGB, or RGBA with blended background):
/// the marker in the lower left corner, the bar in the lower right, the legend in the upper left. Sizes scale with the
/// picture's height. Returns boxes that contain all changed pixels. Throws Error if there is no font.
std::vector<PixelBox> draw_overlays(Image& image, const Volume& volume, const Scene& scene, const Camera& camera);

}  // namespace edgesplat
