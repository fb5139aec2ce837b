// Signs drawn over a finished picture: which way the volume lies, how large it is, what the colours mean.
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

/// An axis of the orientation marker as the camera sees it from afar (orthographic).
struct MarkerAxis {
    glm::dvec2 along{
        0};  ///< its unit vector on the screen, x to the right, y down; shorter the more it is foreshortened
    double towards_eye = 0;          ///< component towards the eye, -1..1
    std::string positive, negative;  ///< letters of its two ends; `negative` may be empty
};

/// Volumes in patient coordinates: the patient's axes L/R, P/A, H/F; others: the volume's own, X, Y and Z.
std::array<MarkerAxis, 3> marker_axes(const Volume& volume, const Camera& camera);

/// A round length and what it measures in the picture.
struct ScaleBar {
    double millimetres = 0;  ///< 1, 2 or 5 times a power of ten
    double pixels = 0;       ///< its length across the view axis at the depth of the volume's centre
};

/// The longest one of at most `most` pixels; none where the volume's centre is not in front of the eye.
std::optional<ScaleBar> scale_bar(const Volume& volume, const Camera& camera, int height, double most);
/// The same for a pixel's side in mm; none unless that is above 0 and finite.
std::optional<ScaleBar> scale_bar(double mm_per_pixel, double most);

/// Draws what scene.effects.overlays asks for over a picture in linear light (RGB, or RGBA with the background blended
/// in): the marker in the lower left corner, the bar in the lower right, the legend in the upper left. Sizes go with
/// the picture's height. Returns the boxes outside which nothing has changed. Throws Error when there is no font.
std::vector<PixelBox> draw_overlays(Image& image, const Volume& volume, const Scene& scene, const Camera& camera);

}  // namespace edgesplat
