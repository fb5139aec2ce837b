// Lists the images and buffers of a frame from the resource table, which also allocates them; a test compares the
// bytes.
#include <algorithm>
#include <map>
#include <vulkan/vulkan_format_traits.hpp>

#include "engine/forecast/forecast.h"
#include "engine/plan/resource_table.h"
#include "engine/store/blocks.h"
#include "engine/store/light.h"
#include "shaders/shared/light_params.h"

namespace edgesplat {
namespace {

PlannedResource image(const ResourceText& text, const gpu::ImageShape& shape) {
    const glm::u64vec3 size(shape.size);
    return {.text = text,
            .image = shape,
            .bytes = size.x * size.y * size.z * static_cast<std::uint64_t>(shape.layers) * vk::blockSize(shape.format)};
}

PlannedResource buffer(const ResourceText& text, std::uint64_t bytes,
                       gpu::Buffer::Place place = gpu::Buffer::Place::Device) {
    return {.text = text, .image = {}, .bytes = bytes, .place = place};
}

void add_placeholders(std::vector<PlannedResource>& out) {
    for (const gpu::ImageShape& shape : placeholder_images())
        out.push_back(image(kPlaceholder, shape));
    for (const vk::Format format : placeholder_texels()) {
        out.push_back(buffer(kPlaceholderTexels, kPlaceholderBytes));
        out.back().texels = format;
    }
    out.push_back(buffer(kPlaceholderBlock, sizeof(shader::FrameBlock), gpu::Buffer::Place::Host));
}

/// `parts`: of one volume.
void add_volume_images(std::span<const FrameForecast* const> parts, std::vector<PlannedResource>& out) {
    const CollectionPlan& plan = parts.front()->collection;
    const CollectionBlock largest = plan.blocks ? largest_block(plan.dims) : whole_block(plan.dims);
    const auto add_images = [&](const auto& rows) {
        for (const auto& row : rows)
            if (std::ranges::any_of(parts, [&](const FrameForecast* part) { return row.held(part->collection); }))
                out.push_back(image(row.text, row.shape(largest.size)));
    };
    add_images(volume_image_rows());
    // The surfaces' fields are freed before the kernels' are made.
    add_images(field_image_rows());
}

/// Adds the buffers of a splat list, and the lists of the light that reaches its splats.
void add_lists(const FrameForecast& f, std::vector<PlannedResource>& out) {
    const CollectionPlan& plan = f.collection;
    const CollectionBlock largest = plan.blocks ? largest_block(plan.dims) : whole_block(plan.dims);
    for (const CollectionBufferRow& row : collection_buffer_rows())
        if (const std::uint64_t bytes = row.bytes(plan, largest.core_size); bytes > 0)
            out.push_back(buffer(row.text, bytes, gpu::Buffer::Place::Host));
    for (const SplatListRow& row : splat_list_rows())
        if (const std::uint64_t bytes = row.bytes(plan); bytes > 0)
            out.push_back(buffer(row.text, f.splats.extent.count * bytes));
    const auto add_light = [&](gpu::Buffer SplatLists::*list) {
        out.push_back(buffer(row_of(list).text, f.splats.extent.count * kLightBytes));
    };
    if (f.occluded) add_light(&SplatLists::occlusion);
    if (f.shadow_lights > 0) add_light(&SplatLists::shadows);
}

/// Adds the targets of the picture's draws, each as large as its largest draw needs.
void add_targets(const std::vector<FramePlan>& draws, const gpu::DeviceProfile& profile,
                 std::vector<PlannedResource>& out) {
    for (const TargetImageRow& row : target_image_rows()) {
        std::optional<glm::ivec3> largest;
        for (const FramePlan& plan : draws)
            if (const auto size = row.size(plan)) largest = glm::max(largest.value_or(*size), *size);
        if (!largest) continue;
        out.push_back(image(row.text, row.shape(*largest)));
        out.back().grows = row.taller_is_reusable;
        out.back().held = Held::Drawing;
    }
    for (const TargetBufferRow& row : target_buffer_rows()) {
        std::uint64_t bytes = 0;
        for (const FramePlan& plan : draws)
            bytes = std::max(bytes, row.bytes(plan, profile));
        if (bytes == 0) continue;
        out.push_back(buffer(row.text, bytes, row.place));
        out.back().texels = row.texels;
        out.back().grows = !row.always;
        out.back().held = row.always ? Held::Always : Held::Drawing;
    }
}

}  // namespace

std::vector<PlannedResource> planned_resources(const FrameForecast& forecast) {
    std::vector<PlannedResource> out;
    std::vector<FramePlan> draws;
    const std::vector<const FrameForecast*> parts = forecast_parts(forecast);
    std::map<std::size_t, std::vector<const FrameForecast*>> volumes;
    for (const FrameForecast* part : parts)
        volumes[part->number].push_back(part);
    const auto belongs_to = [&out](std::size_t number, std::size_t first) {
        for (std::size_t i = first; i < out.size(); ++i)
            out[i].volume = number;
    };
    for (const auto& [number, of_volume] : volumes) {
        const std::size_t first = out.size();
        add_volume_images(of_volume, out);
        belongs_to(number, first);
    }
    for (const FrameForecast* part : parts) {
        const std::size_t first = out.size();
        add_lists(*part, out);
        belongs_to(part->number, first);
        for (const ForecastDraw& draw : part->draws)
            draws.push_back(draw.plan);
    }
    if (forecast.occluded || forecast.shadow_lights > 0) {
        out.push_back(buffer(kLightBlock, sizeof(shader::LightParams), gpu::Buffer::Place::Host));
        out.back().held = Held::Lighting;
    }
    add_targets(draws, *forecast.profile, out);
    add_placeholders(out);
    // Uploads are sequential; the largest staging buffer counts.
    std::uint64_t staging = 0;
    for (const PlannedResource& resource : out)
        if (resource.image && resource.text.written == "host")
            staging = std::max(staging, staging_bytes(*resource.image, vk::blockSize(resource.image->format)));
    out.push_back(buffer(kStagingBuffer, staging, gpu::Buffer::Place::Host));
    out.back().held = Held::Uploading;
    return out;
}

}  // namespace edgesplat
