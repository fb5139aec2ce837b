// Draws pictures of a level's splats: passes 3 to 7, once for each payload and sample.
#pragma once

#include "engine/frame/frame.h"
#include "engine/frame/render_options.h"
#include "engine/frame/targets.h"
#include "engine/frame/tiles/hiding.h"
#include "engine/scene/frame_request.h"
#include "engine/store/splat_store.h"

namespace edgesplat {

/// Counts of the last picture, by the device.
struct PictureCounts {
    std::optional<DrawCounts> draws;  ///< nullopt if the device cannot count
    double dirty_share = 0;           ///< mean share of the picture that a sheet (tiles) or sheet group (layers) covers
};

/// A part of a picture: the splats of a volume, and its plan.
struct PicturePart {
    CollectedSplats list;
    FramePlan plan;
};

/// Which splats of a level are culled. Does not change pictures.
struct Culling {
    bool bricks = true;  ///< culls bricks outside the picture
    /// Occluded bricks are culled, too, if at least this many splats are in view: with fewer, selecting and sorting in
    /// two parts takes longer than all at once.
    std::uint64_t min_splats_to_hide = std::uint64_t{1} << 16U;
};

/// Throws Error if the picture needs sheets as layers of a target and the device cannot do that.
void need_layers(const gpu::Device& device, const Scene& scene, const Settings& settings);

/// Throws Error naming a splat whose classified value is not finite.
void check_splats(DeviceSession& session, const CollectedSplats& list);

class PictureDrawer {
  public:
    PictureDrawer(DeviceSession& session, const RenderOptions& options)
        : session_(&session), options_(&options), targets_(session) {}

    void set_culling(const Culling& culling) { culling_ = culling; }

    FramePlan plan(const CollectedSplats& splats, const Scene& scene, const Camera& camera, const Settings& settings,
                   const glm::ivec2& size, std::uint32_t payload) const;
    /// Draws the plan and waits. With DeviceChoice::check_numbers it throws Error naming the pass and the splat if a
    /// number in the splat list or the picture is not finite.
    void draw(const CollectedSplats& splats, FramePlan plan);
    /// The same for several parts: surface splats of a mixture or of several volumes, one after another, then all
    /// kernels as one list, in front of those surfaces. Times, counts and numbers of splats are of all parts.
    void draw_parts(std::vector<PicturePart> parts, bool several_volumes);
    /// The tiles that the sheets in front of `sheet` (numbered from the eye on) leave unsaturated. Frees the targets.
    OpenTiles open_tiles(const LevelStore& level, const FrameRequest& request, int sheet);

    /// The plan of the last picture.
    const FramePlan& drawn() const { return plan_; }
    /// Of the last picture.
    std::uint64_t splats_examined() const { return examined_; }
    std::span<const glm::vec4> pixels() const { return targets_.pixels(plan_); }
    const std::vector<PassTime>& times() const { return times_; }
    std::uint32_t splats_drawn() const {
        return drawn_before_ + targets_.resources().drawn.mapped<std::uint32_t>(1)[0];
    }
    PictureCounts counts() const;

    Targets& targets() { return targets_; }

  private:
    /// `lists`: of the plan's volumes.
    void draw_lists(std::vector<CollectedSplats> lists, FramePlan plan);
    void draw_planned();
    void provide_targets();
    /// Draws a tiled picture after the sort.
    void draw_chunks(const Chunks& chunks, const passes::TileDraw& how);
    /// Draws a tiled picture in two parts, the second without the bricks that the first one occludes. Returns false
    /// and draws nothing if that saves no time.
    bool draw_front_first(const passes::TileDraw& how);

    void check_picture();

    DeviceSession* session_;
    const RenderOptions* options_;
    Targets targets_;
    Culling culling_;
    FramePlan plan_;
    std::vector<CollectedSplats> lists_;  ///< of the plan's volumes
    std::vector<FramePlan> beside_;       ///< the plans of all parts of the picture, if it has several
    std::uint64_t examined_ = 0;
    std::uint32_t drawn_before_ = 0;  ///< of the parts before the last, and their counts
    PictureCounts counts_before_;
    /// expected number of chunks of the next picture, of kernels and of surface splats; 0: unknown
    std::array<std::uint32_t, 2> expected_chunks_{};
    std::vector<PassTime> times_;
};

}  // namespace edgesplat
