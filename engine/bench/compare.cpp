#include "engine/bench/compare.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/bench/run_output.h"
#include "engine/bench/text_table.h"
#include "engine/error.h"
#include "engine/scene/text_file.h"

namespace edgesplat::bench {
namespace {

using nlohmann::ordered_json;
using Pointer = ordered_json::json_pointer;

/// Fewest samples from which the scatter can be judged.
constexpr double kMinSamples = 3;

enum class Kind { Sampled, Once, Count };

struct Metric {
    const char* name;
    const char* path;
    Kind kind;
};

constexpr std::array<Metric, 18> kMetrics{{{"frame", "/frame_ms", Kind::Sampled},
                                           {"ratio", "/ratio", Kind::Sampled},
                                           {"processor", "/processor_ms", Kind::Sampled},
                                           {"ray", "/raycast_ms", Kind::Sampled},
                                           {"select", "/passes_ms/3_select_footprints", Kind::Sampled},
                                           {"sort", "/passes_ms/4_sort_sheets", Kind::Sampled},
                                           {"tiles", "/passes_ms/4_sort_tiles", Kind::Sampled},
                                           {"draw tiles", "/passes_ms/5_draw_tiles", Kind::Sampled},
                                           {"draw", "/passes_ms/5_draw_splats", Kind::Sampled},
                                           {"composite", "/passes_ms/6_composite_sheet", Kind::Sampled},
                                           {"setup", "/setup_ms", Kind::Sampled},
                                           {"first", "/cold/first_picture_ms", Kind::Once},
                                           {"shaded", "/shaded_fragments", Kind::Count},
                                           {"fragments", "/fragments", Kind::Count},
                                           {"vertices", "/vertices", Kind::Count},
                                           {"drawn", "/splats/drawn", Kind::Count},
                                           {"device", "/device_bytes", Kind::Count},
                                           {"host", "/host_peak_bytes", Kind::Once}}};

std::optional<double> number_in(const ordered_json& json, const std::string& path) {
    const Pointer at(path);
    if (!json.contains(at) || !json.at(at).is_number()) return std::nullopt;
    return json.at(at).get<double>();
}

MetricChange change_of(const Metric& metric, const ordered_json& earlier, const ordered_json& later) {
    const std::string path = metric.path;
    MetricChange change{metric.name, {}, false};
    const std::string value = metric.kind == Kind::Sampled ? path + "/median" : path;
    const auto before = number_in(earlier, value), after = number_in(later, value);
    if (!before || !after) return change;
    if (*before > 0 && *after > 0) change.ratio = *after / *before;
    if (metric.kind == Kind::Count) change.beyond_scatter = *before != *after;
    if (metric.kind != Kind::Sampled) return change;
    const auto count = [&](const ordered_json& json) { return number_in(json, path + "/samples").value_or(0); };
    if (std::min(count(earlier), count(later)) < kMinSamples) return change;
    const auto low = [&](const ordered_json& json) { return number_in(json, path + "/p10").value_or(-INFINITY); };
    const auto high = [&](const ordered_json& json) { return number_in(json, path + "/p90").value_or(INFINITY); };
    change.beyond_scatter = low(later) > high(earlier) || high(later) < low(earlier);
    return change;
}

const ordered_json* case_named(const ordered_json& run, const std::string& name) {
    for (const ordered_json& entry : run.at("cases"))
        if (entry.at("name") == name) return &entry;
    return nullptr;
}

}  // namespace

Comparison compare_runs(const ordered_json& earlier, const ordered_json& later) {
    Comparison comparison;
    const auto note_difference = [&](const char* what, const ordered_json& before, const ordered_json& after) {
        if (before != after)
            comparison.notes.push_back(fmt::format("{}: {} before, {} now", what, before.dump(), after.dump()));
    };
    note_difference("program", earlier.at("program"), later.at("program"));
    note_difference("device", earlier.at("device"), later.at("device"));
    note_difference("cores", earlier.at("cores"), later.at("cores"));
    for (const ordered_json& entry : later.at("cases")) {
        const auto name = entry.at("name").get<std::string>();
        const ordered_json* before = case_named(earlier, name);
        if (before == nullptr) {
            comparison.notes.push_back(fmt::format("{}: not in the earlier run", name));
            continue;
        }
        if (before->at("checksum") != entry.at("checksum"))
            comparison.notes.push_back(fmt::format("{}: the volume's samples have changed", name));
        CaseChange change{name, {}};
        for (const Metric& metric : kMetrics)
            change.metrics.push_back(change_of(metric, *before, entry));
        comparison.cases.push_back(std::move(change));
    }
    for (const ordered_json& entry : earlier.at("cases")) {
        const auto name = entry.at("name").get<std::string>();
        if (case_named(later, name) == nullptr)
            comparison.notes.push_back(fmt::format("{}: only in the earlier run", name));
    }
    return comparison;
}

std::string comparison_table(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows(1, {"new / old"});
    for (const Metric& metric : kMetrics)
        rows[0].emplace_back(metric.name);
    std::vector<double> logs(kMetrics.size(), 0);
    std::vector<int> counts(kMetrics.size(), 0);
    for (const CaseChange& change : comparison.cases) {
        auto& row = rows.emplace_back(1, change.name);
        for (std::size_t m = 0; m < change.metrics.size(); ++m) {
            const MetricChange& metric = change.metrics[m];
            if (!metric.ratio) {
                row.emplace_back(metric.beyond_scatter ? "*" : "- ");
                continue;
            }
            row.push_back(fmt::format("{:.2f}{}", *metric.ratio, metric.beyond_scatter ? '*' : ' '));
            logs[m] += std::log(*metric.ratio);
            ++counts[m];
        }
    }
    auto& mean = rows.emplace_back(1, "geometric mean");
    for (std::size_t m = 0; m < logs.size(); ++m)
        mean.push_back(counts[m] == 0 ? "- " : fmt::format("{:.2f} ", std::exp(logs[m] / counts[m])));
    std::string out = text_table(rows);
    out += fmt::format(
        "* beyond the scatter of both runs: p10 to p90 of at least {} samples do not overlap; counts: they differ\n",
        kMinSamples);
    for (const std::string& note : comparison.notes)
        out.append(note).append("\n");
    return out;
}

ordered_json read_run(const std::filesystem::path& path) {
    ordered_json run = ordered_json::parse(read_text_file(path, "a bench.json"), nullptr, false);
    if (run.is_discarded() || !run.is_object() || run.value("schema", "") != kSchema)
        fail("{}: is not a bench.json of this version; expected \"schema\": \"{}\"", path.string(), kSchema);
    return run;
}

}  // namespace edgesplat::bench
