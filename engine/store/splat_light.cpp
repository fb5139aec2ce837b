// SplatStore: the light that reaches each splat.
#include <algorithm>

#include "engine/passes/2b_occlude_ambient.h"
#include "engine/passes/2c_cast_shadows.h"
#include "engine/plan/plan.h"
#include "engine/plan/resource_table.h"
#include "engine/scene/transfer_function.h"
#include "engine/store/splat_store.h"

namespace edgesplat {
namespace {

gpu::Buffer light_list(const gpu::Device& device, gpu::Buffer SplatLists::*list, std::uint64_t splats) {
    return {device, splats * kLightBytes, gpu::Buffer::Place::Device, row_of(list).text.name};
}

/// Inputs of passes 2b and 2c. The caller sets what only one of them reads.
struct LightInputs {
    LightInputs(const SplatLists& lists, const Volume& volume, const Matter& matter, const gpu::Buffer& reach) {
        const VolumeGeometry& geometry = volume.geometry;
        place_iso_values(volume, matter.iso_values, params.iso);
        params.normal_to_world = glm::mat3(glm::transpose(glm::inverse(geometry.index_to_world_axes)));
        std::ranges::transform(matter.extinction, std::begin(params.extinction),
                               [](double extinction) { return static_cast<float>(extinction); });
        params.splat_count = static_cast<std::uint32_t>(lists.splat_count);
        params.reach = reach.address();
        variant = {.splat_count = lists.splat_count,
                   .iso_count = static_cast<std::uint32_t>(matter.iso_values.size()),
                   .clip = place_clip(matter.clip, geometry, glm::dvec3(0), params.clip_keep, params.clip_remove),
                   .surfaces = lists.surfaces,
                   .transfer = !matter.transfer.empty()};
    }
    shader::LightParams params{};
    passes::SplatLight variant;
};

/// Runs one of the passes and waits.
void run_light(DeviceSession& session, const char* name, const LightInputs& in,
               void (*pass)(gpu::Commands&, const passes::SplatLight&), SetupCost& cost) {
    const gpu::Buffer block(session.device(), sizeof(shader::LightParams), gpu::Buffer::Place::Host, kLightBlock.name);
    block.mapped<shader::LightParams>(1)[0] = in.params;
    session.bindings().set().put_block(shader::BIND_LIGHT, block);
    gpu::Commands& commands = session.commands();
    commands.run([&] { commands.span(name, [&] { pass(commands, in.variant); }); });
    add_times(cost.times, commands.span_times());
}

}  // namespace

bool SplatStore::light(const VolumeStore& volume, const Scene& scene, SetupCost& cost) {
    const bool occluded = occlude(volume, scene, cost);
    return cast_shadows(volume, scene, cost) || occluded;
}

bool SplatStore::occlude(const VolumeStore& volume, const Scene& scene, SetupCost& cost) {
    if (!occludes_ambient(scene)) {
        lists_.occlusion = {};
        occluded_.reset();
        return false;
    }
    const OcclusionPlan plan = plan_occlusion(scene);
    if (occluded_ == plan) return false;
    occluded_.reset();
    lists_.occlusion = {};
    bind(volume);
    lists_.occlusion = light_list(session_->device(), &SplatLists::occlusion, lists_.splat_count);
    LightInputs in(lists_, *volume.volume(), plan.matter, lists_.occlusion);
    in.params.radius = static_cast<float>(plan.radius);
    run_light(*session_, "2b_occlude_ambient", in, passes::occlude_ambient, cost);
    occluded_ = plan;
    return true;
}

bool SplatStore::cast_shadows(const VolumeStore& volume, const Scene& scene, SetupCost& cost) {
    const ShadowPlan plan = plan_shadows(scene);
    if (plan.lights.empty()) {
        lists_.shadows = {};
        shadowed_.reset();
        return false;
    }
    if (shadowed_ == plan) return false;
    shadowed_.reset();
    lists_.shadows = {};
    bind(volume);
    lists_.shadows = light_list(session_->device(), &SplatLists::shadows, lists_.splat_count);
    const VolumeGeometry& geometry = volume.volume()->geometry;
    LightInputs in(lists_, *volume.volume(), plan.matter, lists_.shadows);
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    for (const Light& light : plan.lights) {
        const bool far = light.kind == Light::Kind::Directional;
        in.params.light = far ? glm::vec4(glm::normalize(to_index * glm::normalize(light.direction)), 0)
                              : glm::vec4(geometry.to_index(light.position), 1);
        run_light(*session_, "2c_cast_shadows", in, passes::cast_shadows, cost);
        ++in.params.channel;
    }
    shadowed_ = plan;
    return true;
}

}  // namespace edgesplat
