#include "engine/scene/mixture.h"

#include "engine/scene/transfer_function.h"

namespace edgesplat {
namespace {

bool is_seen(const Material& material) {
    return material.extinction > 0;
}

/// Whether a boundary between the two shows.
bool differ(const Material& a, const Material& b) {
    return is_seen(a) != is_seen(b) || (is_seen(a) && a != b);
}

/// The translucent material next to each opaque one; its own where a material is not opaque.
std::vector<Material> continued(const Scene& scene, std::uint32_t translucent) {
    std::vector<Material> materials = scene.materials;
    const auto is_translucent = [&](std::size_t m) { return (translucent >> m & 1U) != 0; };
    const auto is_opaque = [&](std::size_t m) { return is_seen(scene.materials[m]) && !is_translucent(m); };
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (!is_opaque(m)) continue;
        // The materials at both ends of a run of opaque ones.
        std::size_t low = m, high = m;
        while (low > 0 && is_opaque(low))
            --low;
        while (high + 1 < materials.size() && is_opaque(high))
            ++high;
        if (is_translucent(low))
            materials[m] = scene.materials[low];
        else if (is_translucent(high))
            materials[m] = scene.materials[high];
        else
            materials[m].extinction = 0;
    }
    return materials;
}

}  // namespace

std::optional<Mixture> mixture_of(const Settings& settings, const Scene& scene, const Volume& volume) {
    if (!scene.transfer.empty()) return std::nullopt;
    const std::uint32_t translucent = translucent_materials(scene, volume.geometry);
    if (translucent == 0) return std::nullopt;
    Mixture mixture{scene, scene};
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if ((translucent >> m & 1U) != 0) mixture.surfaces.materials[m].extinction = 0;
    if (!draws_surfaces(settings, mixture.surfaces, volume)) return std::nullopt;

    const std::vector<Material> materials = continued(scene, translucent);
    Scene& kernels = mixture.kernels;
    kernels.iso_values.clear();
    kernels.materials = {materials.front()};
    for (std::size_t m = 1; m < materials.size(); ++m) {
        if (!differ(materials[m - 1], materials[m])) continue;
        kernels.iso_values.push_back(scene.iso_values[m - 1]);
        kernels.materials.push_back(materials[m]);
    }
    // Without iso-values, kernels would not be cut at the volume's border.
    if (kernels.iso_values.empty()) {
        kernels.iso_values = scene.iso_values;
        kernels.materials = materials;
    }
    return mixture;
}

}  // namespace edgesplat
