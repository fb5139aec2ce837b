// Keeps a picture's splats on the device, at the finest level of the volume whose splats fit: from the whole volume or
// block by block.
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
    /// `rays`: the ray caster's resources, which are freed with the volume.
    SplatProvider(DeviceSession& session, const RenderOptions& options, PictureDrawer& drawer,
                  std::optional<RaycastResources>& rays);

    /// Null: no volume. Frees the last volume's resources, or keeps most of them if the new volume differs only in a
    /// box.
    void set_volume(std::shared_ptr<const Volume> volume);
    const std::shared_ptr<const Volume>& original() const { return levels_.original(); }
    /// The level that pictures show.
    const LevelStore& level() const { return shown_; }
    /// The same of one of several volumes (FrameRequest::number).
    const LevelStore& level(std::size_t number) const { return number == 0 ? shown_ : added_[number - 1].shown; }
    /// The splats of a part of a picture.
    CollectedSplats list_of(const FrameRequest& part) const {
        return part.mixed && !part.whole ? level(part.number).opaque() : level(part.number).all();
    }

    /// Provides a picture's splats, or those of a coarser level while they are still being collected. Throws Error.
    void provide(const FrameRequest& request, RenderStats& stats);
    /// Uploads the whole volume for ray casting; with `coefficients` also its spline. Returns whether any were missing.
    bool provide_volume(bool coefficients);
    /// Uploads the labels of that volume. Returns whether they were missing.
    bool provide_labels() { return shown_.volume.provide_labels(); }
    /// Frees resources that pictures with these settings do not use.
    void release_unused(const Settings& drawn);

    /// The collected splats of a part; nullopt if they are not those of the plan.
    std::optional<SplatCount> collected_splats(const FrameRequest& part, const CollectionPlan& wanted) const;
    /// Sets the volumes of a request to the levels that pictures show.
    void show_levels(FrameRequest& request) const;
    /// Forgets the last memory check; call after the memory budget changed.
    void forget_checked() { checked_.clear(); }

  private:
    /// Result of collecting a picture's splats.
    enum class Gathered { All, Unfinished, TooMany };

    /// A volume beside the first one.
    struct Added {
        explicit Added(DeviceSession& session) : shown(session) {}
        VolumeLevels levels;
        LevelStore shown;
    };

    bool take_changes(const std::shared_ptr<const Volume>& next);
    /// Holds the scene's added volumes, each at the level that its size in the picture requires, and no others.
    void hold_added(const FrameRequest& request);
    void use_level(int level);
    void hold_in_blocks(bool blocks);
    /// Selects the level `finest`, and whether it is on the device as a whole or in blocks. Sets `request.volume` to
    /// the level. Throws Error if neither fits into the device's memory.
    void settle(FrameRequest& request, int finest);
    Gathered provide_level(FrameRequest request, int finest, double patience, RenderStats& stats);

    /// The memory that a request needs with the volume as a whole; nullopt if it fits.
    std::optional<MemoryNeed> memory_shortfall(const FrameRequest& request);
    /// Maximum number of splats that fit with the volume in blocks; nullopt if not even 0 splats fit.
    std::optional<std::uint64_t> most_splats_in_blocks(const FrameRequest& request) const;

    /// Runs passes 1 to 2d for the volumes as a whole. Returns the time in ms, 0 if none ran.
    double provide_undivided(const FrameRequest& request);
    /// Runs passes 1 to 2d block by block.
    Gathered collect_in_blocks(const FrameRequest& request, double patience, double& milliseconds);
    /// Runs passes 1 and 2 for the blocks that a picture shows: at least one block, then until `patience` milliseconds
    /// are over. Without room, blocks that it does not show are dropped.
    Gathered collect_blocks(const FrameRequest& request, const CollectionPlan& wanted, std::uint64_t most_splats,
                            double patience);
    /// The same for the blocks in `missing`, a subset of `needed`.
    Gathered collect_missing(const FrameRequest& request, const std::vector<std::size_t>& needed,
                             std::vector<std::size_t> missing, std::uint64_t most_splats, double patience);
    /// Numbers of the blocks that a picture shows.
    std::vector<std::size_t> blocks_shown(const FrameRequest& request) const;
    /// Whether occluded blocks need not be read.
    bool can_skip_hidden_blocks(const FrameRequest& request) const;
    /// Sorts blocks by their first sheet, nearest to the eye first.
    void sort_by_depth(const FrameRequest& request, std::vector<std::size_t>& blocks) const;
    /// Draws the splats in front of the missing blocks from index `first` on; removes the blocks from `missing` that
    /// are occluded in every pixel.
    void skip_hidden_blocks(const FrameRequest& request, std::vector<std::size_t>& missing, std::size_t first);

    DeviceSession* session_;
    const RenderOptions* options_;
    PictureDrawer* drawer_;
    std::optional<RaycastResources>* rays_;
    VolumeLevels levels_;
    LevelStore shown_;
    std::vector<Added> added_;  ///< in the order of the scene
    LevelStore other_;          ///< a level being collected while a coarser one is shown; empty: none
    SetupCost cost_;            ///< of the picture being provided
    std::vector<std::pair<std::string, std::uint64_t>> checked_;  ///< resources of the last memory check
    std::optional<MemoryNeed> checked_need_;                      ///< memory_shortfall()'s result for them
};

}  // namespace edgesplat
