// What a scene may call for beside surfaces and light. Every effect is off unless the scene says otherwise, and what
// is off leaves no pass, no buffer and no instruction in the frame.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace edgesplat {

/// Depth cueing: of what lies `depth` mm along the view axis from the eye, exp(-density * max(0, depth - start)) is
/// left and the rest takes the fog's colour. The background stays as it is.
struct Fog {
    glm::dvec3 color{0, 0, 0};  ///< linear light, 0..1
    double density = 0.01;      ///< per mm, >= 0
    double start = 0;           ///< mm, >= 0
    bool operator==(const Fog&) const = default;
};

/// Where a surface turns away from the eye its colour goes towards `color`: by strength * (1 - |n . v|)^sharpness.
struct Silhouette {
    glm::dvec3 color{0, 0, 0};  ///< linear light, 0..1
    double strength = 0.8;      ///< [0, 1]
    double sharpness = 3;       ///< [0.25, 64]
    bool operator==(const Silhouette&) const = default;
};

/// Ambient light is what reaches a splat over the half space that its normal looks into (cosine weighted; over all
/// directions where it has none): open sky beyond `radius`, and before it whatever the matter lets through.
struct AmbientOcclusion {
    double strength = 1;  ///< [0, 1]: share of the occlusion that is shown
    double radius = 10;   ///< mm, > 0
    bool operator==(const AmbientOcclusion&) const = default;
};

/// How finely lights with shadows see the volume.
struct ShadowQuality {
    int resolution = 256;  ///< pixels across the light's picture, [16, 2048]
    int layers = 128;      ///< at most, along the light, [2, 1024]
    bool operator==(const ShadowQuality&) const = default;
};

/// A plane through `point`; what lies on the side `normal` points to is beyond it.
struct Plane {
    glm::dvec3 point{0};         ///< world mm
    glm::dvec3 normal{0, 0, 1};  ///< world, any length > 0
    bool operator==(const Plane&) const = default;
};

/// What is cut away: everything beyond any plane of `keep` (planes, a box to stay inside of), and everything that is
/// beyond no plane of `remove` (a box to be cut out). The cut is sharp, and its face is lit by its own normal.
struct Clip {
    std::vector<Plane> keep;    ///< 0..8
    std::vector<Plane> remove;  ///< 0..8; empty: nothing is cut out
    bool empty() const { return keep.empty() && remove.empty(); }
    bool operator==(const Clip&) const = default;
};

inline constexpr std::size_t kMaxClipPlanes = 8;
inline constexpr int kMaxSamples = 8;

/// Signs in the picture, drawn over it: they change no pixel elsewhere.
struct Overlays {
    bool orientation = false;  ///< the volume's axes with patient directions
    bool scale_bar = false;    ///< a length in mm at the depth of the volume's centre
    bool legend = false;       ///< materials or transfer function with their values
    bool any() const { return orientation || scale_bar || legend; }
    bool operator==(const Overlays&) const = default;
};

struct Effects {
    std::optional<Fog> fog;
    std::optional<Silhouette> silhouette;
    std::optional<AmbientOcclusion> occlusion;
    ShadowQuality shadows;  ///< used where a light asks for shadows
    Clip clip;
    std::optional<glm::dvec3> background_top;  ///< linear light: the background goes from `background` (bottom) to this
    bool antialias =
        false;  ///< no footprint smaller than a pixel, its energy kept (Zwicker et al. 2002, EWA splatting)
    /// A pixel that an outline of a face passes shows what is on both its sides; plain kernels and rays have none.
    bool smooth_outlines = false;
    int samples = 1;  ///< n: the mean of n x n pictures whose rays lie between the pixels' centres, [1, 8]
    Overlays overlays;
    bool operator==(const Effects&) const = default;
};

/// Checks ranges and counts. Throws Error naming the field, the value and what was expected.
void validate(const Effects& effects);

}  // namespace edgesplat
