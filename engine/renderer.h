// The library's face: a volume, a scene and a camera in, a picture and what it cost out. Needs a Vulkan 1.3 device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/device_info.h"
#include "engine/distribute/part_exchange.h"
#include "engine/error.h"
#include "engine/image/image.h"
#include "engine/scene/frame_request.h"
#include "engine/scene/renderer_kind.h"

namespace edgesplat {

/// How `Renderer::raycast` samples.
struct RaycastSettings {
    double step = 0.5;  ///< voxels between samples along the ray, (0.01, 4]
    RaycastFilter filter = RaycastFilter::Trilinear;
    bool skip_empty = true;  ///< leap over transparent bricks; the picture is the same
};

/// Checks the ranges above. Throws Error naming the field, the value and the range.
void validate(const RaycastSettings& settings);

/// Device memory held under one name.
struct MemoryUse {
    std::string name;
    std::uint64_t bytes = 0;  ///< the most during the frame
};

/// What a frame did and cost.
struct RenderStats {
    DeviceInfo device;
    /// In the frame's order; those of extra outputs as "tau: 5_draw_splats".
    std::vector<PassTime> passes;
    double setup_milliseconds = 0;  ///< upload, estimation, collection: 0 when nothing changed since the last frame
    double frame_milliseconds = 0;  ///< wall clock from submit to finish
    std::uint64_t voxels_estimated = 0;  ///< whose edges were found for this picture, those around blocks among them
    std::uint64_t voxels = 0, splats_collected = 0, splats_drawn = 0, edge_splats = 0;
    std::uint64_t splats_culled = 0;  ///< never looked at: their bricks lie outside the picture, or are hidden
    std::uint32_t sheets = 0, sheet_groups = 0;
    int level = 0;         ///< resolution of the volume that was drawn: voxels of 2^level along each axis
    int wanted_level = 0;  ///< the level it should have had; coarser ones fit into memory
    bool complete = true;  ///< false: a coarser level stands in until the wanted one is there (Renderer::set_patience)
    bool in_blocks = false;          ///< the volume was not on the device as a whole
    std::uint64_t blocks = 0;        ///< that can hold splats
    std::uint64_t blocks_held = 0;   ///< whose splats are on the device
    std::uint64_t device_bytes = 0;  ///< allocated on the device
    std::vector<MemoryUse> memory;   ///< by name, what was let go during the frame included
    std::uint64_t submissions = 0;   ///< lists of commands that the device was given, setup included
    std::uint64_t pipelines_made = 0;
    double pipeline_milliseconds = 0;  ///< spent on making them; part of setup and frame
    /// After Renderer::count_fragments: of the splats of the picture, extra outputs not among them.
    std::optional<DrawCounts> draw_counts;
    /// Likewise: the part of the picture that a sheet group covers with its rectangle, on average.
    std::optional<double> dirty_share;
    std::optional<SheetShare> share;  ///< after Renderer::divide_sheets
    std::uint64_t validation_messages = 0;
};

struct RenderResult {
    Image color;  ///< RGBA; background blended in, so alpha is the volume's own opacity
    std::optional<Image> tau, depth, normal, distance;
    RenderStats stats;
};

/// Where a result has an extra output.
std::optional<Image> RenderResult::*image_of(const Aov& aov);

struct FrameForecast;    // engine/forecast/forecast.h
struct PlannedResource;  // engine/forecast/forecast.h
struct FittingChange;    // engine/forecast/description.h

/// What a Renderer owns (engine/renderer/state.h); of no use to those who embed it.
struct RendererState;

/// Owns the device and everything on it. Not thread-safe; one per thread. Every member throws Error. A device that is
/// lost under a picture is opened anew, which stderr hears of, and the picture is made again, once; it is the same.
class Renderer {
  public:
    explicit Renderer(const DeviceChoice& choice = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    const DeviceInfo& device() const;

    /// The volume of the pictures to come, which the first of them uploads; what is held for the one before is freed.
    /// Where that is on the device as a whole, and this one has its grid and its range of values, and other samples in
    /// a box only (a step of a simulation, a stroke of a brush), no more than that box is uploaded and its edges found
    /// again (but with `edges = cubic`): pictures are the same as if all were.
    void set_volume(std::shared_ptr<const Volume> volume);

    /// The most that may be held on the device, bytes; 0: as much as it has. A picture that needs more is refused
    /// before anything is allocated for it, with what is needed for what, and with what would fit.
    void set_memory_budget(std::uint64_t bytes);

    /// How long render() may wait for splats of a volume of many blocks, milliseconds: one that takes longer shows a
    /// coarser level and says so (RenderStats::complete); those that come after it go on. By default: for ever.
    void set_patience(double milliseconds);

    /// Asked between the parts of a picture, of which some may take tenths of a second on a processor; where it says
    /// true render() throws Interrupted. What was collected till then stays. Empty: never.
    void set_interruption(std::function<bool()> wanted);

    /// Whether RenderStats of pictures to come have draw_counts (where the device can count) and dirty_share. Counted
    /// frames take longer.
    void count_fragments(bool on);

    /// Pictures to come are drawn together with the exchange's other renderers, each some of the sheets; where its part
    /// is not the first, what comes out is of no use. Null: alone.
    void divide_sheets(PartExchange* exchange);

    /// Renders one frame of `width` x `height` pixels (1..16384 each). View-independent work is done again only when
    /// the volume, the scene's materials or the edge settings changed.
    RenderResult render(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                        const AovRequest& aovs = {});

    /// The same scene by casting rays through the field between the samples: colour only. Of Settings it uses
    /// `saturation` alone.
    RenderResult raycast(const Scene& scene, const Camera& camera, const Settings& settings,
                         const RaycastSettings& raycast, int width, int height);

    /// What such a request will run and hold. Without a picture of it yet, its splats are counted on the host.
    FrameForecast forecast(const FrameRequest& request);
    /// Changes to a request that does not fit into the memory, each of which does.
    std::vector<FittingChange> what_fits(const FrameRequest& request) const;
    /// Bytes of device memory held now.
    std::uint64_t held_bytes() const;
    /// What a resource takes of this device, as the device rounds it up.
    std::uint64_t required_bytes(const PlannedResource& resource) const;

    /// The next picture finds its device lost, to see what becomes of it.
    void lose_device();

    /// Validation messages so far; 0 when validation was not asked for.
    std::uint64_t validation_messages() const;

  private:
    RenderResult render_once(const Scene& scene, const Camera& camera, const Settings& wanted, int width, int height,
                             const AovRequest& aovs);
    RenderResult raycast_once(const Scene& scene, const Camera& camera, const Settings& wanted,
                              const RaycastSettings& raycast, int width, int height);
    /// Calls `draw`, a second time on a new device where that was lost.
    RenderResult draw_again_if_lost(const std::function<RenderResult()>& draw);
    std::unique_ptr<RendererState> state_;
};

}  // namespace edgesplat
