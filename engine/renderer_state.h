// What a Renderer owns. Tests of single passes look in here; embedders do not.
#pragma once

#include <optional>

#include "engine/frame.h"
#include "engine/frame_memory.h"
#include "engine/frame_raycast.h"
#include "engine/frame_reach.h"
#include "engine/frame_tiles.h"
#include "footprints/footprint_cache.h"
#include "footprints/footprint_table.h"

namespace edgesplat {

struct RendererState {
    explicit RendererState(const DeviceChoice& choice);

    /// Passes 1 and 2, if the plan differs from what the splat list was made with, and what the scene calls for of
    /// passes 2b to 2d. Needs provide_footprints. Milliseconds spent.
    double collect(const Scene& scene, const Settings& settings, bool keep_buried);
    void collect_anew(const CollectionPlan& wanted);
    /// Pass 2b, if the scene calls for it and what was found differs. Whether it ran.
    bool occlude(const Scene& scene);
    /// Passes 2c and 2d, likewise; the picture's targets are dropped then.
    bool cast_shadows(const Scene& scene, const Settings& settings);
    /// Frees everything of a picture but what any picture needs.
    void drop_targets();
    /// Throws Error, before anything is allocated, if the request does not fit into the device's memory.
    void check_memory(const FrameRequest& request);
    /// The furthest that a kernel of these settings reaches, voxels.
    double reach_of(const Settings& drawn);
    /// The splats that are collected, if they are those of the plan.
    std::optional<SplatCount> collected_splats(const CollectionPlan& wanted) const;
    /// Brings the volume to the device if it is not there.
    void provide_volume();
    /// Frees what pictures with these settings do not use.
    void release_unused(const Settings& drawn);
    /// Support spheres of the settings' kernels.
    void choose_supports(const Settings& settings);
    /// Footprint table or paper warp that the settings call for.
    void provide_footprints(const Settings& settings);
    /// Targets and buffers of the plan's sizes; fills in addresses and the frame's parameters.
    void provide_targets(FramePlan& plan);
    void provide_layers(FramePlan& plan);
    void provide_tiles(shader::FrameParams& p);
    /// Room for the pairs of the largest chunk; brings the chunks to the device.
    void provide_chunks(const Chunks& chunks);
    /// Passes 3 to 7 with one payload; the picture is left in targets.output. `offset`: of its rays from the pixels'
    /// centres, in pixels.
    void draw(const Scene& scene, const Camera& camera, const Settings& settings, const glm::ivec2& size,
              std::uint32_t payload, const glm::dvec2& offset = {0, 0});

    /// Adds what the last draw came to, if that is counted.
    void add_counts(RenderStats& stats) const;

    gpu::Device device;
    gpu::Pipelines pipelines{device, footprint_cache_folder()};
    Bindings bindings{device, pipelines};
    gpu::Commands commands{device, pipelines, bindings.set()};

    std::shared_ptr<const Volume> volume;
    VolumeResources volume_resources;
    FootprintResources footprint_resources;
    TargetResources targets;
    std::optional<RaycastResources> raycast;  ///< of this volume, once a picture was made that way

    std::optional<CollectionPlan> collected;  ///< what the splat list was made with
    std::optional<OcclusionPlan> occluded;    ///< what the splats' ambient light was found with
    std::optional<ShadowPlan> shadowed;       ///< what their shadows were found with
    std::optional<EdgeBand> table_band;       ///< what the footprint table was made for
    FootprintTableSize table_texels;
    bool curved_in_use = false;
    std::optional<EdgeBand> band_in_use;  ///< what the support spheres were made for
    FramePlan plan;                       ///< of the last draw
    std::vector<PassTime> collection_times;
    std::vector<PassTime> draw_times;                                ///< of the last draw
    bool counting = false;                                           ///< see Renderer::count_fragments
    std::uint64_t memory_budget = 0;                                 ///< bytes; 0: what the device has
    std::vector<std::pair<std::string, std::uint64_t>> checked_fit;  ///< resources that were last found to fit
};

/// Whether footprints are looked up, and how large the table is.
bool uses_table(const Settings& settings);
FootprintTableSize table_size_of(TableSize size);

/// Scales state.volume and brings it to the device.
void upload_volume(RendererState& state);

}  // namespace edgesplat
