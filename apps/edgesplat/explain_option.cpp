#include "apps/edgesplat/explain_option.h"

#include <algorithm>

#include "apps/edgesplat/option_values.h"

namespace {

using nlohmann::ordered_json;

ordered_json number_or_null(const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json();
}

ordered_json number_or_null(const std::optional<std::uint64_t>& value) {
    return value ? ordered_json(*value) : ordered_json();
}

}  // namespace

void add_explain_options(CLI::App& command, ExplainOption& option) {
    constexpr const char* kGroup = "Plan and memory";
    command
        .add_flag("--explain", option.explain,
                  "Print the plan: passes, memory and splat record, each with its reason, and the effects left out, "
                  "with their cost. Without -o nothing is rendered and no device is needed")
        ->group(kGroup);
    add_number(command, "--memory-budget", option.memory_budget, {0, 1e9},
               "Limit of device memory, MiB. A picture that needs more is refused before it is rendered; the message "
               "lists changes that fit. 0: all memory of the device")
        ->group(kGroup);
}

ordered_json to_json(const edgesplat::FrameDescription& d) {
    ordered_json passes = ordered_json::array(), resources = ordered_json::array(), record = ordered_json::array(),
                 effects = ordered_json::object(), left_out = ordered_json::array();
    for (const auto& pass : d.passes) {
        ordered_json variants = ordered_json::array();
        for (const auto& pipeline : pass.pipelines)
            variants.push_back(edgesplat::text_of(pipeline));
        passes.push_back({{"for", pass.draw},
                          {"name", pass.name},
                          {"reason", pass.reason},
                          {"variants", variants},
                          {"measured_ms", number_or_null(pass.measured_milliseconds)}});
    }
    for (const auto& r : d.resources) {
        resources.push_back({{"name", r.name},
                             {"format", r.format},
                             {"shape", r.shape},
                             {"contents", r.contents},
                             {"written", r.written},
                             {"read", r.read},
                             {"reason", r.reason},
                             {"held", r.held},
                             {"bytes", r.bytes},
                             {"device_bytes", number_or_null(r.device_bytes)},
                             {"allocated_bytes", number_or_null(r.allocated_bytes)}});
    }
    for (const auto& field : d.record)
        record.push_back({{"name", field.name}, {"bytes", field.bytes}, {"reason", field.reason}});
    for (const auto& [effect, reason] : d.active_effects)
        effects[effect] = reason;
    for (const auto& row : d.left_out) {
        left_out.push_back({{"effect", row.effect},
                            {"call", row.call},
                            {"passes", row.passes},
                            {"bytes", row.bytes},
                            {"obstacle", row.obstacle}});
    }
    auto of_volumes = ordered_json::array();
    for (const auto& [name, bytes] : d.volumes)
        of_volumes.push_back({{"name", name}, {"bytes", bytes}});
    return {{"device_profile", d.profile},
            {"device_profile_reason", d.profile_reason},
            {"splats", d.splats},
            {"splats_from", d.splats_from},
            {"sheets", d.sheets},
            {"sheet_groups", d.sheet_groups},
            {"total_bytes", d.total_bytes()},
            {"volumes", of_volumes},
            {"effects", effects},
            {"passes", passes},
            {"resources", resources},
            {"record", record},
            {"left_out", left_out}};
}
