// SplatStore: the light that reaches each splat.
#include <algorithm>

#include "engine/passes/2b_occlude_ambient.h"
#include "engine/plan/resource_table.h"
#include "engine/scene/transfer_function.h"
#include "engine/store/splat_store.h"
#include "shaders/shared/occlusion_params.h"

namespace edgesplat {
namespace {

gpu::Buffer light_list(const gpu::Device& device, gpu::Buffer SplatLists::*list, std::uint64_t splats) {
    return {device, splats * kLightBytes, gpu::Buffer::Place::Device, row_of(list).text.name};
}

}  // namespace

bool SplatStore::occlude(const VolumeStore& volume, const Scene& scene, SetupCost& cost) {
    if (!occludes_ambient(scene)) {
        lists_.occlusion = {};
        occluded_.reset();
        return false;
    }
    const OcclusionPlan plan = plan_occlusion(lists_.surfaces ? scene_of_bodies(scene) : scene);
    if (occluded_ == plan) return false;
    occluded_.reset();
    lists_.occlusion = {};
    bind(volume);
    lists_.occlusion = light_list(session_->device(), &SplatLists::occlusion, lists_.splat_count);
    const gpu::Buffer block(session_->device(), sizeof(shader::OcclusionParams), gpu::Buffer::Place::Host,
                            kOcclusionBlock.name);
    auto& params = block.mapped<shader::OcclusionParams>(1)[0];
    params = {};
    const VolumeGeometry& geometry = volume.volume()->geometry;
    params.normal_to_world = glm::mat3(glm::transpose(glm::inverse(geometry.index_to_world_axes)));
    params.radius = static_cast<float>(plan.radius);
    std::ranges::transform(plan.matter.extinction, std::begin(params.extinction),
                           [](double extinction) { return static_cast<float>(extinction); });
    const passes::ClipCount clip =
        place_clip(plan.matter.clip, geometry, glm::dvec3(0), params.clip_keep, params.clip_remove);
    params.splat_count = static_cast<std::uint32_t>(lists_.splat_count);
    params.reach = lists_.occlusion.address();
    session_->bindings().set().put_block(shader::BIND_OCCLUSION, block);
    gpu::Commands& commands = session_->commands();
    commands.run([&] {
        commands.span("2b_occlude_ambient", [&] {
            passes::occlude_ambient(commands, {.splat_count = lists_.splat_count,
                                               .iso_count = lists_.scene.mapped<shader::SceneParams>(1)[0].iso_count,
                                               .clip = clip,
                                               .surfaces = lists_.surfaces,
                                               .transfer = !plan.matter.transfer.empty()});
        });
    });
    add_times(cost.times, commands.span_times());
    occluded_ = plan;
    return true;
}

void SplatStore::drop_shadows() {
    lists_.shadows = {};
    shadowed_.reset();
}

void SplatStore::begin_shadows() {
    drop_shadows();
    lists_.shadows = light_list(session_->device(), &SplatLists::shadows, lists_.splat_count);
    // Splats outside the light's pictures are unshadowed.
    session_->commands().run([&] { session_->commands().fill(lists_.shadows, ~0U); });
}

}  // namespace edgesplat
