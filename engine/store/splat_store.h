// Keeps a volume's splats on the device: runs passes 1 to 2c, which are view-independent, for the whole volume or block
// by block.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <optional>

#include "engine/passes/1_estimate_edges.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/store/kept_splats.h"
#include "engine/store/light.h"
#include "engine/store/volume_store.h"
#include "engine/volume/sample_source.h"

namespace edgesplat {

/// Inputs of pass 1b, and of pass 2 for the whole volume.
passes::EstimateEdges estimate_inputs(const CollectionPlan& plan);
passes::CollectSplats collect_inputs(const CollectionPlan& plan);

/// Cost of collecting a picture's splats.
struct SetupCost {
    std::vector<PassTime> times;
    std::uint64_t voxels_estimated = 0;          ///< voxels whose edges were estimated, including the borders of blocks
    std::function<void(double share)> progress;  ///< called with the share of a list that has its faces; empty: never
    std::filesystem::path kept;                  ///< folder of kept lists; empty: none (kept_splats.h)
    bool read = false;                           ///< the list is one of them
};

/// The part of the list that a block added.
struct CollectedBlock {
    std::uint64_t first = 0, count = 0, with_edge = 0, with_crease = 0;
    glm::ivec3 low{0}, high{0};      ///< inclusive bounding box of their voxels; the block's core without splats
    std::vector<SplatBrick> bricks;  ///< their `first` is relative to this `first`
};

/// Blocks of a volume, with those whose splats are in the list.
struct ResidentBlocks {
    std::shared_ptr<const SampleSource> source;
    std::vector<CollectionBlock> blocks;              ///< blocks that can have splats
    std::vector<std::optional<CollectedBlock>> held;  ///< by block; nullopt: not in the list
    std::size_t being_read = 0;
    std::future<std::vector<float>> samples;  ///< scaled samples of block `being_read`; invalid if none is being read
};

struct LevelStore;

/// A volume whose matter attenuates light, with the scene of that matter.
struct LitVolume {
    LevelStore* level;
    Scene scene;
};

class SplatStore {
  public:
    explicit SplatStore(DeviceSession& session) : session_(&session) {}

    const SplatLists& lists() const { return lists_; }
    /// The plan of the present list; nullopt if it must be computed.
    const std::optional<CollectionPlan>& collected() const { return collected_; }
    /// Frees everything.
    void drop();
    /// Binds these lists and the volume's images for the next runs.
    void bind(const VolumeStore& volume) const;

    /// Runs those of passes 1 and 2 whose inputs changed since they last ran. Returns whether any ran.
    bool collect(VolumeStore& volume, const CollectionPlan& wanted, SetupCost& cost);
    /// Replaces the transfer function by that of a plan for the same lists.
    void classify(const CollectionPlan& wanted);
    /// Runs passes 2b and 2c if the scene needs them and their plans changed: light among all of the matter of the
    /// scene, which is that of `volume`, also such that the splats do not show; and among that of other volumes.
    /// Returns whether any ran.
    bool light(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside, SetupCost& cost);

    /// For a volume in blocks: starts an empty list; blocks will be read from `source`.
    void begin_blocks(VolumeStore& volume, std::shared_ptr<const SampleSource> source, const CollectionPlan& wanted);
    bool has_blocks() const { return residence_.has_value(); }
    /// Blocks that can have splats.
    std::span<const CollectionBlock> blocks() const { return residence_->blocks; }
    /// Whether the block's splats are in the list.
    bool holds(std::size_t block) const { return residence_->held[block].has_value(); }
    std::uint64_t blocks_held() const;
    /// Invalidates occlusion and shadows; call before splats are added.
    void forget_light();
    /// Frees the fields that the list was collected from. Another list then estimates them again.
    void release_fields() {
        lists_.edges = {};
        lists_.buried = {};
    }
    /// Runs passes 1 and 2 for a block while block `after` is read. Without room, blocks that are not `needed`
    /// (ascending) are dropped. Returns false if the list would still exceed `most_splats`.
    bool add_block(VolumeStore& volume, std::size_t block, std::optional<std::size_t> after,
                   std::span<const std::size_t> needed, std::uint64_t most_splats, SetupCost& cost);
    /// Drops the splats of blocks that are not `needed`. Returns false if there were none and `shrink` is false. With
    /// `shrink` the list is always reallocated to the length of its splats.
    bool drop_blocks(std::span<const std::size_t> needed, bool shrink);
    /// Updates the list's bounding box and bricks; call after blocks were added.
    void bound_blocks(const VolumeStore& volume);
    /// Number of splats that the list has room for.
    std::uint64_t room() const { return lists_.splats ? lists_.splats.bytes() / sizeof(shader::Splat) : 0; }

