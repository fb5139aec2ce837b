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
using V = VolumeResources;
using T = TargetResources;
using S = shader::SceneParams;
using F = shader::FrameParams;

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
std::uint64_t sheets(const FramePlan& plan) {
    return plan.params.sheet_count;
}
std::uint64_t pixels(const FramePlan& plan) {
    return picture_bytes(plan) / sizeof(glm::vec4);
}
/// So many of each tile; none in pictures whose sheets are layers.
std::uint64_t of_tiles(const FramePlan& plan, std::uint64_t bytes) {
    return plan.variant.tiles ? tile_count(plan) * bytes : 0;
}
std::uint64_t if_tiles(const FramePlan& plan, std::uint64_t bytes) {
    return plan.variant.tiles ? bytes : 0;
}
std::uint64_t of_refined_tiles(const FramePlan& plan, std::uint64_t bytes) {
    return plan.may_refine ? of_tiles(plan, bytes) : 0;
}
/// So many of each group of sheets that are layers.
std::uint64_t of_groups(const FramePlan& plan, std::uint64_t bytes) {
    return plan.variant.tiles ? 0 : plan.params.group_count * bytes;
}
std::uint32_t prepared_slots(const FramePlan& plan) {
    return passes::prepared_slots(splats(plan) * plan.sheets_per_splat);
}
std::optional<glm::ivec3> layers(const FramePlan& plan, std::uint32_t count) {
    if (plan.variant.tiles) return std::nullopt;
    return glm::ivec3(plan.params.size, static_cast<int>(count));
}

const std::array kVolumeImages{
    VolumeImageRow{{"volume", "(z, y, x) samples", "host", "1, 2"}, &V::volume, shader::BIND_VOLUME,
                   volume_of(vk::Format::eR32Sfloat, Usage::eStorage | Usage::eTransferDst),
                   [](const CollectionPlan&) { return true; }},
    VolumeImageRow{{"B-spline coefficients", "(z, y, x) coefficients", "host", "1"}, &V::coefficients,
                   shader::BIND_COEFFICIENTS, volume_of(vk::Format::eR32Sfloat, Usage::eStorage | Usage::eTransferDst),
                   [](const CollectionPlan& p) { return p.takes_coefficients(); }},
    VolumeImageRow{{"edge field", "(z, y, x) normal, distances, flags", "1", "2"}, &V::edges, shader::BIND_EDGES,
                   volume_of(vk::Format::eR32G32Uint, Usage::eStorage | Usage::eTransferSrc),
                   [](const CollectionPlan& p) { return p.edge_field; }},
    VolumeImageRow{{"buried mask", "(z, y, x) 0 or 1", "1a", "1, 2"}, &V::buried, shader::BIND_BURIED,
                   volume_of(vk::Format::eR8Uint, Usage::eStorage | Usage::eTransferSrc),
                   [](const CollectionPlan& p) { return p.buried; }},
};

const std::array kCollectionBuffers{
    CollectionBufferRow{{"scene parameters", "(1) SceneParams", "host", "1, 2"}, &V::scene,
                        [](const CollectionPlan&, const glm::ivec3&) { return std::uint64_t{sizeof(S)}; }},
    // Behind the runs' counts how many splats have an edge, and a crease.
    CollectionBufferRow{{"run offsets", "(runs + 2) uint", "2, host", "2, host"}, &V::run_offsets,
                        [](const CollectionPlan&, const glm::ivec3& core) {
                            return (passes::collect_runs(core) + 2) * kWord;
                        }},
    CollectionBufferRow{{"transfer function", "(rows) TransferRow", "host", "2, 5"}, &V::transfer,
                        [](const CollectionPlan& p, const glm::ivec3&) {
                            return p.transfer.size() * std::uint64_t{sizeof(shader::TransferRow)};
                        }},
};

