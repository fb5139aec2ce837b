// A picture of the splats of a level: passes 3 to 7, once for each payload and sample.
#pragma once

#include "engine/compositors/tiles/hiding.h"
#include "engine/frame/frame.h"
#include "engine/frame/orders.h"
#include "engine/frame/targets.h"
#include "engine/scene/frame_request.h"
#include "engine/store/splat_store.h"

namespace edgesplat {

/// What drawing a picture came to, counted by the device.
struct PictureCounts {
    std::optional<DrawCounts> draws;  ///< where the device can count
    double dirty_share = 0;           ///< of the picture, that a sheet group covers with its rectangle, on average
};

/// What of a level's splats is not looked at. None of it changes a picture.
struct Culling {
    bool bricks = true;  ///< those that lie outside the picture
    /// And those that are hidden, of so many splats in view: selecting and sorting fewer twice takes longer than all
    /// once.
    std::uint64_t least_hiding = std::uint64_t{1} << 16U;
};

/// Throws Error where sheets must be layers of a target, in the picture or in one that a light takes, and the device
/// has no such targets.
void need_layers(const gpu::Device& device, const Scene& scene, const Settings& settings);

/// Throws Error naming a splat that is classified by what is no finite number.
void check_splats(DeviceSession& session, const LevelStore& level);

class PictureDrawer {
  public:
    PictureDrawer(DeviceSession& session, const Orders& orders)
        : session_(&session), orders_(&orders), targets_(session) {}

    void set_culling(const Culling& culling) { culling_ = culling; }
    /// Of a picture that is drawn in parts from blocks: this part's sheets, from the eye on.
    void set_slab(std::optional<glm::ivec2> slab) { slab_ = slab; }

    FramePlan plan(const LevelStore& level, const Scene& scene, const Camera& camera, const Settings& settings,
                   const glm::ivec2& size, std::uint32_t payload) const;
    /// Passes 2c and 2d for the level's splats, if lights of the scene cast shadows and what was found differs; the
    /// targets are dropped then. Whether they ran.
    bool provide_shadows(LevelStore& level, const Scene& scene, const Settings& settings, SetupCost& cost);
    /// Draws what the plan says and waits. With DeviceChoice::check_numbers it throws Error naming the pass and the
    /// splat where something is no finite number: in the list, in the picture.
    void draw(const LevelStore& level, FramePlan plan);
    /// The tiles that the sheets in front of `sheet`, numbered from the eye on, leave open. The targets are dropped.
    OpenTiles open_tiles(const LevelStore& level, const FrameRequest& request, int sheet);

    /// Of the last picture.
    const FramePlan& drawn() const { return plan_; }
    std::span<const glm::vec4> pixels() const { return targets_.pixels(plan_); }
    const std::vector<PassTime>& times() const { return times_; }
    std::uint32_t splats_drawn() const { return targets_.resources().drawn.mapped<std::uint32_t>(1)[0]; }
    PictureCounts counts() const;
    /// Of all pictures since begin_share().
    const SheetShare& share() const { return share_; }
    void begin_share() { share_ = {}; }

    Targets& targets() { return targets_; }

  private:
    /// provide_shadows() of a scene with such lights.
    bool cast_shadows(LevelStore& level, const Scene& scene, const Settings& settings, SetupCost& cost);
    void draw_planned(const LevelStore& level);
    /// What follows the sort of a tiled picture.
    void draw_chunks(const Chunks& chunks, const passes::TileDraw& how);
    /// A tiled picture in two parts, the second without bricks that the first one hides; false where that saves
    /// nothing, and nothing is drawn.
    bool draw_front_first(const LevelStore& level, const passes::TileDraw& how);

    void check_picture(const LevelStore& level);

    /// Of a tiled picture, the part that the exchange says; with the first part, the whole is left in the targets.
    void draw_part(passes::TileDraw how);
    /// Whether the whole picture is refined: what a part knows of its splats is its own.
    bool parts_refine(const Chunks& own);
    /// This part's pixels of a step; the whole ones with the first part.
    std::vector<glm::vec4> draw_part_step(passes::TileDraw how, std::uint32_t chunks, std::uint32_t step,
                                          std::vector<bool>& reached);
    /// After a step: the first part fills in what follows, and says which pixels all are to draw next.
    /// `reached`: tiles that what is in front leaves open.
    void share_pixels(std::uint32_t step, const std::vector<bool>& reached, std::span<glm::vec4> whole);

    DeviceSession* session_;
    const Orders* orders_;
    Targets targets_;
    Culling culling_;
    std::optional<glm::ivec2> slab_;
    FramePlan plan_;
    std::uint32_t foreseen_ = 0;  ///< chunks of the next picture; 0: nothing is known
    std::vector<PassTime> times_;
    SheetShare share_;
};

}  // namespace edgesplat
