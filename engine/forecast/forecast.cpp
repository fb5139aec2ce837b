#include "engine/forecast/forecast.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "engine/passes/2_collect_splats.h"
#include "engine/scene/mixture.h"
#include "engine/scene/transfer_function.h"
#include "engine/scene/volume_order.h"
#include "engine/store/light.h"
#include "engine/volume/filters.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

/// 1 if the cube [-reach, reach]^3 around the voxel lies in the volume and is opaque. One axis at a time, as pass 1a.
std::vector<std::uint8_t> buried_voxels(std::vector<std::uint8_t> opaque, const glm::ivec3& dims, int reach) {
    const std::size_t strides[3] = {1, static_cast<std::size_t>(dims.x),
                                    static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y)};
    std::vector<std::uint8_t> line;
    for (int axis = 0; axis < 3; ++axis) {
        const int count = dims[axis], a = (axis + 1) % 3, b = (axis + 2) % 3;
        line.resize(static_cast<std::size_t>(count));
        for (int i = 0; i < dims[a]; ++i) {
            for (int j = 0; j < dims[b]; ++j) {
                std::uint8_t* first =
                    &opaque[static_cast<std::size_t>(i) * strides[a] + static_cast<std::size_t>(j) * strides[b]];
                for (int k = 0; k < count; ++k)
                    line[static_cast<std::size_t>(k)] = first[static_cast<std::size_t>(k) * strides[axis]];
                int run = 0;
                for (int k = 0; k < count; ++k) {
                    run = line[static_cast<std::size_t>(k)] != 0 ? run + 1 : 0;
                    if (k >= reach) {
                        first[static_cast<std::size_t>(k - reach) * strides[axis]] = run > 2 * reach ? 1 : 0;
                    }
                }
                for (int k = std::max(count - reach, 0); k < count; ++k)
                    first[static_cast<std::size_t>(k) * strides[axis]] = 0;
            }
        }
    }
    return opaque;
}

/// is_cut_away() of shaders/common/clip.glsl, in the same precision.
bool is_cut_away(const shader::SceneParams& params, const passes::ClipCount& clip, const glm::vec3& at, float radius) {
    bool beyond = false, within = clip.remove > 0;
    for (std::uint32_t i = 0; i < clip.keep; ++i)
        beyond = beyond || glm::dot(params.clip_keep[i], glm::vec4(at, 1)) > radius;
    for (std::uint32_t i = 0; i < clip.remove; ++i)
        within = within && glm::dot(params.clip_remove[i], glm::vec4(at, 1)) < -radius;
    return beyond || within;
}

constexpr std::uint8_t kMissing = 0x80;  ///< marks the material of a sample without data

/// Bit mask of the materials between the samples around a voxel, its own included, as in
/// shaders/edges/1b_estimate_edges.comp.
std::uint32_t materials_around(std::span<const std::uint8_t> materials, const glm::ivec3& dims, const glm::ivec3& p) {
    const auto material = [&](const glm::ivec3& o) {
        const glm::ivec3 q = glm::clamp(p + o, glm::ivec3(0), dims - 1);
        return materials[static_cast<std::size_t>(q.x) +
                         static_cast<std::size_t>(dims.x) *
                             (static_cast<std::size_t>(q.y) +
                              static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(q.z))];
    };
    const std::uint8_t own = material(glm::ivec3(0)) & ~kMissing;
    std::uint8_t least = own, most = own;
    for (int i = 0; i < 33; ++i) {
        glm::ivec3 o = i < 27 ? glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1 : glm::ivec3(0);
        if (i >= 27) o[(i - 27) / 2] = i % 2 == 1 ? -2 : 2;
        const std::uint8_t other = material(o);
        // Matter of a missing sample's own material is not there.
        const auto lowest = static_cast<std::uint8_t>(other >= kMissing ? (other & ~kMissing) + 1 : other);
        least = std::min(least, lowest);
        most = std::max<std::uint8_t>(most, other & ~kMissing);
    }
    return (2U << most) - (1U << least);
}

}  // namespace

SplatCount most_splats(const CollectionPlan& plan) {
    const glm::dvec3 dims(plan.dims);
    const auto voxels = static_cast<std::uint64_t>(dims.x * dims.y * dims.z);
    const std::uint32_t carried = plan.params.translucent_mask, others = plan.params.visible_mask & ~carried;
    const auto of_a_voxel = static_cast<std::uint64_t>(std::popcount(carried) + (others != 0 ? 1 : 0));
    return {SplatCount::From::Voxels, {voxels * of_a_voxel, glm::ivec3(0), plan.dims - 1}};
}