const std::array kSplatLists{
    SplatListRow{{"splat list", "(splats) Splat", "2", "3, 5"}, &V::splats, &S::splats, &F::splats,
                 [](const CollectionPlan&) { return std::uint64_t{sizeof(shader::Splat)}; }},
    SplatListRow{{"splat traits", "(splats) second derivatives", "2", "5"}, &V::traits, &S::traits, &F::traits,
                 [](const CollectionPlan& p) { return p.faces ? kPair : 0; }},
    SplatListRow{{"classified values", "(splats) float", "2", "5"}, &V::values, &S::values, &F::values,
                 [](const CollectionPlan& p) { return p.transfer.empty() ? 0 : kWord; }},
};

const std::array kLightLists{
    LightListRow{{"splat occlusion", "(splats) uint", "2b", "5"}, &V::occlusion, &F::splat_occlusion},
    LightListRow{{"splat shadows", "(splats) uint", "2d", "5"}, &V::shadows, &F::splat_shadows},
};

const std::array kTargetImages{
    TargetImageRow{{"footprint table", "(layers, y, x) footprints", "host", "5"}, &T::footprint_table,
                   shader::BIND_TABLE, Sampling::Linear,
                   layers_of(vk::Format::eR16Sfloat, Usage::eSampled | Usage::eTransferDst | Usage::eTransferSrc),
                   [](const FramePlan& p) -> std::optional<glm::ivec3> {
                       if (p.variant.footprints != FootprintMode::Table) return std::nullopt;
                       return glm::ivec3(shader::TABLE_WIDTH, shader::TABLE_ROWS, shader::TABLE_LAYERS);
                   }},
    TargetImageRow{{"sheet group", "(sheets at once, y, x) sum tau colour, sum tau", "5", "6"}, &T::sheets,
                   shader::BIND_SHEETS, Sampling::Nearest,
                   layers_of(kSums, Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc),
                   [](const FramePlan& p) { return layers(p, p.params.sheets_per_group); }},
    TargetImageRow{{"sheet depth", "(sheets at once, y, x) 0 where a pixel is opaque", "5", "5"}, &T::depth, kUnbound,
                   Sampling::None, layers_of(vk::Format::eD16Unorm, Usage::eDepthStencilAttachment),
                   [](const FramePlan& p) { return layers(p, p.params.sheets_per_group); }},
    TargetImageRow{{"accumulated picture", "(y, x) colour and opacity so far", "6", "5, 7"}, &T::accumulated,
                   shader::BIND_ACCUMULATED, Sampling::Nearest,
                   plane_of(kSums, Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc |
                                       Usage::eTransferDst),
                   [](const FramePlan& p) { return layers(p, 1); }},
    TargetImageRow{{"prepared splats", "(entries at once) place, kernel, colour", "4", "5"}, &T::prepared,
                   shader::BIND_PREPARED, Sampling::None, plane_of(kSums, Usage::eStorage),
                   [](const FramePlan& p) -> std::optional<glm::ivec3> {
                       if (!p.variant.tiles) return std::nullopt;
                       return glm::ivec3(passes::prepared_size(p.variant, prepared_slots(p)), 1);
                   },
                   true},
};

