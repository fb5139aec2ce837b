#include "engine/forecast/description.h"

#include <algorithm>
#include <array>
#include <map>

#include "engine/error.h"
#include "engine/forecast/description_passes.h"

namespace edgesplat {
namespace {

/// Every effect that the request enables, with the reason.
std::vector<std::pair<const Effect*, std::string>> active_effects(const FrameRequest& request) {
    std::vector<std::pair<const Effect*, std::string>> found;
    for (const Effect& effect : effect_table()) {
        std::string reason = effect.reason(request);
        if (!reason.empty()) found.emplace_back(&effect, std::move(reason));
    }
    return found;
}

/// The reasons of the effects whose `list` contains `name`.
std::string reason_for(const std::vector<std::pair<const Effect*, std::string>>& effects, std::string_view name,
                       std::vector<std::string_view> Effect::*list) {
    std::string text;
    for (const auto& [effect, reason] : effects) {
        const auto& names = effect->*list;
        if (std::ranges::find(names, name) == names.end()) continue;
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", effect->name, reason);
    }
    return text.empty() ? "every picture" : text;
}

std::string format_name(vk::Format format) {
    switch (format) {
        case vk::Format::eR8Uint:
            return "r8ui";
        case vk::Format::eD16Unorm:
            return "d16";
        case vk::Format::eR16Sfloat:
            return "r16f";
        case vk::Format::eR32Sfloat:
            return "r32f";
        case vk::Format::eR32G32Uint:
            return "rg32ui";
        case vk::Format::eR16G16B16A16Sfloat:
            return "rgba16f";
        case vk::Format::eR32G32B32A32Sfloat:
            return "rgba32f";
        default:
            return vk::to_string(format);
    }
}

std::string shape_of(const PlannedResource& resource) {
    if (!resource.image) return "";
    const auto& [format, size, layers, volume, array, usage] = *resource.image;
    if (volume) return fmt::format("{} x {} x {}", size.x, size.y, size.z);
    return layers > 1 ? fmt::format("{} x {} x {}", size.x, size.y, layers) : fmt::format("{} x {}", size.x, size.y);
}

const char* name_of(Held held) {
    switch (held) {
        case Held::Uploading:
            return "while uploading";
        case Held::Lighting:
            return "while lighting";
        case Held::Drawing:
            return "while drawing";
        case Held::Always:
            break;
    }
    return "always";
}

/// Bytes of the rows of time "always" plus the largest sum over any other time.
template <typename Rows, typename Time, typename Bytes>
std::uint64_t most_at_once(const Rows& rows, const Time& time, const Bytes& bytes) {
    std::map<std::string, std::uint64_t> sums;
    for (const auto& row : rows)
        sums[time(row)] += bytes(row);
    const std::uint64_t always = sums["always"];
    sums["always"] = 0;
    return always + std::ranges::max_element(sums, {}, [](const auto& s) { return s.second; })->second;
}

std::uint64_t sum_of(const std::vector<PlannedResource>& resources) {
    return most_at_once(
        resources, [](const PlannedResource& r) { return std::string(name_of(r.held)); },
        [](const PlannedResource& r) { return r.bytes; });
}

/// Whether the effect has no passes of its own or one of them is in `passes`.
bool runs(const Effect& effect, const std::vector<PassDescription>& passes) {
    return effect.passes.empty() || std::ranges::any_of(effect.passes, [&](std::string_view name) {
               return std::ranges::find(passes, name, &PassDescription::name) != passes.end();
           });
}

/// Lists the effects that are off, with what each would add.
std::vector<LeftOut> left_out(const FrameRequest& request, const FrameForecast& forecast,
                              const std::vector<std::pair<const Effect*, std::string>>& on) {
    std::vector<LeftOut> rows;
    for (const Effect& effect : effect_table()) {
        if (std::ranges::any_of(on, [&](const auto& entry) { return entry.first == &effect; })) continue;
        LeftOut row{std::string(effect.name), std::string(effect.call), {}, 0, {}};
        FrameRequest with = request;
        try {
            effect.turn_on(with);
            validate(with.scene);
            if (effect.reason(with).empty()) {
                row.obstacle = "it has no effect with the other settings of this picture";
            } else {
                const auto count = [&](const FrameRequest& part, const CollectionPlan& collection) {
                    return collection == forecast.collection ? forecast.splats : count_splats_of(part, collection);
                };
                const FrameForecast other = forecast_frame(with, count, *forecast.profile);
                if (!runs(effect, described_passes(with, other))) {
                    row.obstacle = "device profile " + std::string(forecast.profile->name) + " does not use it";
                    rows.push_back(std::move(row));
                    continue;
                }
                row.bytes = static_cast<std::int64_t>(sum_of(other.resources)) -
                            static_cast<std::int64_t>(sum_of(forecast.resources));
                for (const std::string_view pass : effect.passes)
                    if (reason_for(on, pass, &Effect::passes) == "every picture") row.passes.emplace_back(pass);
            }
        } catch (const Error& error) {
            row.obstacle = error.what();
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

FrameDescription describe(const FrameRequest& request, const FrameForecast& forecast, const DeviceInfo* device) {
    auto effects = active_effects(request);
    const glm::ivec3 dims = request.volume->geometry.dims;
    const FramePlan& plan = forecast.draws.front().plan;
    FrameDescription out;
    out.volume = fmt::format("{}, {} x {} x {} voxels", request.volume->name, dims.x, dims.y, dims.z);
    if (device != nullptr) {
        out.device = device->name;
        out.profile = device->profile;
        out.profile_reason = device->profile_reason;
    }
    out.size = request.size;
    out.voxels = request.volume->geometry.voxel_count();
    for (const FrameForecast* part : forecast_parts(forecast))
        out.splats += part->splats.extent.count;
    out.splats_from = forecast.splats.from == SplatCount::From::Frame ? "as collected" : "counted on the host";
    out.sheets = plan.params.sheet_count;
    out.sheet_groups = plan.params.group_count;
    out.passes = described_passes(request, forecast);
    // Remove effects that the request enables but this device does not use.
    std::erase_if(effects, [&](const auto& entry) { return !runs(*entry.first, out.passes); });
    for (PassDescription& pass : out.passes)
        pass.reason = reason_for(effects, pass.name, &Effect::passes);
    std::map<std::size_t, std::uint64_t> of_volumes;
    for (const PlannedResource& resource : forecast.resources) {
        if (resource.volume) of_volumes[*resource.volume] += resource.bytes;
        const auto same = std::ranges::find_if(out.resources, [&](const ResourceDescription& r) {
            return r.name == resource.text.name && r.held == name_of(resource.held);
        });
        if (same != out.resources.end()) {
            same->bytes += resource.bytes;  // placeholders share a name
            continue;
        }
        ResourceDescription row{resource.text.name,
                                shape_of(resource),
                                resource.image ? format_name(resource.image->format) : "buffer",
                                std::string(resource.text.contents),
                                std::string(resource.text.written),
                                std::string(resource.text.read),
                                reason_for(effects, resource.text.name, &Effect::resources),
                                resource.bytes,
                                {},
                                {},
                                name_of(resource.held)};
        out.resources.push_back(std::move(row));
    }
    for (const auto& [number, bytes] : of_volumes)
        if (of_volumes.size() > 1) out.volumes.emplace_back(request_of_volume(request, number).volume->name, bytes);
    out.record = {
        {"voxel", "every picture", 4}, {"normal", "every picture", 4}, {"edge, material", "every picture", 4}};
    for (const auto& [effect, reason] : effects) {
        for (const RecordField& field : effect->record)
            out.record.push_back({std::string(field.name), fmt::format("{}: {}", effect->name, reason), field.bytes});
        out.active_effects.emplace_back(std::string(effect->name), reason);
    }
    out.left_out = left_out(request, forecast, effects);
    return out;
}

void check(const FrameRequest& request) {
    if (!request.volume) fail("description: no volume");
    validate(request.scene);
    validate(request.settings);
}

}  // namespace

std::uint64_t FrameDescription::total_bytes() const {
    return most_at_once(
        resources, [](const ResourceDescription& r) { return r.held; },
        [](const ResourceDescription& r) { return r.allocated_bytes.value_or(r.device_bytes.value_or(r.bytes)); });
}

FrameDescription describe_frame(const FrameRequest& request, const std::string& profile) {
    check(request);
    const gpu::ChosenProfile chosen = gpu::choose_profile(profile);
    FrameDescription out = describe(request, forecast_frame(request, count_splats_of, *chosen.profile), nullptr);
    out.profile = chosen.profile->name;
    out.profile_reason = chosen.reason;
    return out;
}

FrameDescription describe_frame(const FrameRequest& request, Renderer& renderer, const RenderStats* measured) {
    check(request);
    const FrameForecast forecast = renderer.forecast(request);
    FrameDescription out = describe(request, forecast, &renderer.device());
    std::map<std::pair<std::string, std::string>, std::uint64_t> required;
    for (const PlannedResource& resource : forecast.resources)
        required[{resource.text.name, name_of(resource.held)}] += renderer.required_bytes(resource);
    for (ResourceDescription& resource : out.resources)
        resource.device_bytes = required.at({resource.name, resource.held});
    if (measured == nullptr) return out;
    for (const MemoryUse& use : measured->memory) {
        // If a name occurs with several lifetimes, the measured peak belongs to the largest.
        ResourceDescription* counted = nullptr;
        for (ResourceDescription& r : out.resources)
            if (r.name == use.name && (counted == nullptr || *r.device_bytes > *counted->device_bytes)) counted = &r;
        if (counted != nullptr) counted->allocated_bytes = use.bytes;
    }
    for (PassDescription& pass : out.passes) {
        const bool extra = pass.draw != "setup" && pass.draw != "colour";
        const auto found =
            std::ranges::find(measured->passes, extra ? pass.draw + ": " + pass.name : pass.name, &PassTime::name);
        if (found != measured->passes.end()) pass.measured_milliseconds = found->milliseconds;
    }
    std::erase_if(out.passes, [](const PassDescription& pass) { return pass.depends && !pass.measured_milliseconds; });
    return out;
}

}  // namespace edgesplat
