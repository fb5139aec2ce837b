#include "engine/plan/resource_table.h"

#include <algorithm>
#include <array>

#include "engine/passes/2_collect_splats.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/plan/sizes.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/footprint_table.h"

namespace edgesplat {
namespace {

using Place = gpu::Buffer::Place;
using Usage = vk::ImageUsageFlagBits;
using Profile = gpu::DeviceProfile;
using V = VolumeImages;
using L = SplatLists;
using T = TargetResources;
using S = shader::SceneParams;
using F = shader::FrameParams;
using P = shader::VolumeParams;

constexpr std::uint64_t kWord = sizeof(std::uint32_t), kPair = 2 * kWord;
constexpr vk::Format kNoTexels = vk::Format::eUndefined, kSums = vk::Format::eR32G32B32A32Sfloat;
constexpr vk::Format kWords = vk::Format::eR32Uint, kPairs = vk::Format::eR32G32Uint;

constexpr gpu::ImageShape volume_of(vk::Format format, vk::ImageUsageFlags usage) {
    return {.format = format, .size = {}, .volume = true, .usage = usage};
}
constexpr gpu::ImageShape layers_of(vk::Format format, vk::ImageUsageFlags usage) {
    return {.format = format, .size = {}, .array = true, .usage = usage};
}
constexpr gpu::ImageShape plane_of(vk::Format format, vk::ImageUsageFlags usage) {
    return {.format = format, .size = {}, .usage = usage};
}

std::uint64_t splats(const FramePlan& plan) {
    return plan.params.splat_count;
}
/// Slots of the splats at most: of several volumes, each volume's last batch may be shorter.
std::uint64_t slots(const FramePlan& plan) {
    return splats(plan) + plan.params.volume_count * shader::SPLAT_BATCH;
}
std::uint64_t sheets(const FramePlan& plan) {
    return plan.params.sheet_count;
}
std::uint64_t pixels(const FramePlan& plan) {
    return picture_bytes(plan) / sizeof(glm::vec4);
}
/// `bytes` per tile; 0 if sheets are layers.
std::uint64_t of_tiles(const FramePlan& plan, std::uint64_t bytes) {
    return plan.variant.tiles ? tile_count(plan) * bytes : 0;
}
std::uint64_t if_tiles(const FramePlan& plan, std::uint64_t bytes) {
    return plan.variant.tiles ? bytes : 0;
}
std::uint64_t of_refined_tiles(const FramePlan& plan, std::uint64_t bytes) {
    return plan.may_refine ? of_tiles(plan, bytes) : 0;
}
/// `bytes` per sheet group; 0 if sheets are summed tile by tile.
std::uint64_t of_groups(const FramePlan& plan, std::uint64_t bytes) {
    return plan.variant.tiles ? 0 : plan.params.group_count * bytes;
}
std::uint32_t prepared_slots(const FramePlan& plan) {
    return passes::prepared_slots(splats(plan) * plan.sheets_per_splat);
}
/// Of BIND_TILE_SHEETS.
std::uint64_t texels_of_pixel(const FramePlan& plan) {
    if (!plan.variant.surfaces) return 1;
    return shader::VOTE_TEXELS + (plan.variant.shadows > 0 ? 1 : 0);
}
std::optional<glm::ivec3> layers(const FramePlan& plan, std::uint32_t count) {
    if (plan.variant.tiles) return std::nullopt;
    return glm::ivec3(plan.params.size, static_cast<int>(count));
}

constexpr ResourceText text(const char* name, const char* contents, const char* written, const char* read) {
    return {name, contents, written, read};
}
template <typename Row, typename... Fields>
Row row(const Fields&... fields) {
    return Row{fields...};
}

const std::array kVolumeImages{
    row<VolumeImageRow<VolumeImages>>(text("volume", "(z, y, x) samples", "host", "1, 2"), &V::volume,
                                      shader::BIND_VOLUME,
                                      volume_of(vk::Format::eR32Sfloat, Usage::eStorage | Usage::eTransferDst),
                                      [](const CollectionPlan&) { return true; }),
    row<VolumeImageRow<VolumeImages>>(text("B-spline coefficients", "(z, y, x) coefficients", "host", "1"),
                                      &V::coefficients, shader::BIND_COEFFICIENTS,
                                      volume_of(vk::Format::eR32Sfloat, Usage::eStorage | Usage::eTransferDst),
                                      [](const CollectionPlan& p) { return p.takes_coefficients(); }),
    row<VolumeImageRow<VolumeImages>>(text("labels", "(z, y, x) label of each voxel", "host", "2"), &V::labels,
                                      shader::BIND_LABELS,
                                      volume_of(vk::Format::eR32Uint, Usage::eStorage | Usage::eTransferDst),
                                      [](const CollectionPlan& p) { return p.labels != 0; }),
};

const std::array kFieldImages{
    row<VolumeImageRow<SplatLists>>(
        text("edge field", "(z, y, x) normal, distances, flags", "1", "2"), &L::edges, shader::BIND_EDGES,
        volume_of(vk::Format::eR32G32Uint, Usage::eStorage | Usage::eTransferSrc | Usage::eTransferDst),
        [](const CollectionPlan& p) { return p.edge_field; }),
    row<VolumeImageRow<SplatLists>>(text("buried mask", "(z, y, x) 0 or 1", "1a", "1, 2"), &L::buried,
                                    shader::BIND_BURIED,
                                    volume_of(vk::Format::eR8Uint, Usage::eStorage | Usage::eTransferSrc),
                                    [](const CollectionPlan& p) { return p.buried; }),
};

const std::array kCollectionBuffers{
    row<CollectionBufferRow>(text("scene parameters", "(1) SceneParams", "host", "1, 2"), &L::scene,
                             [](const CollectionPlan&, const glm::ivec3&) { return std::uint64_t{sizeof(S)}; }),
    // The three elements behind the runs' counts: number of splats with an edge, a crease, a face that rays must find.
    row<CollectionBufferRow>(
        text("run offsets", "(runs + 3) uint", "2, host", "2, host"), &L::run_offsets,
        [](const CollectionPlan&, const glm::ivec3& core) { return (passes::collect_runs(core) + 3) * kWord; }),
    row<CollectionBufferRow>(text("listed bricks", "(bricks) uint", "host", "1, 2"), &L::listed_bricks,
                             [](const CollectionPlan& p, const glm::ivec3& core) {
                                 return p.lists_bricks() ? BrickRuns(core).bricks() * kWord : 0;
                             }),
    row<CollectionBufferRow>(text("transfer function", "(rows) TransferRow", "host", "2, 5"), &L::transfer,
                             [](const CollectionPlan& p, const glm::ivec3&) {
                                 return p.transfer.size() * std::uint64_t{sizeof(shader::TransferRow)};
                             }),
};

const std::array kSplatLists{
    row<SplatListRow>(text("splat list", "(splats) Splat", "2", "3, 5"), &L::splats, &S::splats, &P::splats,
                      [](const CollectionPlan&) { return std::uint64_t{sizeof(shader::Splat)}; }),
    row<SplatListRow>(text("splat traits", "(splats) second derivatives", "2", "5"), &L::traits, &S::traits, &P::traits,
                      [](const CollectionPlan& p) { return p.faces ? kPair : 0; }),
    row<SplatListRow>(text("classified values", "(splats) float", "2", "5"), &L::values, &S::values, &P::values,
                      [](const CollectionPlan& p) { return p.transfer.empty() ? 0 : kWord; }),
    row<SplatListRow>(text("splat labels", "(splats) uint", "2", "5"), &L::labels, &S::labels, &P::labels,
                      [](const CollectionPlan& p) { return p.labels != 0 && !p.surfaces ? kWord : 0; }),
};

const std::array kLightLists{
    row<LightListRow>(text("splat occlusion", "(splats) uint", "2b", "5"), &L::occlusion, &P::splat_occlusion),
    row<LightListRow>(text("splat shadows", "(splats) uint", "2c", "5"), &L::shadows, &P::splat_shadows),
};

const std::array kTargetImages{
    row<TargetImageRow>(text("footprint table", "(layers, y, x) footprints", "host", "5"), &T::footprint_table,
                        shader::BIND_TABLE, Sampling::Linear,
                        layers_of(vk::Format::eR16Sfloat, Usage::eSampled | Usage::eTransferDst | Usage::eTransferSrc),
                        [](const FramePlan& p) -> std::optional<glm::ivec3> {
                            if (p.variant.footprints != FootprintMode::Table) return std::nullopt;
                            return glm::ivec3(shader::TABLE_WIDTH, shader::TABLE_ROWS, shader::TABLE_LAYERS);
                        }),
    row<TargetImageRow>(text("sheet group", "(sheets at once, y, x) sum tau colour, sum tau", "5", "6"), &T::sheets,
                        shader::BIND_SHEETS, Sampling::Nearest,
                        layers_of(kSums, Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc),
                        [](const FramePlan& p) { return layers(p, p.params.sheets_per_group); }),
    row<TargetImageRow>(text("sheet depth", "(sheets at once, y, x) 0 if the pixel is saturated", "5", "5"), &T::depth,
                        kUnbound, Sampling::None, layers_of(vk::Format::eD16Unorm, Usage::eDepthStencilAttachment),
                        [](const FramePlan& p) { return layers(p, p.params.sheets_per_group); }),
    row<TargetImageRow>(
        text("accumulated picture", "(y, x) colour and opacity so far", "6", "5, 7"), &T::accumulated,
        shader::BIND_ACCUMULATED, Sampling::Nearest,
        plane_of(kSums, Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst),
        [](const FramePlan& p) { return layers(p, 1); }),
    row<TargetImageRow>(
        text("prepared splats", "(entries at once) place, kernel, colour", "4", "5"), &T::prepared,
        shader::BIND_PREPARED, Sampling::None, plane_of(kSums, Usage::eStorage),
        [](const FramePlan& p) -> std::optional<glm::ivec3> {
            if (!p.variant.tiles) return std::nullopt;
            return glm::ivec3(passes::prepared_size(p.variant, prepared_slots(p)), 1);
        },
        true),
};

const std::array kTargetBuffers{
    row<TargetBufferRow>(
        text("frame parameters", "(1) FrameBlock", "host", "3-7"), &T::frame, nullptr, Place::Host, kNoTexels, kUnbound,
        [](const FramePlan&, const Profile&) { return std::uint64_t{sizeof(shader::FrameBlock)}; }, true),
    row<TargetBufferRow>(
        text("drawn splats", "(3) uint", "4, 5", "host"), &T::drawn, &F::drawn, Place::Host, kNoTexels, kUnbound,
        [](const FramePlan&, const Profile&) { return 3 * kWord; }, true),
    row<TargetBufferRow>(
        text("quad indices", "(quads x 6) uint", "host", "5"), &T::indices, nullptr, Place::Host, kNoTexels, kUnbound,
        [](const FramePlan&, const Profile&) { return passes::kQuadIndices * kWord; }, true),
    row<TargetBufferRow>(text("selected footprints", "(splats) layers, rotation", "3", "4, 5"), &T::footprints,
                         &F::footprints, Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) {
                             return p.variant.footprints == FootprintMode::Table ? splats(p) * kPair : 0;
                         }),
    row<TargetBufferRow>(
        text("batches of splats", "(batches) first, count", "host", "3, 4"), &T::batches, &F::batches, Place::Shared,
        kNoTexels, kUnbound,
        [](const FramePlan& p, const Profile&) { return (slots(p) / shader::SPLAT_BATCH + 1) * kPair; }),
    row<TargetBufferRow>(
        text("label colours", "(labels) vec3", "host", "4, 5"), &T::label_colors, &F::label_colors, Place::Host,
        kNoTexels, kUnbound,
        [](const FramePlan& p, const Profile&) { return p.label_colors.size() * std::uint64_t{sizeof(glm::vec3)}; }),
    row<TargetBufferRow>(text("sheets of splats", "(slots) uint", "3", "4, 5"), &T::sheet_of, &F::sheets, Place::Device,
                         kNoTexels, kUnbound, [](const FramePlan& p, const Profile&) { return slots(p) * kWord; }),
    row<TargetBufferRow>(text("splat order", "(splats x sheets each) uint", "4", "5"), &T::order, &F::order,
                         Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return splats(p) * p.sheets_per_splat * kWord; }),
    row<TargetBufferRow>(text("sort counters", "(sheets, blocks) uint", "4", "4, 5"), &T::counters, &F::counters,
                         Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return sheets(p) * shader::SORT_BLOCKS * kWord; }),
    row<TargetBufferRow>(text("output pixels", "(y, x) vec4", "7", "host"), &T::output, &F::output_pixels,
                         Place::Shared, kSums, shader::BIND_PICTURE,
                         [](const FramePlan& p, const Profile&) { return picture_bytes(p); }),
    // Sheets that are layers.
    row<TargetBufferRow>(text("sheet groups", "(groups) SheetGroup", "host, 3, 4", "5, 6"), &T::groups, &F::groups,
                         Place::Host, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return of_groups(p, sizeof(shader::SheetGroup)); }),
    row<TargetBufferRow>(text("draw commands", "(groups) DrawCommand", "4", "5"), &T::draws, &F::draws, Place::Device,
                         kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return of_groups(p, sizeof(shader::DrawCommand)); }),
    // Tiled pictures. The host reads which tiles a round draws.
    row<TargetBufferRow>(text("tiles of splats", "(splats) uvec2", "3", "4"), &T::tile_rects, &F::tile_rects,
                         Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return if_tiles(p, splats(p) * kPair); }),
    row<TargetBufferRow>(text("pairs of sheets", "(sheets) uint", "3", "host"), &T::sheet_pairs, &F::sheet_pairs,
                         Place::Shared, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return if_tiles(p, sheets(p) * kWord); }),
    row<TargetBufferRow>(text("sheet starts", "(sheets + 1) uint", "4", "4, host"), &T::sheet_starts, &F::sheet_starts,
                         Place::Shared, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return if_tiles(p, (sheets(p) + 1) * kWord); }),
    row<TargetBufferRow>(text("chunks of sheets", "(sheets) uvec2", "host", "4"), &T::chunks, &F::chunks, Place::Shared,
                         kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return if_tiles(p, sheets(p) * kPair); }),
    row<TargetBufferRow>(text("tile counters", "(tiles, blocks) uint", "4", "4"), &T::tile_counters, &F::tile_counters,
                         Place::Device, kWords, shader::BIND_TILE_COUNTERS,
                         [](const FramePlan& p, const Profile& profile) {
                             const glm::ivec2& tiles = p.params.tiles;
                             return if_tiles(p, tile_counter_bytes(tiles, tile_blocks(tiles, profile)));
                         }),
    row<TargetBufferRow>(text("tile ranges", "(tiles) uvec2", "4", "5, host"), &T::tile_ranges, &F::tile_ranges,
                         Place::Shared, kPairs, shader::BIND_TILE_RANGES,
                         [](const FramePlan& p, const Profile&) { return of_tiles(p, kPair); }),
    row<TargetBufferRow>(text("tile order", "(tiles) uint, longest list first", "host", "5"), &T::tile_order,
                         &F::tile_order, Place::Host, kWords, shader::BIND_TILE_ORDER,
                         [](const FramePlan& p, const Profile&) { return if_tiles(p, tile_order_items(p) * kWord); }),
    row<TargetBufferRow>(
        text("tile entries", "(pairs at once) place in the order, sheet", "4", "5"), &T::tile_entries, &F::tile_entries,
        Place::Device, kPairs, shader::BIND_TILE_ENTRIES,
        [](const FramePlan& p, const Profile& profile) { return if_tiles(p, tile_entry_pairs(p, profile) * kPair); }),
    row<TargetBufferRow>(text("marks of tile entries", "(pairs at once) blocks of the tile's pixels", "4", "5"),
                         &T::tile_marks, &F::tile_marks, Place::Device, kWords, shader::BIND_TILE_MARKS,
                         [](const FramePlan& p, const Profile& profile) {
                             return if_tiles(p, tile_mark_words(p, chunk_pairs(p.params.tiles, profile)) * kWord);
                         }),
    row<TargetBufferRow>(text("saturated pixels of tiles", "(tiles) uint", "5", "4"), &T::tile_closed, &F::tile_closed,
                         Place::Device, kWords, shader::BIND_TILE_CLOSED,
                         [](const FramePlan& p, const Profile&) { return of_tiles(p, kWord); }),
    row<TargetBufferRow>(text("pixels to draw of tiles", "(tiles) uint", "host, 5", "4, 5, host"), &T::tile_todo,
                         &F::tile_todo, Place::Shared, kWords, shader::BIND_TILE_TODO,
                         [](const FramePlan& p, const Profile&) { return of_tiles(p, kWord); }),
    row<TargetBufferRow>(
        text("lists of pixels", "(tiles, pixels) x, y in the tile", "5", "5"), &T::tile_pixels, &F::tile_pixels,
        Place::Device, kWords, shader::BIND_TILE_PIXELS,
        [](const FramePlan& p, const Profile&) { return of_refined_tiles(p, shader::TILE * shader::TILE * kWord); }),
    row<TargetBufferRow>(text("finest splats of tiles", "(tiles) uint", "5", "5"), &T::tile_finest, &F::tile_finest,
                         Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return of_refined_tiles(p, kWord); }),
    row<TargetBufferRow>(text("saturated pixels, host", "(tiles) uint", "5", "host"), &T::tile_closed_on_host, nullptr,
                         Place::Host, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return of_refined_tiles(p, kWord); }),
    row<TargetBufferRow>(
        text("unfinished sheets", "(y, x) vec4, or votes about surfaces", "5", "5"), &T::tile_sheets, &F::tile_sheets,
        Place::Device, kSums, shader::BIND_TILE_SHEETS,
        [](const FramePlan& p, const Profile&) { return if_tiles(p, texels_of_pixel(p) * picture_bytes(p)); }),
    row<TargetBufferRow>(
        text("outlines", "(y, x) where one crosses the pixel", "5", "7"), &T::outlines, &F::outlines, Place::Device,
        kWords, shader::BIND_OUTLINES,
        [](const FramePlan& p, const Profile&) { return if_tiles(p, p.variant.outlines ? pixels(p) * kWord : 0); }),
    row<TargetBufferRow>(
        text("traced rays", "(y, x, 2) vec4", "5", "5"), &T::traced_rays, &F::traced_rays, Place::Device, kNoTexels,
        kUnbound,
        [](const FramePlan& p, const Profile&) { return if_tiles(p, p.variant.traced ? 2 * picture_bytes(p) : 0); }),
    row<TargetBufferRow>(text("traced entries", "(pairs at once) bits", "4", "5"), &T::traced_entries,
                         &F::traced_entries, Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile& profile) {
                             return if_tiles(p, traced_words(p, tile_entry_pairs(p, profile)) * kWord);
                         }),
    row<TargetBufferRow>(text("seen surfaces", "(2, y, x) payload, opacity", "5", "5, 6"), &T::seen_surfaces,
                         &F::seen_surfaces, Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return p.variant.mixed ? 2 * picture_bytes(p) : 0; }),
    row<TargetBufferRow>(
        text("ways to surfaces", "(2, y, x) float", "5", "5, 6"), &T::seen_ways, &F::seen_ways, Place::Device,
        kNoTexels, kUnbound,
        [](const FramePlan& p, const Profile&) { return p.variant.mixed ? 2 * pixels(p) * kWord : 0; }),
    row<TargetBufferRow>(text("passed surfaces", "(y, x) uint", "5", "5, 6"), &T::surfaces_passed, &F::surfaces_passed,
                         Place::Device, kNoTexels, kUnbound,
                         [](const FramePlan& p, const Profile&) { return p.variant.mixed ? pixels(p) * kWord : 0; }),
    row<TargetBufferRow>(
        text("ends of tiles", "(tiles) float", "5", "host"), &T::tile_ends, &F::tile_ends, Place::Shared, kNoTexels,
        kUnbound, [](const FramePlan& p, const Profile&) { return p.variant.mixed ? tile_count(p) * kWord : 0; }),
    row<TargetBufferRow>(
        text("nearest surfaces", "(2, y, x) payload, opacity", "6", "6"), &T::nearest_surfaces, &F::nearest_surfaces,
        Place::Device, kNoTexels, kUnbound,
        [](const FramePlan& p, const Profile&) { return p.variant.several ? 2 * picture_bytes(p) : 0; }),
    row<TargetBufferRow>(
        text("ways to nearest surfaces", "(2, y, x) float", "6", "6"), &T::nearest_ways, &F::nearest_ways,
        Place::Device, kNoTexels, kUnbound,
        [](const FramePlan& p, const Profile&) { return p.variant.several ? 2 * pixels(p) * kWord : 0; }),
};

