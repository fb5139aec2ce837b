// Writes bench.json and bench.csv.
#include <algorithm>

#include "engine/bench/run_output.h"

namespace edgesplat::bench {
namespace {

using nlohmann::ordered_json;

ordered_json sampled_json(const Sampled& s) {
    return {{"median", s.median}, {"p95", s.p95}, {"p10", s.low}, {"p90", s.high}, {"samples", s.count}};
}

ordered_json times_json(const NamedTimes& times) {
    ordered_json out = ordered_json::object();
    for (const auto& [name, sample] : times)
        out[name] = sampled_json(sample);
    return out;
}

double nanoseconds_per_voxel(const Sampled& time, const CaseResult& result) {
    return time.median * 1e6 / result.voxels();
}

ordered_json case_json(const CaseResult& c) {
    const RenderStats& stats = c.stats;
    ordered_json per_voxel = {{"total", nanoseconds_per_voxel(c.setup, c)}};
    for (const auto& [name, sample] : c.setup_passes)
        per_voxel[name] = nanoseconds_per_voxel(sample, c);
    ordered_json memory = ordered_json::object();
    for (const MemoryUse& use : stats.memory)
        memory[use.name] = use.bytes;
    const auto counted = [&](std::uint64_t DrawCounts::*member) {
        return stats.draw_counts ? ordered_json((*stats.draw_counts).*member) : ordered_json();
    };
    return {{"name", c.name},
            {"group", c.group},
            {"mode", c.mode},
            {"series", c.series},
            {"volume", c.volume},
            {"checksum", c.checksum},
            {"dims", {c.dims.x, c.dims.y, c.dims.z}},
            {"voxels", stats.voxels},
            {"size", {c.size.x, c.size.y}},
            {"frame_ms", sampled_json(c.frame)},
            {"processor_ms", sampled_json(c.processor)},
            {"raycast_ms", sampled_json(c.raycast)},
            {"ratio", sampled_json(c.ratio)},
            {"wall_ratio", sampled_json(c.wall_ratio)},
            {"passes_ms", times_json(c.passes)},
            {"setup_ms", sampled_json(c.setup)},
            {"setup_passes_ms", times_json(c.setup_passes)},
            {"setup_ns_per_voxel", per_voxel},
            {"cold",
             {{"startup_ms", c.cold.startup_ms},
              {"first_picture_ms", c.cold.first_picture_ms},
              {"pipelines", c.cold.pipelines},
              {"pipeline_ms", c.cold.pipeline_ms}}},
            {"splats",
             {{"collected", stats.splats_collected},
              {"culled", stats.splats_culled},
              {"drawn", stats.splats_drawn},
              {"rejected", c.rejected()},
              {"edge", stats.edge_splats}}},
            {"vertices", counted(&DrawCounts::vertices)},
            {"fragments", counted(&DrawCounts::fragments)},
            {"shaded_fragments", counted(&DrawCounts::shaded)},
            {"sheets", stats.sheets},
            {"sheet_groups", stats.sheet_groups},
            {"dirty_share", stats.dirty_share ? ordered_json(*stats.dirty_share) : ordered_json()},
            {"submissions", stats.submissions},
            {"device_bytes", stats.device_bytes},
            {"memory", memory},
            {"host_peak_bytes", c.host_peak_bytes}};
}

/// Quotes texts with a comma, a quote or a line break; other values contain none of these.
std::string csv_cell(const ordered_json& value) {
    if (value.is_null()) return {};
    if (!value.is_string()) return value.dump();
    auto text = value.get<std::string>();
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text)
        out.append(c == '"' ? 2 : 1, c);
    return out + "\"";
}

/// Every value of a case under the path of its keys; each element of a list has its own column.
void flatten(const ordered_json& value, const std::string& path,
             std::vector<std::pair<std::string, std::string>>& out) {
    if (!value.is_structured()) return out.emplace_back(path, csv_cell(value)), void();
    for (const auto& [key, inside] : value.items())
        flatten(inside, path.empty() ? key : fmt::format("{}.{}", path, key), out);
}

}  // namespace

ordered_json run_json(const BenchRun& run) {
    ordered_json cases = ordered_json::array(), skipped = ordered_json::array(), scaling = ordered_json::array();
    for (const CaseResult& result : run.cases)
        cases.push_back(case_json(result));
    for (const SkippedCase& entry : run.skipped)
        skipped.push_back({{"name", entry.name}, {"reason", entry.reason}});
    for (const Scaling& s : run.scaling)
        scaling.push_back({{"series", s.series},
                           {"mode", s.mode},
                           {"size", {s.size.x, s.size.y}},
                           {"cost", s.cost},
                           {"exponent", s.fit.exponent},
                           {"factor", s.fit.factor},
                           {"residual", s.fit.residual},
                           {"points", s.fit.points}});
    const DeviceInfo& device = run.device;
    return {{"schema", kSchema},
            {"program", run.program},
            {"command", run.command},
            {"suite", {{"name", run.suite}, {"about", run.about}}},
            {"device",
             {{"name", device.name},
              {"type", device.type},
              {"driver", device.driver},
              {"driver_version", device.driver_version},
              {"api_version", device.api_version}}},
            {"cores", run.cores},
            {"ratio_clock", run.clock},
            {"rounds", run.rounds},
            {"seconds", run.seconds},
            {"host_peak_bytes", run.host_peak_bytes},
            {"cases", cases},
            {"scaling", scaling},
            {"skipped", skipped}};
}

std::string run_csv(const BenchRun& run) {
    std::vector<std::string> columns;
    std::vector<std::vector<std::pair<std::string, std::string>>> rows;
    for (const CaseResult& result : run.cases) {
        auto& row = rows.emplace_back();
        flatten(case_json(result), "", row);
        for (const auto& cell : row)
            if (std::find(columns.begin(), columns.end(), cell.first) == columns.end()) columns.push_back(cell.first);
    }
    std::string out = fmt::format("{}\n", fmt::join(columns, ","));
    for (const auto& row : rows) {
        std::vector<std::string> cells;
        for (const std::string& column : columns) {
            const auto found =
                std::find_if(row.begin(), row.end(), [&](const auto& cell) { return cell.first == column; });
            cells.push_back(found == row.end() ? "" : found->second);
        }
        out += fmt::format("{}\n", fmt::join(cells, ","));
    }
    return out;
}

}  // namespace edgesplat::bench
