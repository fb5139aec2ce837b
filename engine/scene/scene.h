// A scene: materials divided by iso-values or a transfer function, lights, background and effects.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/scene/effects.h"
#include "engine/scene/rim.h"

namespace edgesplat {

struct Volume;

/// Reflection coefficients of a material: factors on the lights' intensity.
struct LightResponse {
    double ambient = 1;     ///< >= 0
    double diffuse = 1;     ///< >= 0
    double specular = 0;    ///< >= 0; 0 is dull
    double shininess = 32;  ///< Blinn-Phong exponent, [1, 1000]
    bool operator==(const LightResponse&) const = default;
};

/// A material: one interval of values.
struct Material {
    glm::dvec3 color{1.0, 0.85, 0.75};  ///< linear light, 0..1
    double extinction = 0;              ///< sigma_t per mm, >= 0; 0 is transparent
    LightResponse response{};
    std::string name{};  ///< for legends and messages; may be empty
    bool operator==(const Material&) const = default;
};

/// A point of a piecewise-linear transfer function. Beyond its first and last point the function is constant.
struct TransferPoint {
    double value = 0;       ///< the volume's unit
    glm::dvec3 color{1.0};  ///< linear light, 0..1
    double extinction = 0;  ///< per mm, >= 0
    bool operator==(const TransferPoint&) const = default;
};

/// A light. It adds to a surface with world normal n: color * intensity * (diffuse * max(0, n . l) + specular * max(0,
/// n . h)^shininess), with l towards the light and h halfway between l and the eye (Blinn 1977).
struct Light {
    enum class Kind { Headlight, Directional, Point };
    Kind kind = Kind::Headlight;
    glm::dvec3 direction{0, -1, 0};  ///< towards the light, world, any length > 0; for Directional only
    glm::dvec3 position{0};          ///< world mm; for Point only
    glm::dvec3 color{1.0};           ///< linear light, 0..1
    double intensity = 0.85;         ///< >= 0
    bool shadows = false;            ///< whether the light casts shadows; not for a headlight
    bool operator==(const Light&) const = default;
};

/// A white light from the direction `towards`.
Light directional_light(const glm::dvec3& towards);

/// v / |v| for any finite length > 0, without overflow or underflow.
glm::dvec3 unit(const glm::dvec3& v);

/// Which splats are lit: only those at an edge, with the normal at its foot point; or all, the others with their own
/// gradient.
enum class Lit { Edges, Everywhere };

inline constexpr std::size_t kMaxLights = 4;
inline constexpr std::size_t kMaxShadowLights = 2;
inline constexpr std::size_t kMaxIsoValues = 15;
inline constexpr std::size_t kMaxTransferPoints = 256;
inline constexpr std::size_t kMaxVolumes = 16;

/// A volume beside a scene's first one, with its own matter. Lights, effects and background are the scene's.
struct AddedVolume {
    std::shared_ptr<const Volume> volume;  ///< its geometry places it in the world
    // As in Scene.
    std::vector<double> iso_values;
    std::vector<Material> materials;
    std::vector<TransferPoint> transfer;
    std::vector<glm::dvec3> label_colors;
    bool clipped = true;
    bool replaces = false;  ///< within its grid, the other volumes have no matter
    double rim = 0;         ///< Rim::width; 0: automatic
    bool operator==(const AddedVolume&) const = default;
};

/// A scene. Material m has the values v with m = number of iso-values <= v.
struct Scene {
    std::vector<double> iso_values;   ///< ascending, in the volume's unit; 1..15, or 0 with a transfer function
    std::vector<Material> materials;  ///< iso_values.size() + 1, lowest interval first
    /// ascending; if not empty, it defines colour and extinction, and the materials only define reflection
    std::vector<TransferPoint> transfer;
    /// colour of each label of a volume from drawn_labels, by its place in Volume::labels; linear light. They replace
    /// the materials' colours except below the lowest iso-value. Empty: no labels are drawn
    std::vector<glm::dvec3> label_colors;
    double ambient = 0.15;               ///< ambient light, >= 0
    std::vector<Light> lights{Light{}};  ///< 0..4; with none, colours are unlit
    Lit lit = Lit::Everywhere;
    glm::dvec3 background{0, 0, 0};  ///< linear light
    Effects effects;
    bool clipped = true;             ///< whether clip planes cut the first volume
    std::vector<AddedVolume> added;  ///< at most kMaxVolumes - 1
    Rim rim;                         ///< only of a volume alone (scene_of_volume)
};

/// The scene with one of its volumes alone, without the region in which another one replaces it. `number`: 0 is the
/// first, the others follow in the order of `added`. Throws Error if two regions would be removed.
Scene scene_of_volume(const Scene& scene, std::size_t number);

/// The same with its rim. `first`: grid of the scene's first volume.
Scene scene_of_volume(const Scene& scene, std::size_t number, const VolumeGeometry& first);

/// The scenes of a volume's surfaces and of its kernels: surfaces are cut at the sides of the rim.
Scene scene_of_surfaces(Scene scene);
Scene scene_of_kernels(Scene scene);

/// Whether some value is matter.
bool has_matter(const Scene& scene);

/// The first feature of the scene that ray casting and the truth renderer do not support; empty: none. They support
/// measured values with transfer functions, materials without specular reflection, one headlight or directional white
/// light without shadows, and a plain background.
std::string raycast_obstacle(const Scene& scene);

/// Whether only splats at edges are lit: Lit::Edges, if edges are drawn.
bool lights_edges_only(const Scene& scene, bool edges_drawn);

/// Checks counts, order, finiteness and ranges. Throws Error naming the field, the value and what was expected.
void validate(const Scene& scene);

/// Whether ambient occlusion has an effect: it is on and the scene has lights.
bool occludes_ambient(const Scene& scene);

/// Indices of the lights with shadows, at most kMaxShadowLights.
std::vector<std::size_t> shadow_lights(const Scene& scene);

}  // namespace edgesplat