namespace {

/// Whether matter of the voxel's material ends on one of its six sides (2_collect_splats).
bool ends_beside(const Volume& volume, const shader::SceneParams& params, const std::vector<std::uint8_t>& materials,
                 const glm::ivec3& at) {
    const glm::ivec3 dims = volume.geometry.dims;
    const auto index = [&](const glm::ivec3& i) {
        const auto row =
            static_cast<std::size_t>(i.y) + static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(i.z);
        return static_cast<std::size_t>(i.x) + static_cast<std::size_t>(dims.x) * row;
    };
    const auto value = [&](const glm::ivec3& i) { return scaled_sample(volume, volume.values[index(i)]); };
    for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
            glm::ivec3 beside = at, before = at;
            beside[axis] += step;
            before[axis] = std::clamp(at[axis] - step, 0, dims[axis] - 1);
            const bool outermost = beside[axis] < 0 || beside[axis] == dims[axis];
            const std::uint32_t there = outermost ? material_of(params.iso, scaled_at_border(value(at), value(before)))
                                                  : materials[index(beside)];
            if (there != materials[index(at)]) return true;
        }
    return false;
}

}  // namespace

SplatCount count_splats(const Volume& volume, const CollectionPlan& plan) {
    const auto& params = plan.params;
    const glm::ivec3 dims = plan.dims;
    const auto voxels = static_cast<std::uint64_t>(volume.values.size());
    const auto nx = static_cast<std::uint64_t>(dims.x), ny = static_cast<std::uint64_t>(dims.y);
    std::vector<std::uint8_t> materials(voxels), splats(voxels), opaque(plan.buried ? voxels : 0);
    for (std::uint64_t i = 0; i < voxels; ++i) {
        materials[i] = static_cast<std::uint8_t>(material_of(params.iso, scaled_sample(volume, volume.values[i])));
        if (!volume.has_data(i)) materials[i] |= kMissing;
    }
    for (std::uint64_t i = 0; i < voxels; ++i) {
        const glm::ivec3 at(static_cast<int>(i % nx), static_cast<int>(i / nx % ny), static_cast<int>(i / nx / ny));
        const std::uint32_t carried =
            params.translucent_mask == 0 ? 0 : params.translucent_mask & materials_around(materials, dims, at);
        const std::uint32_t here = 1U << (materials[i] & ~kMissing), own = volume.has_data(i) ? here : 0U;
        splats[i] = static_cast<std::uint8_t>(std::popcount((carried & ~here) | (params.visible_mask & own)));
        if (plan.buried && own != 0) {
            const std::uint32_t material = material_of(params.opaque_iso, scaled_sample(volume, volume.values[i]));
            opaque[i] = params.opaque_mask >> material & 1U;
        }
        if (plan.surfaces && !ends_beside(volume, params, materials, at)) splats[i] = 0;
        if (!plan.clip.any()) continue;
        if (is_cut_away(params, plan.clip, at, 0)) opaque[i] = 0;
        if (is_cut_away(params, plan.clip, at, params.reach)) splats[i] = 0;
    }
    if (plan.buried) {
        const auto buried = buried_voxels(std::move(opaque), dims, params.bury_distance);
        for (std::uint64_t i = 0; i < voxels; ++i)
            splats[i] = buried[i] == 0 ? splats[i] : 0;
    }
    SplatExtent out;
    VoxelBox box;
    BrickRuns(dims).each_brick([&](const VoxelBox& brick, std::uint64_t, std::uint64_t) {
        for (int z = brick.low.z; z <= brick.high.z; ++z) {
            std::uint64_t count = 0;
            for (int y = brick.low.y; y <= brick.high.y; ++y) {
                const std::uint64_t row = (static_cast<std::uint64_t>(z) * ny + static_cast<std::uint64_t>(y)) * nx;
                const auto at = splats.begin() + static_cast<std::ptrdiff_t>(row);
                count = std::accumulate(at + brick.low.x, at + brick.high.x + 1, count);
            }
            out.count += count;
            if (count > 0) box.add(brick.slice(z));
        }
    });
    out.low = box.empty() ? glm::ivec3(0) : box.low;
    out.high = box.empty() ? dims - 1 : box.high;
    return {SplatCount::From::Materials, out};
}

