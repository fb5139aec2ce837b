// The library's main interface: renders a volume, a scene and a camera to a picture, with statistics. Needs a Vulkan
// 1.3 device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/device_info.h"
#include "engine/error.h"
#include "engine/image/image.h"
#include "engine/scene/frame_request.h"
#include "engine/scene/renderer_kind.h"

namespace edgesplat {

/// Sampling of `Renderer::raycast`.
struct RaycastSettings {
    double step = 0.5;  ///< voxels between samples along the ray, (0.01, 4]
    RaycastFilter filter = RaycastFilter::Trilinear;
    bool skip_empty = true;  ///< skips transparent bricks; does not change the picture
};

/// Checks the ranges above. Throws Error naming the field, the value and the range.
void validate(const RaycastSettings& settings);

/// Device memory that is allocated under one name.
struct MemoryUse {
    std::string name;
    std::uint64_t bytes = 0;  ///< peak during the frame
};

/// Statistics of a frame: times, counts and memory.
struct RenderStats {
    DeviceInfo device;
    /// In the order of the frame. Passes of extra outputs have a prefix: "tau: 5_draw_splats".
    std::vector<PassTime> passes;
    double setup_milliseconds = 0;  ///< upload, estimation and collection; 0 if nothing changed since the last frame
    double frame_milliseconds = 0;  ///< wall clock from submit to finish
    /// voxels whose edges were estimated for this picture, including the borders of blocks
    std::uint64_t voxels_estimated = 0;
    std::uint64_t voxels = 0, splats_collected = 0, splats_drawn = 0, edge_splats = 0;
    bool splats_read = false;         ///< from a file of an earlier run (DeviceChoice::keep_splats)
    std::uint64_t splats_culled = 0;  ///< splats in bricks that are culled: outside the picture or hidden
    std::uint32_t sheets = 0, sheet_groups = 0;
    int level = 0;  ///< level of the volume that was drawn; its voxels span 2^level voxels along each axis
    /// the level that the settings require; a coarser one is drawn if that does not fit into memory
    int wanted_level = 0;
    bool complete = true;    ///< false: a coarser level is shown until the wanted one is ready (Renderer::set_patience)
    bool in_blocks = false;  ///< true: the device processed the volume in blocks, not as a whole
    std::uint64_t blocks = 0;        ///< blocks that can contain splats
    std::uint64_t blocks_held = 0;   ///< blocks whose splats are on the device
    std::uint64_t device_bytes = 0;  ///< allocated on the device
    std::vector<MemoryUse> memory;   ///< by name; includes memory that was freed during the frame
    std::uint64_t submissions = 0;   ///< command buffers submitted, including those of the setup
    std::uint64_t pipelines_made = 0;
    double pipeline_milliseconds = 0;  ///< time to create them; included in the setup and frame times
    /// Set after Renderer::count_fragments. Covers the splats of the colour picture, not of extra outputs.
    std::optional<DrawCounts> draw_counts;
    /// Set after Renderer::count_fragments. Mean share of the picture that the rectangle of a sheet group covers.
    std::optional<double> dirty_share;
    std::uint64_t validation_messages = 0;
};

struct RenderResult {
    Image color;  ///< RGBA; the background is blended in, and alpha is the opacity of the volume alone
    std::optional<Image> tau, depth, normal, distance;
    RenderStats stats;
};

/// The member of RenderResult that holds an extra output.
std::optional<Image> RenderResult::*image_of(const Aov& aov);

struct FrameForecast;    // engine/forecast/forecast.h
struct PlannedResource;  // engine/forecast/forecast.h
struct FittingChange;    // engine/forecast/description.h

/// Private state of a Renderer (engine/renderer/state.h).
struct RendererState;

/// Owns the device and all its resources. Not thread-safe; use one per thread. Every member throws Error. If the device
/// is lost, it is reopened once and the picture is rendered again with the same result; a message goes to stderr.
class Renderer {
  public:
    explicit Renderer(const DeviceChoice& choice = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    const DeviceInfo& device() const;

    /// Sets the volume of the following pictures and frees the resources of the previous one. The next picture uploads
    /// it. If the previous volume is on the device as a whole and both have the same grid and value range, only the box
    /// of changed samples is uploaded and its edges are estimated again (with `edges = cubic` all are). The pictures
    /// are the same as after a full upload. Typical uses: a simulation step, a brush stroke.
    void set_volume(std::shared_ptr<const Volume> volume);

    /// Maximum of device memory to use, bytes; 0: all that the device has. A picture that needs more is refused before
    /// any allocation. The Error lists the memory needed per resource and settings that would fit.
    void set_memory_budget(std::uint64_t bytes);

    /// Maximum time in milliseconds that render() waits for the splats of a volume in blocks. If it is exceeded, the
    /// picture shows a coarser level and RenderStats::complete is false; the following pictures continue the
    /// collection. Default: no limit.
    void set_patience(double milliseconds);

    /// `wanted` is called between the parts of a picture; one part may take tenths of a second on a software device. If
    /// it returns true, render() throws Interrupted, and the splats collected so far are kept. Empty: never.
    void set_interruption(std::function<bool()> wanted);

    /// `report` is called while a picture waits for its splats, with the share of them that has its faces, 0 to 1. It
    /// may throw: then render() does, and the next picture begins again. Empty: never.
    void set_progress(std::function<void(double share)> report);

    /// Enables RenderStats::draw_counts (if the device can count) and dirty_share for the following pictures. Counting
    /// makes frames slower.
    void count_fragments(bool on);

    /// Renders one frame of `width` x `height` pixels (1..16384 each). View-independent work is repeated only when the
    /// volume, the scene's materials or the edge settings have changed.
    RenderResult render(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                        const AovRequest& aovs = {});

    /// Renders the same scene by ray casting the interpolated field, colour only. Of Settings it uses only
    /// `saturation`.
    RenderResult raycast(const Scene& scene, const Camera& camera, const Settings& settings,
                         const RaycastSettings& raycast, int width, int height);

    /// The passes and memory of a request. If no picture of the request exists yet, its splats are counted on the host.
    FrameForecast forecast(const FrameRequest& request);
    /// Changes that make a request fit into memory; each one is sufficient.
    std::vector<FittingChange> fitting_changes(const FrameRequest& request) const;
    /// Bytes of device memory that are allocated now.
    std::uint64_t held_bytes() const;
    /// Bytes that a resource occupies on this device, including the device's alignment.
    std::uint64_t required_bytes(const PlannedResource& resource) const;

    /// Test hook: the next picture behaves as if the device were lost.
    void simulate_device_loss();

    /// Number of validation messages so far; 0 without validation.
    std::uint64_t validation_messages() const;

  private:
    RenderResult render_once(const Scene& scene, const Camera& camera, const Settings& wanted, int width, int height,
                             const AovRequest& aovs);
    RenderResult raycast_once(const Scene& scene, const Camera& camera, const Settings& wanted,
                              const RaycastSettings& raycast, int width, int height);
    /// Calls `draw`; if the device is lost, reopens it and calls `draw` once more.
    RenderResult draw_again_if_lost(const std::function<RenderResult()>& draw);
    std::unique_ptr<RendererState> state_;
};

}  // namespace edgesplat
