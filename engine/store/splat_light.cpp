// SplatStore: the light that reaches each splat.
#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/passes/2b_occlude_ambient.h"
#include "engine/passes/2c_cast_shadows.h"
#include "engine/plan/plan.h"
#include "engine/plan/resource_table.h"
#include "engine/scene/transfer_function.h"
#include "engine/scene/volume_order.h"
#include "engine/store/splat_store.h"

namespace edgesplat {
namespace {

gpu::Buffer light_list(const gpu::Device& device, gpu::Buffer SplatLists::*list, std::uint64_t splats) {
    return {device, splats * kLightBytes, gpu::Buffer::Place::Device, row_of(list).text.name};
}

/// A volume whose matter attenuates the light of a list's splats.
struct Occluder {
    const VolumeStore& volume;
    Matter matter;
    shader::Address transfer;     ///< its transfer function
    const Volume* own = nullptr;  ///< the splats' volume, if that is another one
    Clip own_clip{};              ///< planes that cut that volume
};

/// Inputs of passes 2b and 2c. The caller sets what only one of them reads.
struct LightInputs {
    LightInputs(const SplatLists& lists, const VolumeGeometry& geometry, const Occluder& occluder,
                const gpu::Buffer& reach) {
        const Volume& volume = *occluder.volume.volume();
        const Matter& matter = occluder.matter;
        place_iso_values(volume, matter.iso_values, params.iso);
        params.normal_to_world = glm::mat3(glm::transpose(glm::inverse(geometry.index_to_world_axes)));
        std::ranges::transform(matter.extinction, std::begin(params.extinction),
                               [](double extinction) { return static_cast<float>(extinction); });
        params.splat_count = static_cast<std::uint32_t>(lists.splat_count);
        params.reach = reach.address();
        const Clip& clip = occluder.own && matter.clip.empty() ? occluder.own_clip : matter.clip;
        variant = {.splat_count = lists.splat_count,
                   .iso_count = static_cast<std::uint32_t>(matter.iso_values.size()),
                   .clip = place_clip(clip, geometry, glm::dvec3(0), params.clip_keep, params.clip_remove),
                   .surfaces = lists.surfaces,
                   .transfer = !matter.transfer.empty(),
                   .beside = occluder.own != nullptr};
        if (!occluder.own) return;
        const VolumeGeometry& other = volume.geometry;
        const glm::dmat3 to_matter = glm::inverse(other.index_to_world_axes) * geometry.index_to_world_axes;
        params.to_matter = glm::mat3(to_matter);
        params.to_splats = glm::mat3(glm::inverse(to_matter));
        params.matter_normals = glm::mat3(glm::transpose(glm::inverse(other.index_to_world_axes)));
        params.matter_at = glm::vec3(other.to_index(geometry.origin));
        params.matter_dims = other.dims;
        params.matter_transfer = occluder.transfer;
        params.cuts_splats = occluder.own_clip.empty() ? 0U : 1U;
        params.cuts_matter = matter.clip.empty() ? 0U : 1U;
    }
    shader::LightParams params{};
    passes::SplatLight variant;
};

/// The splats' own volume, then the others.
std::vector<Occluder> occluders_of(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside) {
    std::vector<Occluder> all{{volume, Matter(scene), {}}};
    for (const LitVolume& other : beside) {
        const gpu::Buffer& transfer = other.level->splats.lists().transfer;
        all.push_back({other.level->volume, Matter(other.scene), transfer ? transfer.address() : shader::Address(),
                       volume.volume().get(), scene.effects.clip});
    }
    return all;
}

std::vector<MatterBeside> matter_of(std::span<const LitVolume> beside) {
    std::vector<MatterBeside> all;
    for (const LitVolume& other : beside)
        all.emplace_back(other.scene, *other.level->volume.volume());
    return all;
}

/// Runs one of the passes and waits.
void run_light(DeviceSession& session, const Occluder& occluder, const LightInputs& in,
               gpu::Pass (*pass)(const passes::SplatLight&), SetupCost& cost) {
    session.bindings().write_volume(occluder.volume.images());
    const gpu::Buffer block(session.device(), sizeof(shader::LightParams), gpu::Buffer::Place::Host, kLightBlock.name);
    block.mapped<shader::LightParams>(1)[0] = in.params;
    session.bindings().set().put_block(shader::BIND_LIGHT, block);
    gpu::Commands& commands = session.commands();
    commands.run([&] { commands.pass(pass(in.variant)); });
    add_times(cost.times, commands.span_times());
}

}  // namespace

bool SplatStore::light(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside,
                       SetupCost& cost) {
    const bool occluded = occlude(volume, scene, beside, cost);
    return cast_shadows(volume, scene, beside, cost) || occluded;
}

bool SplatStore::occlude(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside,
                         SetupCost& cost) {
    if (!occludes_ambient(scene)) {
        lists_.occlusion = {};
        occluded_.reset();
        return false;
    }
    OcclusionPlan plan = plan_occlusion(scene, matter_of(beside));
    if (occluded_ == plan) return false;
    occluded_.reset();
    lists_.occlusion = {};
    bind(volume);
    lists_.occlusion = light_list(session_->device(), &SplatLists::occlusion, lists_.splat_count);
    for (const Occluder& occluder : occluders_of(volume, scene, beside)) {
        LightInputs in(lists_, volume.volume()->geometry, occluder, lists_.occlusion);
        in.params.radius = static_cast<float>(plan.radius);
        run_light(*session_, occluder, in, passes::occlude_ambient, cost);
    }
    occluded_ = std::move(plan);
    return true;
}

bool SplatStore::cast_shadows(const VolumeStore& volume, const Scene& scene, std::span<const LitVolume> beside,
                              SetupCost& cost) {
    ShadowPlan plan = plan_shadows(scene, matter_of(beside));
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
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    for (const Occluder& occluder : occluders_of(volume, scene, beside)) {
        LightInputs in(lists_, geometry, occluder, lists_.shadows);
        for (const Light& light : plan.lights) {
            const bool far = light.kind == Light::Kind::Directional;
            in.params.light = far ? glm::vec4(glm::normalize(to_index * glm::normalize(light.direction)), 0)
                                  : glm::vec4(geometry.to_index(light.position), 1);
            run_light(*session_, occluder, in, passes::cast_shadows, cost);
            ++in.params.channel;
        }
    }
    shadowed_ = std::move(plan);
    return true;
}

bool light_volumes(std::span<const LitVolume> volumes, SetupCost& cost) {
    // Products are rounded, so their order must be that of the volumes themselves.
    std::vector<LitVolume> sorted(volumes.begin(), volumes.end());
    std::ranges::stable_sort(sorted, {},
                             [](const LitVolume& lit) { return volume_order(*lit.level->volume.volume(), lit.scene); });
    bool ran = false;
    for (const LitVolume& lit : volumes) {
        std::vector<LitVolume> beside;
        std::ranges::copy_if(sorted, std::back_inserter(beside), [&](const LitVolume& other) {
            return other.level != lit.level && has_matter(other.scene);
        });
        LevelStore& level = *lit.level;
        for (SplatStore* list : {&level.surfaces, &level.splats})
            if (list->collected()) ran = list->light(level.volume, lit.scene, beside, cost) || ran;
    }
    return ran;
}

}  // namespace edgesplat
