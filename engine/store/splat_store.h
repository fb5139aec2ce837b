// The splats of a volume on the device: passes 1 to 2b, view-independent, for the volume as a whole or block by block.
#pragma once

#include <future>
#include <optional>

#include "engine/passes/1_estimate_edges.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/store/light.h"
#include "engine/store/volume_store.h"
#include "engine/volume/sample_source.h"

namespace edgesplat {

/// What passes 1b and 1c are given, and pass 2 for the whole volume.
passes::EstimateEdges estimate_inputs(const CollectionPlan& plan);
passes::CollectSplats collect_inputs(const CollectionPlan& plan);

/// What finding the splats of a picture came to.
struct SetupCost {
    std::vector<PassTime> times;
    std::uint64_t voxels_estimated = 0;  ///< whose edges were found, those around blocks among them
};

/// Splats that a block added to the list.
struct CollectedBlock {
    std::uint64_t first = 0, count = 0, with_edge = 0, with_crease = 0;
    glm::ivec3 low{0}, high{0};      ///< inclusive box that holds their voxels; the whole block without splats
    std::vector<SplatBrick> bricks;  ///< counted from `first`
};

/// Blocks of a volume whose splats are in a list.
struct ResidentBlocks {
    std::shared_ptr<const SampleSource> source;
    std::vector<CollectionBlock> blocks;              ///< those that can hold splats
    std::vector<std::optional<CollectedBlock>> held;  ///< likewise; nothing: not in the list
    std::size_t being_read = 0;
    std::future<std::vector<float>> samples;  ///< of that block, scaled; invalid: none is being read
};

class SplatStore {
  public:
    explicit SplatStore(DeviceSession& session) : session_(&session) {}

    const SplatLists& lists() const { return lists_; }
    /// What the list was made with, and the shadows on it; nothing where it is to be made.
    const std::optional<CollectionPlan>& collected() const { return collected_; }
    const std::optional<ShadowPlan>& shadowed() const { return shadowed_; }
    /// Drops everything.
    void drop();
    /// Passes find these lists and the volume's images from the next run on.
    void bind(const VolumeStore& volume) const;

    /// Passes 1 and 2, if the plan differs from what the list was made with or samples do. Whether they ran.
    bool collect(VolumeStore& volume, const CollectionPlan& wanted, SetupCost& cost);
    /// Pass 2b, if the scene calls for it and what was found differs. Whether it ran.
    bool occlude(const VolumeStore& volume, const Scene& scene, SetupCost& cost);
    void drop_shadows();
    /// Splats that no shadow falls on; the passes that find those add them to `lists().shadows`, and say so at the end.
    void begin_shadows();
    void end_shadows(const ShadowPlan& plan) { shadowed_ = plan; }

    /// Of a volume that is held in blocks: makes the list anew, empty, for what comes from `source`.
    void begin_blocks(VolumeStore& volume, std::shared_ptr<const SampleSource> source, const CollectionPlan& wanted);
    bool has_blocks() const { return residence_.has_value(); }
    /// Those that can hold splats.
    std::span<const CollectionBlock> blocks() const { return residence_->blocks; }
    /// Whether the block's splats are in the list.
    bool holds(std::size_t block) const { return residence_->held[block].has_value(); }
    std::uint64_t blocks_held() const;
    /// What light reaches splats is not known once others come.
    void forget_light();
    /// Passes 1 and 2 for a block; the one after it is read meanwhile. Blocks that are not `needed`, which ascend, are
    /// dropped where there is no room. Whether there was room among `most_splats`.
    bool add_block(VolumeStore& volume, std::size_t block, std::optional<std::size_t> after,
                   std::span<const std::size_t> needed, std::uint64_t most_splats, SetupCost& cost);
    /// Drops the splats of blocks that are not among those `needed`: whether there were any. With `shrink` the list is
    /// no longer than its splats afterwards, in any case.
    bool drop_blocks(std::span<const std::size_t> needed, bool shrink);
    /// After blocks came: the box of the splats that are in the list, and its bricks.
    void bound_blocks(const VolumeStore& volume);
    /// A box around the splats of other parts of the picture, too.
    void widen_box(const glm::ivec3& low, const glm::ivec3& high);
    /// How many splats the list has room for.
    std::uint64_t room() const { return lists_.splats ? lists_.splats.bytes() / sizeof(shader::Splat) : 0; }

  private:
    void collect_anew(VolumeStore& volume, const CollectionPlan& wanted, SetupCost& cost);
    void collect_changes(VolumeStore& volume, SetupCost& cost);
    /// Allocates what the plan's passes take for blocks as large as `largest`, and drops the splats that there were.
    void prepare(const CollectionPlan& plan, const CollectionBlock& largest);
    void clear_counts();
    /// Room for `count` splats in all.
    void reserve(const CollectionPlan& plan, std::uint64_t count);
    /// Points the passes at a block. What is known of the lists stays.
    void place_block(const CollectionPlan& plan, const CollectionBlock& block);
    void mark_block(const CollectionPlan& plan, const CollectionBlock& block);
    void count_block(const passes::CollectSplats& collect);
    /// Slices' counts to places in the list; notes the bricks, and the box of what holds splats.
    void scan_runs(const CollectionBlock& block, CollectedBlock& collected);
    /// After its edges were found and its splats counted: the block's splats, behind those in the list. With `exact`
    /// the list is made as long as it has to be, else longer, for those to come. Nothing, and nothing changed, if the
    /// list would be longer than `most_splats`.
    std::optional<CollectedBlock> list_block(const CollectionPlan& plan, const CollectionBlock& block, bool exact,
                                             std::uint64_t most_splats, SetupCost& cost);
    /// Volume -> splats, behind those in the list. The images hold the block's samples (and coefficients).
    std::optional<CollectedBlock> collect_block(const CollectionPlan& plan, const CollectionBlock& block, bool exact,
                                                std::uint64_t most_splats, SetupCost& cost);
    /// The list is of this block alone.
    void hold_list(CollectedBlock& collected);
    std::vector<float> read_block(const VolumeStore& volume, std::size_t block, std::optional<std::size_t> after);
    void index_blocks();

    DeviceSession* session_;
    SplatLists lists_;
    std::optional<CollectionPlan> collected_;
    std::optional<OcclusionPlan> occluded_;  ///< what the splats' ambient light was found with
    std::optional<ShadowPlan> shadowed_;
    std::optional<ResidentBlocks> residence_;  ///< while the volume is held in blocks
};

/// One resolution of a volume, and the splats collected from it.
struct LevelStore {
    explicit LevelStore(DeviceSession& session) : volume(session), splats(session) {}

    /// Of a volume that is held as a whole: passes 1 to 2b, as far as the scene calls for them and what is there
    /// differs. Whether any ran.
    bool provide(const Scene& scene, const Settings& settings, bool keep_buried, SetupCost& cost);

    VolumeStore volume;
    SplatStore splats;
};

}  // namespace edgesplat
