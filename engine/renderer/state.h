// What a Renderer owns. Tests of single passes look in here; embedders do not.
#pragma once

#include <chrono>
#include <future>
#include <limits>
#include <optional>

#include "engine/compositors/tiles/chunks.h"
#include "engine/forecast/memory.h"
#include "engine/frame/frame.h"
#include "engine/raycast/raycast.h"
#include "engine/renderer.h"
#include "engine/store/blocks.h"
#include "engine/store/light.h"
#include "footprints/cache_folder.h"

namespace edgesplat {

using Clock = std::chrono::steady_clock;
inline double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Blocks of a volume whose splats are in the list.
struct Residence {
    std::shared_ptr<const SampleSource> source;
    std::vector<CollectionBlock> blocks;              ///< those that can hold splats
    std::vector<std::optional<CollectedBlock>> held;  ///< likewise; nothing: not in the list
    std::size_t being_read = 0;
    std::future<std::vector<float>> samples;  ///< of that block, scaled; invalid: none is being read
};

/// One resolution of a volume and the splats collected from it.
struct SplatSet {
    std::shared_ptr<const Volume> volume;  ///< in blocks perhaps without samples
    int level = 0;
    bool in_blocks = false;              ///< the device holds the volume block by block
    std::optional<Residence> residence;  ///< while it does
    VolumeResources volume_resources;
    std::optional<CollectionPlan> collected;  ///< what the splat list was made with
    std::optional<OcclusionPlan> occluded;    ///< what the splats' ambient light was found with
    std::optional<ShadowPlan> shadowed;       ///< what their shadows were found with
    std::optional<VoxelBox> changed;          ///< samples that are others since; a volume that is held as a whole
};

/// What became of the splats that a picture takes.
enum class Gathered { All, Unfinished, TooMany };

/// What outlives everything else on the device.
struct DeviceState {
    explicit DeviceState(const DeviceChoice& choice) : device(choice) {}

    gpu::Device device;
    gpu::Pipelines pipelines{device, cache_folder()};
    Bindings bindings{device, pipelines};
    gpu::Commands commands{device, pipelines, bindings.set()};
};

struct RendererState : DeviceState, SplatSet {
    explicit RendererState(const DeviceChoice& choice);

    /// Draws the volume at one of its resolutions from now on.
    void use_level(int wanted);
    /// Level, and whether the device holds the volume whole, for a picture; `request.volume` is that level's then.
    /// Throws Error if nothing fits into the device's memory.
    void settle(FrameRequest& request, int finest, bool blocks_wanted);
    /// The most splats that fit if the volume is held block by block; nothing if not even none do.
    std::optional<std::uint64_t> most_splats_in_blocks(const FrameRequest& request);
    /// Passes 1 and 2 for the blocks that a picture shows, a block at least, and no more once `patience` milliseconds
    /// are over; blocks that it does not show are dropped where there is no room.
    Gathered collect_blocks(const FrameRequest& request, const CollectionPlan& wanted, std::uint64_t most_splats,
                            double patience);
    /// The same for those of the blocks `needed` that are missing.
    Gathered collect_missing(const FrameRequest& request, const CollectionPlan& wanted,
                             const std::vector<std::size_t>& needed, std::vector<std::size_t> missing,
                             std::uint64_t most_splats, double patience);
    /// Makes the list anew for a plan: empty, with what may come into it.
    void begin_blocks(const CollectionPlan& wanted);
    /// The blocks of a picture by number; of one that is drawn in parts, those of this part's slab.
    std::vector<std::size_t> blocks_shown(const FrameRequest& request);
    /// Whether all that draw parts of a picture have the volume at the same level; else `finest` is where they may.
    bool agree_on_level(int& finest);
    /// Whether a part of the picture has too many splats; if none has, the box becomes that of all parts' splats.
    bool too_many_somewhere(Gathered gathered);
    /// Whether blocks that cannot be seen can be left unread.
    bool may_hide_blocks(const FrameRequest& request) const;
    /// Those first that may show nearest to the eye.
    void sort_by_depth(const FrameRequest& request, std::vector<std::size_t>& blocks) const;
    /// Sorts the missing blocks from number `first` on by depth, draws the splats in front of them, and drops the
    /// blocks that these splats hide in every pixel.
    void leave_hidden_blocks(const FrameRequest& request, std::vector<std::size_t>& missing, std::size_t first);
    /// The box of the splats that are in the list.
    void bound_held_blocks();
    /// The bricks of the list, from its blocks'.
    void index_held_blocks();
    /// Frees what pictures are drawn into; collecting uses the bindings.
    void release_for_collection();
    std::vector<float> read_block(const std::vector<std::size_t>& missing, std::size_t number);
    /// Goes to the other set, which holds a coarser level while a finer one is on its way.
    void exchange_sets() { std::swap(static_cast<SplatSet&>(*this), other); }
    /// Level 0 as a whole from now on.
    void show_whole();
    void hold_in_blocks(bool blocks);
    void load_block(const CollectionBlock& block, std::span<const float> samples);
    /// Drops the splats of blocks that are not among those `needed`: whether there were any. With `shrink` the list is
    /// no longer than its splats afterwards, in any case.
    bool drop_blocks(const std::vector<std::size_t>& needed, bool shrink);