gpu::ImageShape texel(gpu::ImageShape kind) {
    kind.size = glm::ivec3(1);
    return kind;
}
const std::array kPlaceholders{texel(volume_of(vk::Format::eR32Sfloat, Usage::eStorage)),
                               texel(volume_of(vk::Format::eR32G32Uint, Usage::eStorage)),
                               texel(volume_of(vk::Format::eR8Uint, Usage::eStorage)),
                               texel(volume_of(vk::Format::eR32Uint, Usage::eStorage)),
                               texel(plane_of(kSums, Usage::eStorage)),
                               texel(layers_of(vk::Format::eR16Sfloat, Usage::eSampled)),
                               texel(plane_of(vk::Format::eR32Sfloat, Usage::eSampled))};
constexpr std::array kPlaceholderFormats{kSums, kWords, kPairs};

}  // namespace

template <typename Owner>
gpu::ImageShape VolumeImageRow<Owner>::shape(const glm::ivec3& size) const {
    gpu::ImageShape shape = kind;
    shape.size = size;
    return shape;
}
template struct VolumeImageRow<VolumeImages>;
template struct VolumeImageRow<SplatLists>;

std::span<const VolumeImageRow<VolumeImages>> volume_image_rows() {
    return kVolumeImages;
}

std::span<const VolumeImageRow<SplatLists>> field_image_rows() {
    return kFieldImages;
}

