#include "engine/accuracy/identity.h"

#include <fmt/format.h>

namespace edgesplat::accuracy {

nlohmann::ordered_json identity_of(const ReportInput& input, const ReportOptions& options, const DeviceInfo& device) {
    nlohmann::ordered_json materials = nlohmann::ordered_json::array();
    for (const Material& m : input.scene.materials)
        materials.push_back({m.color.x, m.color.y, m.color.z, m.extinction});
    nlohmann::ordered_json lights = nlohmann::ordered_json::array();
    for (const Light& light : input.scene.lights) {
        lights.push_back(
            {static_cast<int>(light.kind), light.direction.x, light.direction.y, light.direction.z, light.intensity});
    }
    return {{"program", input.program},
            {"journal", 5},
            {"volume", input.volume->name},
            {"checksum", fmt::format("{:016x}", input.volume->checksum)},
            {"iso_values", input.scene.iso_values},
            {"materials", materials},
            {"ambient", input.scene.ambient},
            {"lights", lights},
            {"background", {input.scene.background.x, input.scene.background.y, input.scene.background.z}},
            {"truth", input.analytic.has_value()},
            {"base", settings_key(options.base)},
            {"size", fmt::format("{}x{}", options.size.x, options.size.y)},
            {"tolerance", options.tolerance},
            {"repeats", options.repeats},
            {"orbit", fmt::format("{} frames of {} pixels", options.orbit_frames, options.orbit_size)},
            {"surface_points", options.surface_points},
            {"knobs", options.knobs},
            {"cameras", options.cameras},
            {"device", device.name},
            {"driver", device.driver + " " + device.driver_version}};
}

}  // namespace edgesplat::accuracy