const std::array kTargetBuffers{
    TargetBufferRow{{"frame parameters", "(1) FrameParams", "host", "3-7"}, &T::frame, nullptr, Place::Host, kNoTexels,
                    kUnbound, [](const FramePlan&, const Profile&) { return std::uint64_t{sizeof(F)}; }, true},
    TargetBufferRow{{"drawn splats", "(3) uint", "4, 5", "host"}, &T::drawn, &F::drawn, Place::Host, kNoTexels,
                    kUnbound, [](const FramePlan&, const Profile&) { return 3 * kWord; }, true},
    TargetBufferRow{{"quad indices", "(quads x 6) uint", "host", "5"}, &T::indices, nullptr, Place::Host, kNoTexels,
                    kUnbound,
                    [](const FramePlan&, const Profile&) { return passes::quad_indices().size() * kWord; }, true},
    TargetBufferRow{{"selected footprints", "(splats) layers, rotation", "3", "4, 5"}, &T::footprints, &F::footprints,
                    Place::Device, kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) {
                        return p.variant.footprints == FootprintMode::Table ? splats(p) * kPair : 0;
                    }},
    TargetBufferRow{{"batches of splats", "(batches) first, count", "host", "3, 4"}, &T::batches, &F::batches,
                    Place::Shared, kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return (splats(p) / shader::SPLAT_BATCH + 1) * kPair; }},
    TargetBufferRow{{"sheets of splats", "(slots) uint", "3", "4, 5"}, &T::sheet_of, &F::sheets, Place::Device,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return splats(p) * kWord; }},
    TargetBufferRow{{"splat order", "(splats x sheets each) uint", "4", "5"}, &T::order, &F::order, Place::Device,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return splats(p) * p.sheets_per_splat * kWord; }},
    TargetBufferRow{{"sort counters", "(sheets, blocks) uint", "4", "4, 5"}, &T::counters, &F::counters, Place::Device,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return sheets(p) * shader::SORT_BLOCKS * kWord; }},
    TargetBufferRow{{"output pixels", "(y, x) vec4", "7", "host"}, &T::output, &F::output_pixels, Place::Shared, kSums,
                    shader::BIND_PICTURE, [](const FramePlan& p, const Profile&) { return picture_bytes(p); }},
    // Sheets that are layers.
    TargetBufferRow{{"sheet groups", "(groups) SheetGroup", "host, 3, 4", "5, 6"}, &T::groups, &F::groups, Place::Host,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return of_groups(p, sizeof(shader::SheetGroup)); }},
    TargetBufferRow{{"draw commands", "(groups) DrawCommand", "4", "5"}, &T::draws, &F::draws, Place::Device, kNoTexels,
                    kUnbound,
                    [](const FramePlan& p, const Profile&) { return of_groups(p, sizeof(shader::DrawCommand)); }},
    // Sheets that are summed tile by tile. The host sees which tiles a round is for.
    TargetBufferRow{{"tiles of splats", "(splats) uvec2", "3", "4"}, &T::tile_rects, &F::tile_rects, Place::Device,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return if_tiles(p, splats(p) * kPair); }},
    TargetBufferRow{{"pairs of sheets", "(sheets) uint", "3", "host"}, &T::sheet_pairs, &F::sheet_pairs, Place::Shared,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return if_tiles(p, sheets(p) * kWord); }},
    TargetBufferRow{{"sheet starts", "(sheets + 1) uint", "4", "4, host"}, &T::sheet_starts, &F::sheet_starts,
                    Place::Shared, kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return if_tiles(p, (sheets(p) + 1) * kWord); }},
    TargetBufferRow{{"chunks of sheets", "(sheets) uvec2", "host", "4"}, &T::chunks, &F::chunks, Place::Shared,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return if_tiles(p, sheets(p) * kPair); }},
    TargetBufferRow{{"tile counters", "(tiles, blocks) uint", "4", "4"}, &T::tile_counters, &F::tile_counters,
                    Place::Device, kWords, shader::BIND_TILE_COUNTERS,
                    [](const FramePlan& p, const Profile& profile) {
                        const glm::ivec2& tiles = p.params.tiles;
                        return if_tiles(p, tile_counter_bytes(tiles, tile_blocks(tiles, profile)));
                    }},
    TargetBufferRow{{"tile ranges", "(tiles) uvec2", "4", "5, host"}, &T::tile_ranges, &F::tile_ranges, Place::Shared,
                    kPairs, shader::BIND_TILE_RANGES,
                    [](const FramePlan& p, const Profile&) { return of_tiles(p, kPair); }},
    TargetBufferRow{{"tile order", "(tiles) uint, longest list first", "host", "5"}, &T::tile_order, &F::tile_order,
                    Place::Host, kWords, shader::BIND_TILE_ORDER,
                    [](const FramePlan& p, const Profile&) { return if_tiles(p, tile_order_items(p) * kWord); }},
    TargetBufferRow{{"tile entries", "(pairs at once) place in the order, sheet", "4", "5"}, &T::tile_entries,
                    &F::tile_entries, Place::Device, kPairs, shader::BIND_TILE_ENTRIES,
                    [](const FramePlan& p, const Profile& profile) {
                        return if_tiles(p, tile_entry_pairs(p, profile) * kPair);
                    }},
    TargetBufferRow{{"marks of tile entries", "(pairs at once) blocks of the tile's pixels", "4", "5"}, &T::tile_marks,
                    &F::tile_marks, Place::Device, kWords, shader::BIND_TILE_MARKS,
                    [](const FramePlan& p, const Profile& profile) {
                        return if_tiles(p, tile_mark_words(p, chunk_pairs(p.params.tiles, profile)) * kWord);
                    }},
    TargetBufferRow{{"closed pixels of tiles", "(tiles) uint", "5", "4"}, &T::tile_closed, &F::tile_closed,
                    Place::Device, kWords, shader::BIND_TILE_CLOSED,
                    [](const FramePlan& p, const Profile&) { return of_tiles(p, kWord); }},
    TargetBufferRow{{"pixels to draw of tiles", "(tiles) uint", "host, 5", "4, 5, host"}, &T::tile_todo, &F::tile_todo,
                    Place::Shared, kWords, shader::BIND_TILE_TODO,
                    [](const FramePlan& p, const Profile&) { return of_tiles(p, kWord); }},
    TargetBufferRow{{"lists of pixels", "(tiles, pixels) x, y in the tile", "5", "5"}, &T::tile_pixels, &F::tile_pixels,
                    Place::Device, kWords, shader::BIND_TILE_PIXELS,
                    [](const FramePlan& p, const Profile&) {
                        return of_refined_tiles(p, shader::TILE * shader::TILE * kWord);
                    }},
    TargetBufferRow{{"finest splats of tiles", "(tiles) uint", "5", "5"}, &T::tile_finest, &F::tile_finest,
                    Place::Device, kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return of_refined_tiles(p, kWord); }},
    TargetBufferRow{{"closed pixels, seen", "(tiles) uint", "5", "host"}, &T::tiles_seen, nullptr, Place::Host,
                    kNoTexels, kUnbound,
                    [](const FramePlan& p, const Profile&) { return of_refined_tiles(p, kWord); }},
    TargetBufferRow{{"unfinished sheets", "(y, x) vec4", "5", "5"}, &T::tile_sheets, &F::tile_sheets, Place::Device,
                    kSums, shader::BIND_TILE_SHEETS,
                    [](const FramePlan& p, const Profile&) { return if_tiles(p, picture_bytes(p)); }},
    TargetBufferRow{{"outlines", "(y, x) where one passes the pixel", "5", "7"}, &T::outlines, &F::outlines,
                    Place::Device, kWords, shader::BIND_OUTLINES,
                    [](const FramePlan& p, const Profile&) {
                        return if_tiles(p, p.variant.outlines ? pixels(p) * kWord : 0);
                    }},
};

