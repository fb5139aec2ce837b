// Sees to it that the device holds the splats of a picture: at the finest level of the volume whose splats fit, as a
// whole or in blocks.
#pragma once

#include "engine/forecast/memory.h"
#include "engine/frame/picture.h"
#include "engine/raycast/raycast.h"
#include "engine/renderer.h"
#include "engine/store/blocks.h"
#include "engine/store/volume_levels.h"

namespace edgesplat {

class SplatProvider {
  public:
    /// `rays`: what the ray caster keeps of the volume, which goes with it.
    SplatProvider(DeviceSession& session, const Orders& orders, PictureDrawer& drawer,
                  std::optional<RaycastResources>& rays);

    /// Null: none. What is held of the one before goes, or most of it stays, where the two differ in a box at most.
    void set_volume(std::shared_ptr<const Volume> volume);
    const std::shared_ptr<const Volume>& original() const { return levels_.original(); }
    /// What pictures are made of.
    const LevelStore& level() const { return shown_; }

    /// The splats that a picture takes, or those of a coarser level while they are on their way. Throws Error.
    void provide(const FrameRequest& request, RenderStats& stats);
    /// The volume itself as a whole, for rays; with the spline through its samples. Whether anything was missing.
    bool provide_volume(bool coefficients);
    /// Frees what pictures with these settings do not use.
    void release_unused(const Settings& drawn);

    /// The splats that are collected, if they are those of the plan.
    std::optional<SplatCount> collected_splats(const CollectionPlan& wanted) const;
    /// After the memory budget was changed.
    void forget_checked() { checked_.clear(); }

  private:
    /// What became of the splats that a picture takes.
    enum class Gathered { All, Unfinished, TooMany };

    bool take_changes(const std::shared_ptr<const Volume>& next);
    void use_level(int level);
    void hold_in_blocks(bool blocks);
    /// Level, and whether the device holds the volume whole, for a picture; `request.volume` is that level's then.
    /// Throws Error if nothing fits into the device's memory.
    void settle(FrameRequest& request, int finest);
    Gathered provide_level(FrameRequest request, int finest, double patience, RenderStats& stats);

    /// What a request takes of the device's memory, if it does not fit with the volume as a whole.
    std::optional<MemoryNeed> beyond_memory(const FrameRequest& request);
    /// The most splats that fit if the volume is held block by block; nothing if not even none do.
    std::optional<std::uint64_t> most_splats_in_blocks(const FrameRequest& request) const;

    /// Passes 1 to 2d, of the volume as a whole. Milliseconds, 0 where none ran.
    double provide_whole(const FrameRequest& request);
    /// Passes 1 to 2d block by block.
    Gathered collect_in_blocks(const FrameRequest& request, double patience, double& milliseconds);
    /// Passes 1 and 2 for the blocks that a picture shows, a block at least, and no more once `patience` milliseconds
    /// are over; blocks that it does not show are dropped where there is no room.
    Gathered collect_blocks(const FrameRequest& request, const CollectionPlan& wanted, std::uint64_t most_splats,
                            double patience);
    /// The same for those of the blocks `needed` that are missing.
    Gathered collect_missing(const FrameRequest& request, const std::vector<std::size_t>& needed,
                             std::vector<std::size_t> missing, std::uint64_t most_splats, double patience);
    /// The blocks of a picture by number; of one that is drawn in parts, those of this part's slab.
    std::vector<std::size_t> blocks_shown(const FrameRequest& request);
    /// Whether blocks that cannot be seen can be left unread.
    bool may_hide_blocks(const FrameRequest& request) const;
    /// Those first that may show nearest to the eye.
    void sort_by_depth(const FrameRequest& request, std::vector<std::size_t>& blocks) const;
    /// Draws the splats in front of the missing blocks from number `first` on, and drops those of them that these
    /// splats hide in every pixel.
    void leave_hidden_blocks(const FrameRequest& request, std::vector<std::size_t>& missing, std::size_t first);

    /// Whether all that draw parts of a picture have the volume at the same level; else `finest` is where they may.
    bool agree_on_level(int& finest);
    /// Whether a part of the picture has too many splats; if none has, the box becomes that of all parts' splats.
    bool too_many_somewhere(Gathered gathered);

    DeviceSession* session_;
    const Orders* orders_;
    PictureDrawer* drawer_;
    std::optional<RaycastResources>* rays_;
    VolumeLevels levels_;
    LevelStore shown_;
    LevelStore other_;             ///< a level on its way while a coarser one is shown; empty: none
    SetupCost cost_;               ///< of the picture being provided
    bool divides_blocks_ = false;  ///< all that draw parts of the picture hold the volume block by block
    std::vector<std::pair<std::string, std::uint64_t>> checked_;  ///< resources that were last asked for
    std::optional<MemoryNeed> checked_need_;                      ///< what beyond_memory found of them
};

}  // namespace edgesplat
