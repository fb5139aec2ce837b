#include "engine/scene/volume_order.h"

namespace edgesplat {

std::vector<double> volume_order(const Volume& volume, const Scene& scene) {
    // Two halves, since a double does not hold 64 bits.
    std::vector<double> key{static_cast<double>(volume.checksum >> 32U),
                            static_cast<double>(volume.checksum & 0xffffffffU)};
    const auto add = [&](const glm::dvec3& v) { key.insert(key.end(), {v.x, v.y, v.z}); };
    const VolumeGeometry& geometry = volume.geometry;
    for (const glm::dvec3& v : {geometry.origin, geometry.index_to_world_axes[0], geometry.index_to_world_axes[1],
                                geometry.index_to_world_axes[2]})
        add(v);
    key.insert(key.end(), scene.iso_values.begin(), scene.iso_values.end());
    for (const Material& material : scene.materials) {
        add(material.color);
        key.push_back(material.extinction);
    }
    for (const TransferPoint& point : scene.transfer) {
        add(point.color);
        key.insert(key.end(), {point.value, point.extinction});
    }
    for (const glm::dvec3& color : scene.label_colors)
        add(color);
    return key;
}

}  // namespace edgesplat