    /// The splats that a picture takes, at the finest level whose splats fit, or of a coarser one while those are on
    /// their way.
    void provide_splats(const FrameRequest& request, RenderStats& stats);
    Gathered provide_level(FrameRequest request, int finest, double patience, RenderStats& stats);
    /// Passes 1 and 2, if the plan differs from what the splat list was made with, and what the scene calls for of
    /// passes 2b to 2d. Milliseconds spent.
    double collect(const Scene& scene, const Settings& settings, bool keep_buried);
    /// The same block by block.
    Gathered collect_in_blocks(const FrameRequest& request, double patience, double& milliseconds);
    void collect_anew(const CollectionPlan& wanted);
    /// The same where only samples in `changed` are others than those that it was done with.
    void collect_changes();
    /// Goes on with a volume that differs from the present one in a box at most, all that was found of it being kept.
    /// False, and nothing done, where that is not so.
    bool take_changes(const std::shared_ptr<const Volume>& next);
    /// Pass 2b, if the scene calls for it and what was found differs. Whether it ran.
    bool occlude(const Scene& scene);
    /// Passes 2c and 2d, likewise; the picture's targets are dropped then.
    bool cast_shadows(const Scene& scene, const Settings& settings);
    /// Frees everything of a picture but what any picture needs.
    void drop_targets();
    /// Throws Error where sheets must be layers of a target, in the picture or in one that a light takes, and the
    /// device has no such targets.
    void need_layers(const Scene& scene, const Settings& settings) const;
    /// What a request takes of the device's memory, if it does not fit with the volume as a whole.
    std::optional<MemoryNeed> beyond_memory(const FrameRequest& request);
    /// The splats that are collected, if they are those of the plan.
    std::optional<SplatCount> collected_splats(const CollectionPlan& wanted) const;
    /// Brings the volume to the device if it is not there.
    void provide_volume();
    /// Frees what pictures with these settings do not use.
    void release_unused(const Settings& drawn);
    /// Targets and buffers of the plan's sizes; fills in addresses and the frame's parameters.
    void provide_targets(FramePlan& plan);
    /// The footprints of kernels at faces, in the table.
    void fill_table(float face_depth);
    /// Room for the pairs of the largest chunk; brings the chunks to the device.
    void provide_chunks(const Chunks& chunks);
    /// Of the splats that are there.
    FramePlan plan_picture(const Scene& scene, const Camera& camera, const Settings& settings, const glm::ivec2& size,
                           std::uint32_t payload) const;
    /// Brings the spline through the samples to the device, of a volume that it holds as a whole; whether that was to
    /// be done.
    bool provide_coefficients();

