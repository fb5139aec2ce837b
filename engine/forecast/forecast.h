// What a request will run and hold, found before anything is allocated and without a device.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/forecast/effect_table.h"
#include "engine/gpu/image.h"
#include "engine/plan/resource_table.h"

namespace edgesplat {

/// How many splats there are, and the voxels that hold them.
struct SplatCount {
    enum class From { Voxels, Materials, Frame };
    From from = From::Voxels;  ///< every voxel; those that can be seen, found on the host; as collected
    SplatExtent extent;
};

/// As if every voxel were a splat of each material that one sees through, and of one that one does not.
SplatCount most_splats(const CollectionPlan& plan);

/// The voxels that pass 2 keeps, counted on the host, pass 1a included: about 10 ns per voxel.
SplatCount count_splats(const Volume& volume, const CollectionPlan& plan);

/// When something is held. Only one of the last four at a time; what a picture is drawn with stays until the next.
enum class Held { Always, Uploading, Occluding, Sweeping, Drawing };

/// An image or a buffer that a frame holds.
struct PlannedResource {
    ResourceText text;
    std::optional<gpu::ImageShape> image;  ///< else a buffer
    std::uint64_t bytes = 0;               ///< of its texels or elements; the device may round up
    vk::Format texels{};                   ///< of a buffer that shaders have as texels
    gpu::Buffer::Place place = gpu::Buffer::Place::Device;
    bool grows = false;  ///< a larger one of an earlier frame is kept
    Held held = Held::Always;
};

/// One draw of the splats: the picture first, then the extra outputs.
struct ForecastDraw {
    std::string name;  ///< payload_name()
    FramePlan plan;
};

struct FrameForecast {
    Settings settings;  ///< as drawn: drawn_as()
    CollectionPlan collection;
    SplatCount splats;
    const gpu::DeviceProfile* profile = nullptr;  ///< of the device that it is for
    std::vector<ForecastDraw> draws;
    std::vector<FramePlan> light_frames;     ///< pictures that the lights with shadows take
    bool occluded = false;                   ///< ambient light is
    std::vector<PlannedResource> resources;  ///< everything a Renderer holds at some time of this frame
};

/// The request's settings as they are drawn: drawn_as().
Settings drawn_settings(const FrameRequest& request);

/// Whether nothing may be dropped for being buried.
bool keeps_buried(const FrameRequest& request);

/// The resources of `forecast`, from its plans.
std::vector<PlannedResource> planned_resources(const FrameForecast& forecast);

/// What the request's passes 1 and 2 do.
CollectionPlan planned_collection(const FrameRequest& request);

/// `collection` is planned_collection(request), `reach` kernel_reach(drawn_settings(request)). Throws Error as
/// plan_frame does.
FrameForecast forecast_frame(const FrameRequest& request, const CollectionPlan& collection, const SplatCount& splats,
                             double reach, const gpu::DeviceProfile& profile);

}  // namespace edgesplat