gpu::ImageShape texel(gpu::ImageShape kind) {
    kind.size = glm::ivec3(1);
    return kind;
}
const std::array kPlaceholders{
    texel(volume_of(vk::Format::eR32Sfloat, Usage::eStorage)),
    texel(volume_of(vk::Format::eR32G32Uint, Usage::eStorage)),
    texel(volume_of(vk::Format::eR8Uint, Usage::eStorage)),
    texel(plane_of(kSums, Usage::eStorage)),
    texel(layers_of(vk::Format::eR16Sfloat, Usage::eSampled)),
    texel(plane_of(vk::Format::eR32Sfloat, Usage::eSampled))};
constexpr std::array kPlaceholderFormats{kSums, kWords, kPairs};

}  // namespace

std::span<const VolumeImageRow> volume_image_rows() {
    return kVolumeImages;
}

gpu::ImageShape shape_of(const VolumeImageRow& row, const glm::ivec3& size) {
    gpu::ImageShape shape = row.kind;
    shape.size = size;
    return shape;
}

const VolumeImageRow& row_of(gpu::GpuImage VolumeResources::*image) {
    return *std::ranges::find(kVolumeImages, image, &VolumeImageRow::image);
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

gpu::ImageShape shape_of(const TargetImageRow& row, const glm::ivec3& size) {
    gpu::ImageShape shape = row.kind;
    shape.size = {size.x, size.y, 1};
    shape.layers = size.z;
    return shape;
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