Settings drawn_settings(const FrameRequest& request) {
    return canonical_settings(request.settings, request.scene);
}

FrameRequest request_of_volume(const FrameRequest& request, std::size_t number) {
    FrameRequest one = request;
    one.scene = scene_of_volume(request.scene, number, request.volume->geometry);
    if (number > 0) one.volume = request.scene.added[number - 1].volume;
    one.number = number;
    return one;
}

std::vector<FrameRequest> parts_of_volume(const FrameRequest& request) {
    // Optical depth needs all voxels.
    auto mixture = request.outputs.tau ? std::nullopt : mixture_of(request.settings, request.scene, *request.volume);
    if (!mixture) {
        FrameRequest one = request;
        const bool surfaces = draws_surfaces(drawn_settings(request), request.scene, *request.volume);
        one.scene = surfaces ? scene_of_surfaces(request.scene) : scene_of_kernels(request.scene);
        return {one};
    }
    std::vector<FrameRequest> parts(2, request);
    parts[0].scene = scene_of_surfaces(std::move(mixture->surfaces));
    parts[1].scene = scene_of_kernels(std::move(mixture->kernels));
    parts[1].whole = request.scene;
    parts[0].mixed = parts[1].mixed = true;
    return parts;
}

namespace {

bool has_opaque_matter(const FrameRequest& part) {
    const std::uint32_t translucent = translucent_materials(part.scene, part.volume->geometry);
    for (std::size_t m = 0; m < part.scene.materials.size(); ++m)
        if (extinctions_of(part.scene, m).most > 0 && (translucent >> m & 1U) == 0) return true;
    return false;
}

/// Throws Error if a picture of several volumes has what they cannot be drawn with.
void check_several(const FrameRequest& request) {
    if (request.outputs.tau) fail("output tau: is of one volume, but the scene has several");
    const bool lit = occludes_ambient(request.scene) || !shadow_lights(request.scene).empty();
    for (const AddedVolume& added : request.scene.added)
        if (added.replaces && lit)
            fail(
                "volumes: {} replaces the others within its grid (rule = inside), which light does not know; expected "
                "no ambient occlusion and no shadows",
                added.volume->name);
}

/// Throws Error if a volume's kernels cannot be drawn with what other volumes have.
void check_kernels(const FrameRequest& part) {
    const Settings settings = drawn_settings(part);
    if (settings.sheet_format != SheetFormat::Tiles)
        fail("volumes: the kernels of {} would be drawn in layers, expected sheet_format = tiles", part.volume->name);
    if (has_opaque_matter(part) && draws_faces(settings))
        fail(
            "volumes: the opaque matter of {} would be drawn by kernels; several volumes need surface splats: "
            "opaque = surfaces, edges = cubic, sheet_format = tiles, no antialias",
            part.volume->name);
}

}  // namespace

std::vector<FrameRequest> drawn_parts(const FrameRequest& request) {
    if (request.scene.added.empty()) return parts_of_volume(request_of_volume(request, 0));
    check_several(request);
    std::vector<FrameRequest> surfaces, kernels;
    for (std::size_t number = 0; number <= request.scene.added.size(); ++number) {
        const FrameRequest one = request_of_volume(request, number);
        if (!has_matter(one.scene)) continue;
        for (FrameRequest& part : parts_of_volume(one)) {
            const bool opaque = draws_surfaces(drawn_settings(part), part.scene, *part.volume);
            (opaque ? surfaces : kernels).push_back(std::move(part));
        }
    }
    for (const FrameRequest& part : kernels)
        check_kernels(part);
    if (kernels.size() > shader::MAX_TOGETHER)
        fail("volumes: {} volumes have translucent matter, expected at most {}", kernels.size(), shader::MAX_TOGETHER);
    // The picture must not depend on the order of the volumes.
    for (std::vector<FrameRequest>* parts : {&surfaces, &kernels})
        std::ranges::stable_sort(*parts, {},
                                 [](const FrameRequest& part) { return volume_order(*part.volume, part.scene); });
    surfaces.insert(surfaces.end(), kernels.begin(), kernels.end());
    if (surfaces.empty()) surfaces.push_back(request_of_volume(request, 0));
    return surfaces;
}

