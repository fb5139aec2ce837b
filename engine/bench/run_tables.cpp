// Prints a measured suite as tables.
#include <algorithm>
#include <cmath>

#include "engine/bench/run_output.h"
#include "engine/bench/text_table.h"

namespace edgesplat::bench {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// At least three significant digits, with up to four decimals.
std::string brief(double value) {
    if (!std::isfinite(value)) return "-";
    if (value == 0) return "0";
    const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 4);
    return fmt::format("{:.{}f}", value, digits);
}

std::string millions(std::uint64_t count) {
    return brief(static_cast<double>(count) * 1e-6);
}

std::string mebibytes(std::uint64_t bytes) {
    return brief(static_cast<double>(bytes) / (1024.0 * 1024.0));
}

/// p10 to p90; "-" for fewer than three samples.
std::string scatter(const Sampled& s) {
    return s.count < 3 ? "-" : fmt::format("{}-{}", brief(s.low), brief(s.high));
}

/// All names, sorted.
std::vector<std::string> names_in(const std::vector<CaseResult>& cases, NamedTimes CaseResult::*times) {
    std::vector<std::string> names;
    for (const CaseResult& entry : cases)
        for (const auto& [name, sample] : entry.*times)
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    std::sort(names.begin(), names.end());
    return names;
}

const Sampled* find_time(const NamedTimes& times, const std::string& name) {
    for (const auto& [known, sample] : times)
        if (known == name) return &sample;
    return nullptr;
}

std::string time_table(const BenchRun& run) {
    Rows rows{{"", "frame ms", "p95", "ray ms", "ratio", "p10-p90", "wall ratio", "n", "setup ms", "ns/voxel",
               "first picture ms", "start-up ms", "pipelines", "ms"}};
    for (const CaseResult& c : run.cases)
        rows.push_back({c.name, brief(c.frame.median), brief(c.frame.p95), brief(c.raycast.median),
                        brief(c.ratio.median), scatter(c.ratio), brief(c.wall_ratio.median),
                        fmt::format("{}", c.frame.count), brief(c.setup.median),
                        brief(c.setup.median * 1e6 / c.voxels()), brief(c.cold.first_picture_ms),
                        brief(c.cold.startup_ms), fmt::format("{}", c.cold.pipelines), brief(c.cold.pipeline_ms)});
    return fmt::format("Times; ratio: frame over ray caster by {} time, measured in turns\n{}", run.clock,
                       text_table(rows));
}

std::string pass_table(const BenchRun& run) {
    const auto passes = names_in(run.cases, &CaseResult::passes);
    const auto setup = names_in(run.cases, &CaseResult::setup_passes);
    Rows rows(1);
    rows[0].emplace_back();
    rows[0].insert(rows[0].end(), passes.begin(), passes.end());
    for (const std::string& name : setup)
        rows[0].push_back(name + " ns/voxel");
    for (const CaseResult& c : run.cases) {
        auto& row = rows.emplace_back(1, c.name);
        for (const std::string& name : passes) {
            const Sampled* time = find_time(c.passes, name);
            row.push_back(time == nullptr ? "-" : fmt::format("{} {}", brief(time->median), brief(time->p95)));
        }
        for (const std::string& name : setup) {
            const Sampled* time = find_time(c.setup_passes, name);
            row.push_back(time == nullptr ? "-" : brief(time->median * 1e6 / c.voxels()));
        }
    }
    return "Passes of a frame, GPU ms: median and p95; stages of the setup, ns/voxel: median\n" + text_table(rows);
}

std::string work_table(const BenchRun& run) {
    Rows rows{{"", "collected M", "culled M", "drawn M", "rejected M", "vertices M", "fragments M", "shaded M",
               "sheets", "groups", "dirty %", "device MiB", "host peak MiB"}};
    for (const CaseResult& c : run.cases) {
        const RenderStats& s = c.stats;
        const auto counted = [&](std::uint64_t DrawCounts::*member) {
            return s.draw_counts ? millions((*s.draw_counts).*member) : "-";
        };
        rows.push_back({c.name, millions(s.splats_collected), millions(s.splats_culled), millions(s.splats_drawn),
                        millions(c.rejected()), counted(&DrawCounts::vertices), counted(&DrawCounts::fragments),
                        counted(&DrawCounts::shaded), fmt::format("{}", s.sheets), fmt::format("{}", s.sheet_groups),
                        s.dirty_share ? brief(100 * *s.dirty_share) : "-", mebibytes(s.device_bytes),
                        mebibytes(c.host_peak_bytes)});
    }
    return "Work and memory\n" + text_table(rows);
}

std::string scaling_table(const BenchRun& run) {
    Rows rows{{"series", "mode", "size", "cost", "exponent", "residual %", "points"}};
    for (const Scaling& s : run.scaling)
        rows.push_back({s.series, s.mode, fmt::format("{}x{}", s.size.x, s.size.y), s.cost, brief(s.fit.exponent),
                        brief(100 * s.fit.residual), fmt::format("{}", s.fit.points)});
    return "Scaling: cost = factor * x^exponent\n" + text_table(rows);
}

std::string place_of_run(const BenchRun& run) {
    const DeviceInfo& d = run.device;
    return fmt::format("{} ({} {}), {} processor cores; {} rounds in {:.0f} s", d.name, d.driver, d.driver_version,
                       run.cores, run.rounds, run.seconds);
}

}  // namespace

std::string volume_table(const BenchRun& run, const Suite& suite) {
    Rows rows{{"view", "edgesplat ms", "plain ms", "ray caster ms", "first picture ms", "memory MiB"}};
    std::string views;
    for (const CaseResult& c : run.cases) {
        if (c.mode != "default") continue;
        const auto plain = std::ranges::find_if(
            run.cases, [&](const CaseResult& other) { return other.group == c.group && other.mode == "plain"; });
        rows.push_back({c.group, brief(c.frame.median), plain == run.cases.end() ? "-" : brief(plain->frame.median),
                        brief(c.raycast.median), brief(c.cold.startup_ms + c.cold.first_picture_ms),
                        mebibytes(c.stats.device_bytes)});
        views += fmt::format("{}: {}\n", c.group, std::ranges::find(suite.cases, c.name, &SuiteCase::name)->about);
    }
    return fmt::format(
        "{}; {}\n\n{}\nedgesplat: edge-preserving splatting; plain: splatting without edges; ray caster: trilinear\n"
        "ms: time of a frame, median; first picture: from the loaded volume to its picture\nmemory: of the device\n{}",
        suite.about, place_of_run(run), text_table(rows), views);
}

std::string run_tables(const BenchRun& run) {
    std::string out;
    if (!run.cases.empty()) {
        out += fmt::format("{}: {} on {}\n\n", run.program, run.suite, place_of_run(run));
        out += fmt::format("{}\n{}\n{}", time_table(run), pass_table(run), work_table(run));
        if (!run.scaling.empty()) out += "\n" + scaling_table(run);
        out += fmt::format("host peak of all: {} MiB\n", mebibytes(run.host_peak_bytes));
    }
    for (const SkippedCase& entry : run.skipped)
        out += fmt::format("skipped {}: {}\n", entry.name, entry.reason);
    return out;
}

}  // namespace edgesplat::bench