std::span<const CollectionBufferRow> collection_buffer_rows() {
    return kCollectionBuffers;
}

std::span<const SplatListRow> splat_list_rows() {
    return kSplatLists;
}

std::span<const LightListRow> light_list_rows() {
    return kLightLists;
}

std::span<const TargetImageRow> target_image_rows() {
    return kTargetImages;
}

std::span<const TargetBufferRow> target_buffer_rows() {
    return kTargetBuffers;
}

gpu::ImageShape TargetImageRow::shape(const glm::ivec3& size_and_layers) const {
    gpu::ImageShape shape = kind;
    shape.size = {size_and_layers.x, size_and_layers.y, 1};
    shape.layers = size_and_layers.z;
    return shape;
}

const VolumeImageRow<VolumeImages>& row_of(gpu::GpuImage VolumeImages::*image) {
    return *std::ranges::find(kVolumeImages, image, &VolumeImageRow<VolumeImages>::image);
}

const LightListRow& row_of(gpu::Buffer SplatLists::*list) {
    return *std::ranges::find(kLightLists, list, &LightListRow::list);
}

const TargetBufferRow& row_of(gpu::Buffer TargetResources::*buffer) {
    return *std::ranges::find(kTargetBuffers, buffer, &TargetBufferRow::buffer);
}

std::span<const gpu::ImageShape> placeholder_images() {
    return kPlaceholders;
}

std::span<const vk::Format> placeholder_texels() {
    return kPlaceholderFormats;
}

}  // namespace edgesplat
