// What is to be seen: materials split by iso-values, light, background.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace edgesplat {

/// One interval of the value axis.
struct Material {
    glm::dvec3 color{1.0, 0.85, 0.75};  ///< linear light, 0..1
    double extinction = 0;              ///< sigma_t per mm, >= 0; 0 is transparent
};

/// One light on surfaces: intensity = ambient + diffuse * max(0, n . l), n the world normal at the edge's foot point.
/// A splat without any normal gets ambient + diffuse / 2.
struct Light {
    enum class Kind { None, Headlight, Directional };
    Kind kind = Kind::Headlight;
    glm::dvec3 direction{0, -1, 0};  ///< towards the light, world; Directional only
    double ambient = 0.15;
    double diffuse = 0.85;
};

/// Materials between sorted iso-values: material m holds values v with m = number of iso-values <= v.
struct Scene {
    std::vector<double> iso_values;   ///< ascending, in the volume's unit; 1..15 of them
    std::vector<Material> materials;  ///< iso_values.size() + 1, lowest interval first
    Light light;
    glm::dvec3 background{0, 0, 0};  ///< linear light
};

/// Checks counts, order, finiteness and ranges. Throws Error naming the field, the value and what was expected.
void validate(const Scene& scene);

}  // namespace edgesplat
