#include "engine/raycast/raycast.h"

#include <algorithm>

#include "engine/scene/transfer_function.h"

namespace edgesplat {
namespace {

using Usage = vk::ImageUsageFlagBits;

gpu::GpuImage brick_image(const gpu::Device& device, const glm::ivec3& dims, const char* name) {
    return {
        device,
        {.format = vk::Format::eR8Uint, .size = passes::brick_count(dims), .volume = true, .usage = Usage::eStorage},
        name};
}

bool same_scene(const shader::SceneParams& a, const shader::SceneParams& b) {
    return a.iso_count == b.iso_count && a.visible_mask == b.visible_mask && std::ranges::equal(a.iso, b.iso);
}

}  // namespace

RaycastPlan plan_raycast(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings,
                         const RaycastSettings& raycast, const CollectionPlan& collection, const glm::ivec2& size) {
    const auto& geometry = volume.geometry;
    const glm::dmat3 to_world = geometry.index_to_world_axes, to_index = glm::inverse(to_world);
    const CameraFrame view = camera_frame(camera);
    const glm::dvec3 anchor = glm::dvec3(geometry.dims - 1) / 2.0;
    const glm::dvec3 anchor_view = geometry.to_world(anchor) - view.eye;

    RaycastPlan plan;
    plan.size = size;
    plan.variant = {light_code(scene),
                    collection.params.iso_count,
                    raycast.skip_empty,
                    static_cast<std::uint32_t>(raycast.filter),
                    draws_missing_samples(scene, volume),
                    collection.labels,
                    !scene.transfer.empty()};
    if (collection.labels != 0) plan.label_colors = label_colors(scene);
    plan.transfer = collection.transfer;
    plan.block.scene = collection.params;
    auto& p = plan.block.rays;
    p.anchor = anchor;
    p.anchor_x = static_cast<float>(glm::dot(view.right, anchor_view));
    p.anchor_y = static_cast<float>(glm::dot(-view.up, anchor_view));
    p.anchor_z = static_cast<float>(glm::dot(view.forward, anchor_view));
    p.ray_x = to_index * view.right;
    p.ray_y = to_index * -view.up;
    p.ray_z = to_index * view.forward;
    p.tan_half_x = static_cast<float>(view.tan_half_y * size.x / size.y);
    p.tan_half_y = static_cast<float>(view.tan_half_y);
    p.index_to_world = glm::mat3(to_world);
    p.normal_to_world = glm::mat3(glm::transpose(to_index));
    if (!scene.lights.empty()) {
        p.light = glm::normalize(scene.lights.front().direction);
        p.ambient = static_cast<float>(scene.ambient);
        p.diffuse = static_cast<float>(scene.lights.front().intensity);
    }
    p.background = scene.background;
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        p.materials[m] = glm::dvec4(scene.materials[m].color, scene.materials[m].extinction);
    p.size = size;
    p.saturation = settings.saturation >= 1 ? 3e38F : static_cast<float>(settings.saturation);
    p.step = static_cast<float>(raycast.step);
    return plan;
}

RaycastResources::RaycastResources(const gpu::Device& device, const gpu::Pipelines& pipelines, gpu::Commands& commands)
    : bindings_(device, pipelines),
      block_(device, sizeof(shader::RaycastBlock), gpu::Buffer::Place::Host, "ray parameters") {
    bindings_.write_volume({});
    bindings_.write_splats({});
    bindings_.write_targets({});
    bindings_.set().put_block(shader::BIND_RAYS, block_);
    commands.run([&] { bindings_.prepare(commands); });
}

void RaycastResources::prepare(const gpu::Device& device, const RaycastPlan& plan, const VolumeImages& volume) {
    if (size_ != plan.size) {
        const auto pixels = static_cast<std::size_t>(plan.size.x) * static_cast<std::size_t>(plan.size.y);
        output_ = {};
        output_ = gpu::Buffer(device, pixels * sizeof(glm::vec4), gpu::Buffer::Place::Host, "ray caster's pixels");
        size_ = plan.size;
    }
    auto& block = block_.mapped<shader::RaycastBlock>(1)[0];
    block = plan.block;
    if (!plan.transfer.empty()) {
        if (!transfer_)
            transfer_ = gpu::Buffer(device, plan.transfer.size() * sizeof(shader::TransferRow),
                                    gpu::Buffer::Place::Host, "ray caster's transfer function");
        std::ranges::copy(plan.transfer, transfer_.mapped<shader::TransferRow>(plan.transfer.size()).begin());
        block.scene.transfer = transfer_.address();
    }
    label_colors_ = {};
    if (!plan.label_colors.empty()) {
        label_colors_ = gpu::Buffer(device, plan.label_colors.size() * sizeof(glm::vec3), gpu::Buffer::Place::Host,
                                    "ray caster's label colours");
        std::ranges::copy(plan.label_colors, label_colors_.mapped<glm::vec3>(plan.label_colors.size()).begin());
        block.rays.label_colors = label_colors_.address();
    }
    block.rays.pixels = output_.address();
    bindings_.write_volume(volume);
    takes_coefficients_ = plan.variant.filter == shader::FILTER_CUBIC;
}

bool RaycastResources::classify(const gpu::Device& device, gpu::Commands& commands, const RaycastPlan& plan) {
    if (!plan.variant.skip_empty) return false;
    auto& [bricks, made_for, made_for_transfer] = bricks_.at(plan.variant.filter);
    const shader::SceneParams& scene = plan.block.scene;
    if (!bricks) bricks = brick_image(device, scene.dims, "bricks");
    bindings_.set().put_image(shader::BIND_BRICKS, bricks);
    if (same_scene(made_for, scene) && made_for_transfer == plan.transfer) return false;
    const gpu::GpuImage scratch = brick_image(device, scene.dims, "brick scratch");
    bindings_.set().put_image(shader::BIND_BRICK_SCRATCH, scratch);
    made_for = {};
    commands.run([&, &image = bricks] {
        commands.bind_compute_set(bindings_.set());
        commands.prepare({&scratch, &image});
        commands.pass(passes::classify_bricks(plan.variant, scene.dims));
    });
    // The slot must not keep a freed image.
    bindings_.set().put_image(shader::BIND_BRICK_SCRATCH, bricks);
    made_for = scene;
    made_for_transfer = plan.transfer;
    return true;
}

void RaycastResources::cast(gpu::Commands& commands, const RaycastPlan& plan) const {
    commands.run([&] {
        commands.bind_compute_set(bindings_.set());
        commands.pass(passes::cast_rays(plan.variant, plan.size));
    });
}

std::span<const float> RaycastResources::pixels() const {
    return output_.mapped<float>(4 * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
}

}  // namespace edgesplat
