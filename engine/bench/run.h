// A suite measured on one device.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/accuracy/frame_times.h"
#include "engine/accuracy/work_list.h"
#include "engine/bench/statistics.h"
#include "engine/bench/suite.h"
#include "engine/renderer.h"

namespace edgesplat::bench {

using NamedTimes = std::vector<std::pair<std::string, Sampled>>;

/// A picture without anything warm: a new device, the volume in the host's memory.
struct ColdStart {
    double startup_ms = 0;        ///< instance, device and what every renderer holds
    double first_picture_ms = 0;  ///< from there: upload, pipelines, setup and the frame
    std::uint64_t pipelines = 0;
    double pipeline_ms = 0;  ///< making them; part of first_picture_ms
};

struct CaseResult {
    std::string name, group, mode, series, volume, checksum;
    glm::ivec3 dims{0};
    glm::ivec2 size{0};
    Sampled frame, raycast;  ///< wall ms
    Sampled processor;       ///< ms of all threads during a frame
    Sampled ratio;           ///< frame / ray caster, by BenchRun::clock
    Sampled wall_ratio;
    NamedTimes passes;  ///< GPU ms of a frame
    Sampled setup;      ///< wall ms: estimation and collection
    NamedTimes setup_passes;
    ColdStart cold;
    RenderStats stats;  ///< of the cold start's picture, with its setup, counted
    std::uint64_t host_peak_bytes = 0;

    double voxels() const { return static_cast<double>(stats.voxels); }
    std::uint64_t rejected() const {
        return stats.splats_collected - std::min(stats.splats_collected, stats.splats_drawn);
    }
};

/// How a cost grows over the cases of one series, mode and size.
struct Scaling {
    std::string series, mode;
    glm::ivec2 size{0};
    std::string cost;  ///< frame_ms_of_splats_drawn, setup_ms_of_voxels
    PowerFit fit;
};

struct BenchRun {
    std::string program, command, suite, about;
    DeviceInfo device;
    std::string clock;  ///< of the ratio: wall, processor
    unsigned cores = 0;
    int rounds = 0;
    double seconds = 0;
    std::uint64_t host_peak_bytes = 0;
    std::vector<CaseResult> cases;
    std::vector<SkippedCase> skipped;
    std::vector<Scaling> scaling;
};

struct BenchOptions {
    DeviceChoice device;
    std::optional<int> rounds;     ///< exactly so many
    std::optional<double> budget;  ///< seconds, instead of the suite's
    accuracy::VisitLimits visit{.milliseconds = 300, .triples = 24};
};

/// Each case from a cold start, then rounds over all cases, each in an order of its own, until the budget is spent; one
/// at least. Throws accuracy::Interrupted where `progress` says no, and Error.
BenchRun run_suite(const Suite& suite, const BenchOptions& options, const accuracy::ProgressFunction& progress);

/// What the cases of each series come to.
std::vector<Scaling> scaling_of(const std::vector<CaseResult>& cases);

}  // namespace edgesplat::bench
