// The images and buffers of a frame, as renderer.cpp and frame.cpp allocate them; a test compares the bytes.
#include <algorithm>
#include <vulkan/vulkan_format_traits.hpp>

#include "engine/compositors/tiles/chunks.h"
#include "engine/forecast/forecast.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/plan/resources.h"
#include "engine/store/blocks.h"
#include "engine/store/light.h"
#include "shaders/shared/occlusion_params.h"

namespace edgesplat {
namespace {

using Usage = vk::ImageUsageFlagBits;

PlannedResource image(std::string name, const gpu::ImageShape& shape, std::string contents, std::string written,
                      std::string read) {
    const glm::u64vec3 size(shape.size);
    return {.name = std::move(name),
            .image = shape,
            .bytes = size.x * size.y * size.z * static_cast<std::uint64_t>(shape.layers) * vk::blockSize(shape.format),
            .contents = std::move(contents),
            .written = std::move(written),
            .read = std::move(read)};
}

PlannedResource buffer(std::string name, std::uint64_t bytes, std::string contents, std::string written,
                       std::string read) {
    return {.name = std::move(name),
            .image = {},
            .bytes = bytes,
            .contents = std::move(contents),
            .written = std::move(written),
            .read = std::move(read)};
}

PlannedResource on_host(PlannedResource resource) {
    resource.place = gpu::Buffer::Place::Host;
    return resource;
}

/// Likewise, unless what the device sees of it lies in memory of its own.
PlannedResource shared(PlannedResource resource) {
    resource.place = gpu::Buffer::Place::Shared;
    return resource;
}

PlannedResource growing(PlannedResource resource) {
    resource.grows = true;
    return resource;
}

PlannedResource texels(vk::Format format, PlannedResource resource) {
    resource.texels = format;
    return resource;
}

/// What of all draws takes most, since each may make the target anew.
const FramePlan& largest(const std::vector<FramePlan>& draws, std::uint64_t (*bytes)(const FramePlan&)) {
    return *std::ranges::max_element(draws, {}, bytes);
}

std::uint64_t order_bytes(const FramePlan& plan) {
    return std::uint64_t{plan.params.splat_count} * plan.sheets_per_splat * sizeof(std::uint32_t);
}

/// What every renderer holds from the beginning.
void add_placeholders(std::vector<PlannedResource>& out) {
    out.push_back(on_host(buffer("frame parameters", sizeof(shader::FrameParams), "(1) FrameParams", "host", "3-7")));
    out.push_back(on_host(buffer("drawn splats", 3 * sizeof(std::uint32_t), "(3) uint", "4, 5", "host")));
    out.push_back(on_host(buffer("quad indices", passes::quad_indices().size() * sizeof(std::uint32_t),
                                 "(quads x 6) uint", "host", "5")));

    out.push_back(texels(vk::Format::eR32G32B32A32Sfloat, buffer("placeholder texels", 16, "zeros", "-", "-")));
    out.push_back(texels(vk::Format::eR32Uint, buffer("placeholder counts", 16, "zeros", "-", "-")));
    out.push_back(texels(vk::Format::eR32G32Uint, buffer("placeholder entries", 16, "zeros", "-", "-")));
    out.push_back(on_host(buffer("placeholder block", sizeof(shader::FrameParams), "zeros", "-", "-")));
    const auto add = [&](vk::Format format, bool volume, bool array, Usage usage) {
        out.push_back(image("placeholder",
                            {.format = format, .size = {1, 1, 1}, .volume = volume, .array = array, .usage = usage},
                            "1 texel", "-", "-"));
    };
    add(vk::Format::eR32Sfloat, true, false, Usage::eStorage);
    add(vk::Format::eR32G32Uint, true, false, Usage::eStorage);
    add(vk::Format::eR8Uint, true, false, Usage::eStorage);
    add(vk::Format::eR32G32B32A32Sfloat, false, false, Usage::eStorage);
    add(vk::Format::eR16Sfloat, false, true, Usage::eSampled);
    add(vk::Format::eR32Sfloat, false, false, Usage::eSampled);
}

void add_volume_resources(const FrameForecast& f, std::vector<PlannedResource>& out) {
    const CollectionPlan& plan = f.collection;
    const CollectionBlock largest = plan.blocks ? largest_block(plan.dims) : whole_block(plan.dims);
    const auto volume_image = [&](const char* name, vk::Format format, vk::ImageUsageFlags usage, const char* contents,
                                  const char* written, const char* read) {
        out.push_back(image(name, {.format = format, .size = largest.size, .volume = true, .usage = usage}, contents,
                            written, read));
    };
    volume_image("volume", vk::Format::eR32Sfloat, Usage::eStorage | Usage::eTransferDst, "(z, y, x) samples", "host",
                 "1, 2");
    if (plan.edge_field && plan.estimator == EdgeEstimator::Cubic) {
        volume_image("B-spline coefficients", vk::Format::eR32Sfloat, Usage::eStorage | Usage::eTransferDst,
                     "(z, y, x) coefficients", "host", "1");
    }
    if (plan.edge_field) {
        volume_image("edge field", vk::Format::eR32G32Uint, Usage::eStorage | Usage::eTransferSrc,
                     "(z, y, x) normal, distances, flags", "1", "2");
    }
    if (plan.buried) {
        volume_image("buried mask", vk::Format::eR8Uint, Usage::eStorage | Usage::eTransferSrc, "(z, y, x) 0 or 1",
                     "1a", "1, 2");
    }
    out.push_back(on_host(buffer("scene parameters", sizeof(shader::SceneParams), "(1) SceneParams", "host", "1, 2")));
    out.push_back(on_host(buffer("run offsets", (passes::collect_runs(largest.core_size) + 2) * sizeof(std::uint32_t),
                                 "(runs + 2) uint", "2, host", "2, host")));
    if (!plan.transfer.empty()) {
        out.push_back(on_host(buffer("transfer function", plan.transfer.size() * sizeof(shader::TransferRow),
                                     "(rows) TransferRow", "host", "2, 5")));
        out.push_back(buffer("classified values", f.splats.splats * sizeof(float), "(splats) float", "2", "5"));
    }
    out.push_back(buffer("splat list", f.splats.splats * sizeof(shader::Splat), "(splats) Splat", "2", "3, 5"));
    if (const std::size_t bytes = plan.trait_bytes(); bytes > 0) {
        out.push_back(buffer("splat traits", f.splats.splats * bytes, "(splats) second derivatives", "2", "5"));
    }
}

void add_table(const FrameForecast& f, std::vector<PlannedResource>& out) {
    if (f.draws.front().plan.variant.footprints != FootprintMode::Table) return;
    out.push_back(image("footprint table", footprint_table_shape(), "(layers, y, x) footprints", "host", "5"));
    out.back().held = Held::Drawing;
    out.push_back(growing(
        buffer("selected footprints", f.splats.splats * sizeof(glm::uvec2), "(splats) layers, rotation", "3", "4, 5")));
    out.back().held = Held::Drawing;
}

/// What of the light reaches each splat, and what that is found with.
void add_reach(const FrameForecast& f, std::vector<PlannedResource>& out) {
    const std::uint64_t bytes = f.splats.splats * sizeof(std::uint32_t);
    if (f.occluded) {
        out.push_back(buffer("splat occlusion", bytes, "(splats) uint", "2b", "5"));
        out.push_back(on_host(
            buffer("occlusion parameters", sizeof(shader::OcclusionParams), "(1) OcclusionParams", "host", "2b")));
        out.back().held = Held::Occluding;
    }
    if (f.light_frames.empty()) return;
    out.push_back(buffer("splat shadows", bytes, "(splats) uint", "2d", "5"));
    std::uint64_t layers = 0;
    for (const FramePlan& light : f.light_frames)
        layers = std::max(layers, light_layer_bytes(light));
    out.push_back(buffer("light layers", layers, "(layers, y, x) optical depth from the light", "2c", "2d"));
    out.back().held = Held::Sweeping;
}

/// Sheets as layers: images, and what their draws take.
void add_layers(const std::vector<FramePlan>& f, std::vector<PlannedResource>& out) {
    constexpr vk::Format kSums = vk::Format::eR32G32B32A32Sfloat;
    const FramePlan& sheets = largest(f, [](const FramePlan& p) { return std::uint64_t{p.params.sheets_per_group}; });
    const FramePlan& groups = largest(f, [](const FramePlan& p) { return std::uint64_t{p.params.group_count}; });
    const glm::ivec3 size(sheets.params.size, 1);
    out.push_back(image("sheet group",
                        {.format = kSums,
                         .size = size,
                         .layers = static_cast<int>(sheets.params.sheets_per_group),
                         .array = true,
                         .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc},
                        "(sheets at once, y, x) sum tau colour, sum tau", "5", "6"));
    out.push_back(image("sheet depth",
                        {.format = vk::Format::eD16Unorm,
                         .size = size,
                         .layers = static_cast<int>(sheets.params.sheets_per_group),
                         .array = true,
                         .usage = Usage::eDepthStencilAttachment},
                        "(sheets at once, y, x) 0 where a pixel is opaque", "5", "5"));
    out.push_back(
        image("accumulated picture",
              {.format = kSums,
               .size = size,
               .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst},
              "(y, x) colour and opacity so far", "6", "5, 7"));
    out.push_back(
        on_host(growing(buffer("sheet groups", groups.params.group_count * std::uint64_t{sizeof(shader::SheetGroup)},
                               "(groups) SheetGroup", "host, 3, 4", "5, 6"))));
    out.push_back(
        growing(buffer("draw commands", groups.params.group_count * std::uint64_t{sizeof(shader::DrawCommand)},
                       "(groups) DrawCommand", "4", "5")));
}

/// Sheets that are summed tile by tile: lists of what touches each tile.
void add_tiles(const FramePlan& plan, std::uint64_t splats, const gpu::DeviceProfile& profile,
               std::vector<PlannedResource>& out) {
    constexpr std::uint64_t word = sizeof(std::uint32_t);
    const std::uint64_t sheets = plan.params.sheet_count;
    const auto tiles =
        static_cast<std::uint64_t>(plan.params.tiles.x) * static_cast<std::uint64_t>(plan.params.tiles.y);
    out.push_back(growing(buffer("tiles of splats", splats * 2 * word, "(splats) uvec2", "3", "4")));
    out.push_back(shared(growing(buffer("pairs of sheets", sheets * word, "(sheets) uint", "3", "host"))));
    out.push_back(shared(growing(buffer("sheet starts", (sheets + 1) * word, "(sheets + 1) uint", "4", "4, host"))));
    out.push_back(shared(growing(buffer("chunks of sheets", sheets * 2 * word, "(sheets) uvec2", "host", "4"))));
    out.push_back(growing(
        texels(vk::Format::eR32Uint,
               buffer("tile counters", tile_counter_bytes(plan.params.tiles, tile_blocks(plan.params.tiles, profile)),
                      "(tiles, blocks) uint", "4", "4"))));
    out.push_back(shared(growing(
        texels(vk::Format::eR32G32Uint, buffer("tile ranges", tiles * 2 * word, "(tiles) uvec2", "4", "5, host")))));
    out.push_back(
        on_host(growing(texels(vk::Format::eR32Uint, buffer("tile order", tile_order_items(plan) * word,
                                                            "(tiles) uint, longest list first", "host", "5")))));
    out.push_back(
        growing(texels(vk::Format::eR32G32Uint, buffer("tile entries", tile_entry_pairs(plan, profile) * 2 * word,
                                                       "(pairs at once) place in the order, sheet", "4", "5"))));
    out.push_back(growing(
        texels(vk::Format::eR32Uint,
               buffer("marks of tile entries", tile_mark_words(plan, chunk_pairs(plan.params.tiles, profile)) * word,
                      "(pairs at once) blocks of the tile's pixels", "4", "5"))));
    const std::uint32_t slots = passes::prepared_slots(splats * plan.sheets_per_splat);
    out.push_back(growing(image("prepared splats", passes::prepared_shape(plan.variant, slots),
                                "(entries at once) place, kernel, colour", "4", "5")));
    out.push_back(growing(
        texels(vk::Format::eR32Uint, buffer("closed pixels of tiles", tiles * word, "(tiles) uint", "5", "4"))));
    out.push_back(shared(growing(texels(vk::Format::eR32Uint, buffer("pixels to draw of tiles", tiles * word,
                                                                     "(tiles) uint", "host, 5", "4, 5, host")))));
    if (plan.refined) {
        out.push_back(
            growing(texels(vk::Format::eR32Uint, buffer("lists of pixels", tiles * shader::TILE * shader::TILE * word,
                                                        "(tiles, pixels) x, y in the tile", "5", "5"))));
        out.push_back(growing(buffer("finest splats of tiles", tiles * word, "(tiles) uint", "5", "5")));
        out.push_back(on_host(growing(buffer("closed pixels, seen", tiles * word, "(tiles) uint", "5", "host"))));
    }
    const glm::u64vec2 size(plan.params.size);
    out.push_back(
        growing(texels(vk::Format::eR32G32B32A32Sfloat,
                       buffer("unfinished sheets", size.x * size.y * sizeof(glm::vec4), "(y, x) vec4", "5", "5"))));
    if (plan.variant.outlines)
        out.push_back(growing(texels(vk::Format::eR32Uint, buffer("outlines", size.x * size.y * word,
                                                                  "(y, x) where one passes the pixel", "5", "7"))));
}

/// What pictures are drawn with: the one that is asked for, or a light's.
void add_targets(const std::vector<FramePlan>& f, std::uint64_t splats, const gpu::DeviceProfile& profile, Held held,
                 std::vector<PlannedResource>& all) {
    std::vector<PlannedResource> out;
    const FramePlan& order = largest(f, order_bytes);
    const FramePlan& most_sheets = largest(f, [](const FramePlan& p) { return std::uint64_t{p.params.sheet_count}; });
    const glm::ivec2 size = f.front().params.size;
    const auto pixels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    constexpr std::uint64_t word = sizeof(std::uint32_t);
    if (f.front().variant.tiles)
        add_tiles(most_sheets, splats, profile, out);
    else
        add_layers(f, out);
    out.push_back(shared(growing(buffer("batches of splats", (splats / shader::SPLAT_BATCH + 1) * sizeof(glm::uvec2),
                                        "(batches) first, count", "host", "3, 4"))));
    out.push_back(growing(buffer("sheets of splats", splats * word, "(slots) uint", "3", "4, 5")));
    out.push_back(growing(buffer("splat order", order_bytes(order), "(splats x sheets each) uint", "4", "5")));
    out.push_back(
        growing(buffer("sort counters", std::uint64_t{most_sheets.params.sheet_count} * shader::SORT_BLOCKS * word,
                       "(sheets, blocks) uint", "4", "4, 5")));
    out.push_back(
        shared(growing(texels(vk::Format::eR32G32B32A32Sfloat,
                              buffer("output pixels", pixels * sizeof(glm::vec4), "(y, x) vec4", "7", "host")))));
    for (PlannedResource& resource : out) {
        resource.held = held;
        all.push_back(std::move(resource));
    }
}

}  // namespace

std::vector<PlannedResource> planned_resources(const FrameForecast& forecast) {
    std::vector<PlannedResource> out;
    add_volume_resources(forecast, out);
    add_table(forecast, out);
    add_reach(forecast, out);
    std::vector<FramePlan> draws;
    for (const ForecastDraw& draw : forecast.draws)
        draws.push_back(draw.plan);
    add_targets(draws, forecast.splats.splats, *forecast.profile, Held::Drawing, out);
    if (!forecast.light_frames.empty())
        add_targets(forecast.light_frames, forecast.splats.splats, *forecast.profile, Held::Sweeping, out);
    add_placeholders(out);
    // Uploads go through one buffer, one after another.
    std::uint64_t staging = 0;
    for (const PlannedResource& resource : out)
        if (resource.image && resource.written == "host")
            staging = std::max(staging, staging_bytes(*resource.image, vk::blockSize(resource.image->format)));
    PlannedResource upload = on_host(buffer("staging buffer", staging, "(rows) texels", "host", "copies"));
    upload.held = Held::Uploading;
    out.push_back(std::move(upload));
    return out;
}

}  // namespace edgesplat