  private:
    bool occlude(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside, SetupCost& cost);
    bool cast_shadows(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside,
                      SetupCost& cost);
    void recollect(VolumeStore& volume, const CollectionPlan& wanted, const StaleResults& stale, SetupCost& cost);
    void collect_changes(VolumeStore& volume, SetupCost& cost);
    /// Drops all splats and everything stale; allocates the resources of the plan's passes for blocks as large as
    /// `largest`.
    void prepare(const CollectionPlan& plan, const CollectionBlock& largest, const StaleResults& stale = {});
    void clear_counts();
    /// Reallocates the lists for `count` splats in total.
    void reserve(const CollectionPlan& plan, std::uint64_t count);
    /// Writes the passes' parameters for a block. The lists' addresses stay.
    void place_block(const CollectionPlan& plan, const CollectionBlock& block);
    /// Lists the bricks that passes 1b and 2 process, if the plan needs a list.
    void list_bricks(const CollectionPlan& plan, VolumeStore& volume);
    passes::CollectSplats block_inputs(const CollectionPlan& plan, const CollectionBlock& block) const;
    void mark_block(const CollectionPlan& plan, const CollectionBlock& block);
    void count_block(const passes::CollectSplats& collect);
    /// Turns the runs' counts into offsets in the list; records the bricks and their bounding box.
    void scan_runs(const CollectionBlock& block, CollectedBlock& collected);
    /// Appends the block's splats to the list, after its edges are estimated and its splats counted. With `exact` the
    /// list gets exactly the length needed, else room to grow. Returns nullopt without changing the list if it would
    /// exceed `most_splats`.
    std::optional<CollectedBlock> list_block(const CollectionPlan& plan, const CollectionBlock& block, bool exact,
                                             std::uint64_t most_splats, SetupCost& cost);
    /// Runs passes 1, as far as they are stale, and 2 for a block and appends its splats. The images must have the
    /// block's samples (and coefficients).
    std::optional<CollectedBlock> collect_block(const CollectionPlan& plan, const CollectionBlock& block, bool exact,
                                                std::uint64_t most_splats, SetupCost& cost,
                                                const StaleResults& stale = {});
    /// Whether the edges and the mask that the plan needs are on the device. They are not if the list was read.
    bool holds_fields(const CollectionPlan& plan) const;
    /// The list as a file keeps it.
    KeptSplats kept_list(const CollectionPlan& plan) const;
    /// Makes it the list; edges and mask, on which it depends, are not on the device then.
    void take_kept(const CollectionPlan& plan, KeptSplats kept);
    /// Sets the list's bounding box and bricks to those of its only block.
    void hold_list(CollectedBlock& collected);
    std::vector<float> read_block(const VolumeStore& volume, std::size_t block, std::optional<std::size_t> after);
    void index_blocks();

    DeviceSession* session_;
    SplatLists lists_;
    std::uint32_t bricks_listed_ = 0;  ///< SceneParams::brick_count
    std::optional<CollectionPlan> collected_;
    std::optional<OcclusionPlan> occluded_;    ///< plan of the stored ambient occlusion
    std::optional<ShadowPlan> shadowed_;       ///< and shadows
    std::optional<ResidentBlocks> residence_;  ///< set if the volume is in blocks
};

/// Splats, and the volume from which they were collected.
struct CollectedSplats {
    const VolumeStore& volume;
    const SplatStore& splats;
};

/// One resolution of a volume, and the splats collected from it.
struct LevelStore {
    explicit LevelStore(DeviceSession& session) : volume(session), splats(session), surfaces(session) {}

    CollectedSplats all() const { return {volume, splats}; }
    /// Of a mixture: the opaque matter. all() is its translucent matter.
    CollectedSplats opaque() const { return {volume, surfaces}; }
    /// Frees all splats.
    void drop_splats();

    /// For a volume as a whole: runs those of passes 1 to 2a that a picture needs and whose inputs changed. `opaque`:
    /// of a mixture's opaque matter, else null. Returns whether any ran.
    bool provide(const CollectionPlan& plan, const CollectionPlan* opaque, SetupCost& cost);

    VolumeStore volume;
    SplatStore splats;
    SplatStore surfaces;  ///< only of a mixture
};

/// Finds the light that reaches the splats of a picture's volumes (SplatStore::light); all must be provided. The result
/// does not depend on their order. Returns whether any pass ran.
bool light_volumes(std::span<const LitVolume> volumes, SetupCost& cost);

}  // namespace edgesplat
