// What is to be seen: materials split by iso-values or a transfer function, lights, background, and the effects that
// the scene calls for.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/effects.h"

namespace edgesplat {

/// How a material answers to light: factors on what the lights send.
struct LightResponse {
    double ambient = 1;     ///< >= 0
    double diffuse = 1;     ///< >= 0
    double specular = 0;    ///< >= 0; 0 is dull
    double shininess = 32;  ///< Blinn-Phong exponent, [1, 1000]
    bool operator==(const LightResponse&) const = default;
};

/// One interval of the value axis.
struct Material {
    glm::dvec3 color{1.0, 0.85, 0.75};  ///< linear light, 0..1
    double extinction = 0;              ///< sigma_t per mm, >= 0; 0 is transparent
    LightResponse response{};
    std::string name{};  ///< for legends and messages; may be empty
    bool operator==(const Material&) const = default;
};

/// A point of a piecewise-linear transfer function; before the first and after the last point the ends' values hold.
struct TransferPoint {
    double value = 0;       ///< the volume's unit
    glm::dvec3 color{1.0};  ///< linear light, 0..1
    double extinction = 0;  ///< per mm, >= 0
    bool operator==(const TransferPoint&) const = default;
};

/// One light. What it adds to a surface of world normal n: color * intensity * (diffuse * max(0, n . l) +
/// specular * max(0, n . h)^shininess), l towards the light, h halfway between l and the eye (Blinn 1977).
struct Light {
    enum class Kind { Headlight, Directional, Point };
    Kind kind = Kind::Headlight;
    glm::dvec3 direction{0, -1, 0};  ///< towards the light, world, any length > 0; Directional only
    glm::dvec3 position{0};          ///< world mm; Point only
    glm::dvec3 color{1.0};           ///< linear light, 0..1
    double intensity = 0.85;         ///< >= 0
    bool shadows = false;            ///< whether what stands in its way darkens what lies behind; not for a headlight
    bool operator==(const Light&) const = default;
};

/// A white light from one direction.
Light directional_light(const glm::dvec3& towards);

/// v / |v|, whatever finite length above 0 it has.
glm::dvec3 unit(const glm::dvec3& v);

/// Which splats are lit: only those at an edge, by the normal at its foot point, or all, by their own gradient too.
enum class Lit { Edges, Everywhere };

inline constexpr std::size_t kMaxLights = 4;
inline constexpr std::size_t kMaxShadowLights = 2;
inline constexpr std::size_t kMaxIsoValues = 15;
inline constexpr std::size_t kMaxTransferPoints = 256;

/// Materials between sorted iso-values: material m holds values v with m = number of iso-values <= v.
struct Scene {
    std::vector<double> iso_values;       ///< ascending, in the volume's unit; 1..15, or 0 with a transfer function
    std::vector<Material> materials;      ///< iso_values.size() + 1, lowest interval first
    std::vector<TransferPoint> transfer;  ///< ascending; when not empty it says colour and extinction in place of the
                                          ///< materials, which then only answer to light
    bool labels = false;                 ///< values above the surface are numbers of things, between which nothing lies
    double ambient = 0.15;               ///< light from everywhere, >= 0
    std::vector<Light> lights{Light{}};  ///< 0..4; with none, colours are shown as they are
    Lit lit = Lit::Everywhere;
    glm::dvec3 background{0, 0, 0};  ///< linear light
    Effects effects;
};

/// What in a scene rays cast through values, and the truth of analytic scenes, do not show; empty: nothing. They know
/// transfer functions of values that are measured, materials without gloss, one headlight or directional white light
/// without shadows, and a plain background.
std::string beyond_ray_casting(const Scene& scene);

/// Whether splats without an edge count as without normal: Lit::Edges, where edges are drawn at all.
bool only_edges_lit(const Scene& scene, bool edges_drawn);

/// Checks counts, order, finiteness and ranges. Throws Error naming the field, the value and what was expected.
void validate(const Scene& scene);

/// Whether ambient light is occluded: the scene asks for it, and is lit at all.
bool occludes_ambient(const Scene& scene);

/// Numbers of the lights with shadows, at most kMaxShadowLights.
std::vector<std::size_t> shadow_lights(const Scene& scene);

}  // namespace edgesplat