    /// Passes 3 to 7 with one payload; the picture is left in targets.output. `offset`: of its rays from the pixels'
    /// centres, in pixels.
    void draw(const Scene& scene, const Camera& camera, const Settings& settings, const glm::ivec2& size,
              std::uint32_t payload, const glm::dvec2& offset = {0, 0});

    /// The same as `plan` says.
    void draw_planned();
    /// What follows the sort of a tiled picture.
    void draw_chunks(const Chunks& chunks, const passes::TileDraw& how);
    /// The same in two parts, the second without bricks that the first one hides; false where that saves nothing, and
    /// nothing is drawn.
    bool draw_front_first(const passes::TileDraw& how);
    /// Throws Error naming the pass and the splat where something is no finite number: in the list, in the picture.
    void check_splats();
    void check_picture();

    /// Of a tiled picture, the part that the exchange says; with the first part, the whole is left in targets.output.
    void draw_part(passes::TileDraw how);
    /// Whether the whole picture is refined: what a part knows of its splats is its own.
    bool parts_refine(const Chunks& own);
    /// This part's pixels of a step; the whole ones with the first part.
    std::vector<glm::vec4> draw_part_step(passes::TileDraw how, std::uint32_t chunks, std::uint32_t step,
                                          std::vector<bool>& reached);
    /// After a step: the first part fills in what follows, and says which pixels all are to draw next.
    /// `reached`: tiles that what is in front leaves open.
    void share_pixels(std::uint32_t step, const std::vector<bool>& reached, std::span<glm::vec4> whole);

    /// Throws Interrupted if that is wanted.
    void heed_interruption() const {
        if (interruption && interruption()) throw Interrupted();
    }

    /// Adds what the last draw came to, if that is counted.
    void add_counts(RenderStats& stats) const;

    std::shared_ptr<const Volume> original;                     ///< as it was set: level 0
    std::vector<std::shared_ptr<const Volume>> levels;          ///< resolutions of it that were drawn
    SplatSet other;                                             ///< a coarser level, shown until a finer one is there
    double patience = std::numeric_limits<double>::infinity();  ///< see Renderer::set_patience
    std::function<bool()> interruption;                         ///< see Renderer::set_interruption
    bool culls = true;  ///< what lies outside the picture brick by brick is left out
    /// And what is hidden, of so many splats in view: selecting and sorting fewer twice takes longer than all once.
    std::uint64_t least_hiding = std::uint64_t{1} << 16U;
    TargetResources targets;
    std::optional<RaycastResources> raycast;  ///< of this volume, once a picture was made that way

    FramePlan plan;  ///< of the last draw
    std::vector<PassTime> collection_times;
    std::uint64_t voxels_estimated = 0;                          ///< for this picture
    std::vector<PassTime> draw_times;                            ///< of the last draw
    PartExchange* exchange = nullptr;                            ///< see Renderer::divide_sheets
    bool divides_blocks = false;                                 ///< all of them hold the volume block by block
    std::optional<glm::ivec2> slab;                              ///< then this part's sheets, from the eye on
    SheetShare share;                                            ///< of the picture being drawn
    bool counting = false;                                       ///< see Renderer::count_fragments
    std::uint64_t memory_budget = 0;                             ///< bytes; 0: what the device has
    std::vector<std::pair<std::string, std::uint64_t>> checked;  ///< resources that were last asked for
    std::optional<MemoryNeed> checked_need;                      ///< what beyond_memory found of them
    DeviceChoice opened_as;                                      ///< to open it anew; whether numbers are checked
    bool lose = false;                                           ///< see Renderer::lose_device
    std::uint64_t messages_before = 0;                           ///< of validation, on devices that were lost
};

/// Opens the device; where it is lost meanwhile, up to so many times. Throws Error, DeviceLost in the end.
std::unique_ptr<RendererState> open_state(const DeviceChoice& choice, int attempts);

/// Scales state.volume and brings it to the device.
void upload_volume(RendererState& state);

}  // namespace edgesplat