bool are_of_several_volumes(std::span<const FrameRequest> parts) {
    return std::ranges::any_of(parts, [&](const FrameRequest& part) { return part.number != parts.front().number; });
}

CollectionPlan planned_collection(const FrameRequest& part) {
    return plan_collection(*part.volume, part.scene, drawn_settings(part), keeps_buried(part),
                           part.whole ? &*part.whole : nullptr);
}

bool keeps_buried(const FrameRequest& request) {
    const bool in_kernels = eye_in_opaque(*request.volume, request.scene, request.camera) &&
                            !draws_surfaces(drawn_settings(request), request.scene, *request.volume);
    return request.outputs.tau || in_kernels;
}

FrameForecast forecast_part(const FrameRequest& part, const CollectionPlan& collection, const SplatCount& splats,
                            double reach, const gpu::DeviceProfile& profile) {
    FrameForecast out;
    out.profile = &profile;
    out.number = part.number;
    out.settings = drawn_settings(part);
    out.collection = collection;
    out.splats = splats;
    out.splats.extent.surfaces = collection.surfaces;
    if (splats.from != SplatCount::From::Frame) {
        // Of surface splats, only those between two values have creases.
        out.splats.extent.creases &= collection.two_values;
        out.splats.extent.border = collection.surfaces ? faces_with_matter(*part.volume, collection.params) : 0;
    }
    for (const std::uint32_t payload : payloads_of(part.outputs)) {
        out.draws.push_back(
            {payload_name(payload), plan_frame(*part.volume, part.scene, part.camera, out.settings, part.size, payload,
                                               out.splats.extent, reach, profile.refines)});
    }
    out.occluded = occludes_ambient(part.scene);
    out.shadow_lights = shadow_lights(part.scene).size();
    out.resources = planned_resources(out);
    return out;
}

SplatCount most_splats_of(const FrameRequest&, const CollectionPlan& collection) {
    return most_splats(collection);
}

SplatCount count_splats_of(const FrameRequest& part, const CollectionPlan& collection) {
    return count_splats(*part.volume, collection);
}

namespace {

/// Notes in the plans that they are of parts of one picture. The last part of kernels draws those of all.
void mark_parts(std::vector<FrameForecast>& parts, bool several_volumes) {
    const auto kernels =
        std::ranges::find_if(parts, [](const FrameForecast& part) { return !part.collection.surfaces; });
    const bool mixed = kernels != parts.begin();
    for (FrameForecast& part : parts)
        for (ForecastDraw& draw : part.draws) {
            draw.plan.variant.mixed = mixed;
            draw.plan.variant.several = mixed && several_volumes;
        }
    if (parts.end() - kernels < 2) return;
    for (std::size_t i = 0; i < parts.back().draws.size(); ++i) {
        std::vector<FramePlan> plans;
        for (auto part = kernels; part != parts.end(); ++part)
            plans.push_back(part->draws[i].plan);
        parts.back().draws[i].plan = plan_together(plans);
    }
    for (auto part = kernels; part + 1 != parts.end(); ++part)
        part->draws.clear();
}

}  // namespace

FrameForecast forecast_frame(const FrameRequest& request, const SplatCounter& count,
                             const gpu::DeviceProfile& profile) {
    std::vector<FrameForecast> parts;
    const std::vector<FrameRequest> drawn = drawn_parts(request);
    for (const FrameRequest& part : drawn) {
        const CollectionPlan collection = planned_collection(part);
        parts.push_back(
            forecast_part(part, collection, count(part, collection), kernel_reach(drawn_settings(part)), profile));
    }
    if (parts.size() == 1) return std::move(parts.front());
    mark_parts(parts, are_of_several_volumes(drawn));
    FrameForecast out;
    for (FrameForecast& part : parts) {
        if (&part != &parts.front()) part.behind = std::make_shared<const FrameForecast>(std::move(out));
        out = std::move(part);
    }
    out.resources = planned_resources(out);
    return out;
}

std::vector<const FrameForecast*> forecast_parts(const FrameForecast& forecast) {
    std::vector<const FrameForecast*> parts;
    for (const FrameForecast* part = &forecast; part; part = part->behind.get())
        parts.insert(parts.begin(), part);
    return parts;
}

}  // namespace edgesplat
