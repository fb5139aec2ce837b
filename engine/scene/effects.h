// Optional effects of a scene. All are off by default; an effect that is off adds no pass, buffer or instruction to the
// frame.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace edgesplat {

/// Depth cueing. With depth in mm along the view axis, a colour keeps the share exp(-density * max(0, depth - start));
/// the rest is the fog's colour. The background does not change.
struct Fog {
    glm::dvec3 color{0, 0, 0};  ///< linear light, 0..1
    double density = 0.01;      ///< per mm, >= 0
    double start = 0;           ///< mm, >= 0
    bool operator==(const Fog&) const = default;
};

/// Blends colours towards `color` with weight strength * (1 - |n . v|)^sharpness: strongest at silhouettes.
struct Silhouette {
    glm::dvec3 color{0, 0, 0};  ///< linear light, 0..1
    double strength = 0.8;      ///< [0, 1]
    double sharpness = 3;       ///< [0.25, 64]
    bool operator==(const Silhouette&) const = default;
};

/// Ambient occlusion. The ambient light of a splat is the light that reaches it over the hemisphere of its normal
/// (cosine weighted; over the sphere without a normal). Matter within `radius` attenuates it; beyond, there is no
/// occlusion.
struct AmbientOcclusion {
    double strength = 1;  ///< [0, 1]: share of the occlusion that is applied
    double radius = 10;   ///< mm, > 0
    bool operator==(const AmbientOcclusion&) const = default;
};

/// A plane through `point`; points on the side of `normal` are beyond it.
struct Plane {
    glm::dvec3 point{0};         ///< world mm
    glm::dvec3 normal{0, 0, 1};  ///< world, any length > 0
    bool operator==(const Plane&) const = default;
};

/// Clip planes. A point is removed if it is beyond any plane of `keep` (planes, or the outside of a box), or beyond no
/// plane of `remove` (the inside of a box). The cut is sharp; its face is lit with the plane's normal.
struct Clip {
    std::vector<Plane> keep;    ///< 0..8
    std::vector<Plane> remove;  ///< 0..8; empty: removes nothing
    bool empty() const { return keep.empty() && remove.empty(); }
    bool operator==(const Clip&) const = default;
};

inline constexpr std::size_t kMaxClipPlanes = 8;
inline constexpr int kMaxSamples = 8;

/// Overlays drawn over the picture; other pixels do not change.
struct Overlays {
    bool orientation = false;  ///< orientation marker with patient directions
    bool scale_bar = false;    ///< scale bar in mm at the depth of the volume's centre
    bool legend = false;       ///< legend of materials or transfer function with values
    bool any() const { return orientation || scale_bar || legend; }
    bool operator==(const Overlays&) const = default;
};

struct Effects {
    std::optional<Fog> fog;
    std::optional<Silhouette> silhouette;
    std::optional<AmbientOcclusion> occlusion;
    Clip clip;
    std::optional<glm::dvec3> background_top;  ///< linear light: top of a vertical gradient; `background` is its bottom
    /// Limits footprints to at least one pixel and keeps their energy (Zwicker et al. 2002, EWA splatting).
    bool antialias = false;
    /// Antialiases the outlines of faces: a pixel on an outline blends both sides. No effect on plain kernels and rays.
    bool smooth_outlines = false;
    int samples = 1;  ///< n: each pixel is the mean of n x n subpixel samples, [1, 8]
    Overlays overlays;
    bool operator==(const Effects&) const = default;
};

/// Checks ranges and counts. Throws Error naming the field, the value and what was expected.
void validate(const Effects& effects);

}  // namespace edgesplat
