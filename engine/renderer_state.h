// What a Renderer owns. Tests of single passes look in here; embedders do not.
#pragma once

#include <optional>

#include "engine/frame.h"
#include "engine/frame_raycast.h"
#include "footprints/footprint_cache.h"
#include "footprints/footprint_table.h"

namespace edgesplat {

struct RendererState {
    explicit RendererState(const DeviceChoice& choice);

    /// Passes 1 and 2, if the plan differs from what the splat list was made with. Milliseconds spent.
    double collect(const Scene& scene, const Settings& settings, bool keep_buried);
    /// Footprint table or paper warp that the settings call for.
    void provide_footprints(const Settings& settings);
    /// Targets and buffers of the plan's sizes; fills in addresses and the frame's parameters.
    void provide_targets(FramePlan& plan);
    /// Passes 3 to 7 with one payload; the picture is left in targets.output.
    void draw(const Scene& scene, const Camera& camera, const Settings& settings, const glm::ivec2& size,
              std::uint32_t payload);

    gpu::Device device;
    gpu::Pipelines pipelines{device};
    Bindings bindings{device, pipelines};
    gpu::Commands commands{device, pipelines, bindings.set()};

    std::shared_ptr<const Volume> volume;
    VolumeResources volume_resources;
    FootprintResources footprint_resources;
    TargetResources targets;
    std::optional<RaycastResources> raycast;  ///< of this volume, once a picture was made that way

    std::optional<CollectionPlan> collected;  ///< what the splat list was made with
    std::optional<EdgeBand> table_band;       ///< what the footprint table was made for
    FootprintTableSize table_texels;
    bool curved_in_use = false;
    std::optional<EdgeBand> band_in_use;  ///< what the support spheres were made for
    FramePlan plan;                       ///< of the last draw
    std::vector<PassTime> collection_times;
};

/// Scales state.volume and brings it to the device.
void upload_volume(RendererState& state);

}  // namespace edgesplat
