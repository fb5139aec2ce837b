// Forecasts the passes and resources of a request without a device, before anything is allocated.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/forecast/effect_table.h"
#include "engine/gpu/image.h"
#include "engine/plan/resource_table.h"

namespace edgesplat {

/// Number and bounding box of splats, and how they were determined.
struct SplatCount {
    /// Voxels: upper bound from the number of voxels. Materials: visible voxels, counted on the host. Frame: collected.
    enum class From { Voxels, Materials, Frame };
    From from = From::Voxels;
    SplatExtent extent;
};

/// Upper bound: every voxel is a splat of each translucent material and of one other visible material.
SplatCount most_splats(const CollectionPlan& plan);

/// Counts on the host the splats that passes 1a and 2 collect: about 10 ns per voxel.
SplatCount count_splats(const Volume& volume, const CollectionPlan& plan);

/// Lifetime of a resource. Of the last three only one is active at a time; Drawing lasts until the next picture.
enum class Held { Always, Uploading, Lighting, Drawing };

/// An image or a buffer that a frame needs.
struct PlannedResource {
    ResourceText text;
    std::optional<gpu::ImageShape> image;  ///< else a buffer
    std::uint64_t bytes = 0;               ///< of its texels or elements; the device may round up
    vk::Format texels{};                   ///< format if shaders load the buffer as texels
    gpu::Buffer::Place place = gpu::Buffer::Place::Device;
    bool grows = false;  ///< a larger one of an earlier frame is reused
    Held held = Held::Always;
    std::optional<std::size_t> volume;  ///< FrameRequest::number of the volume that it holds; none: the picture's
};

/// One draw of the splats: the picture first, then the extra outputs.
struct ForecastDraw {
    std::string name;  ///< payload_name()
    FramePlan plan;
};

struct FrameForecast {
    Settings settings;  ///< canonical_settings()
    CollectionPlan collection;
    SplatCount splats;
    const gpu::DeviceProfile* profile = nullptr;  ///< the device's profile
    std::vector<ForecastDraw> draws;              ///< empty if the last part draws the splats, too
    bool occluded = false;                        ///< ambient occlusion is on
    std::size_t shadow_lights = 0;                ///< number of lights with shadows
    std::vector<PlannedResource> resources;       ///< all resources of a Renderer during this frame
    std::size_t number = 0;                       ///< FrameRequest::number
    /// Of several parts (drawn_parts): the one before this, drawn first. Else null.
    std::shared_ptr<const FrameForecast> behind;
};

/// The forecast's parts, in the order in which they are drawn.
std::vector<const FrameForecast*> forecast_parts(const FrameForecast& forecast);

/// The request's canonical_settings().
Settings drawn_settings(const FrameRequest& request);

/// The request with one of the scene's volumes alone (scene_of_volume).
FrameRequest request_of_volume(const FrameRequest& request, std::size_t number);

/// What is drawn of one volume from splat lists of its own: the parts of a mixture, opaque matter first, else the
/// request itself. Precondition: no added volumes.
std::vector<FrameRequest> parts_of_volume(const FrameRequest& request);

/// The parts of all volumes with matter: surface splats first, then kernels, which are drawn as one list. Their order
/// does not depend on that of the volumes. Throws Error if several volumes cannot be drawn together.
std::vector<FrameRequest> drawn_parts(const FrameRequest& request);

/// Whether the parts are of several volumes.
bool are_of_several_volumes(std::span<const FrameRequest> parts);

/// Whether buried voxels must be kept.
bool keeps_buried(const FrameRequest& request);

/// The resources of `forecast`, from its plans.
std::vector<PlannedResource> planned_resources(const FrameForecast& forecast);

/// The plan of passes 1 and 2 of a part (drawn_parts).
CollectionPlan planned_collection(const FrameRequest& part);

/// Forecasts one part. Preconditions: `collection` is planned_collection(part), `reach` is
/// kernel_reach(drawn_settings(part)). Throws Error like plan_frame().
FrameForecast forecast_part(const FrameRequest& part, const CollectionPlan& collection, const SplatCount& splats,
                            double reach, const gpu::DeviceProfile& profile);

/// Counts the splats of a part.
using SplatCounter = std::function<SplatCount(const FrameRequest& part, const CollectionPlan& collection)>;

/// most_splats() and count_splats() of a part.
SplatCount most_splats_of(const FrameRequest& part, const CollectionPlan& collection);
SplatCount count_splats_of(const FrameRequest& part, const CollectionPlan& collection);

/// Throws Error like plan_frame().
FrameForecast forecast_frame(const FrameRequest& request, const SplatCounter& count, const gpu::DeviceProfile& profile);

}  // namespace edgesplat
