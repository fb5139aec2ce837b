// Measures a suite on one device.
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

/// The first picture of a new device; the volume is in the host's memory.
struct ColdStart {
    double startup_ms = 0;        ///< instance, device and the renderer's own resources
    double first_picture_ms = 0;  ///< after that: upload, pipelines, setup and the frame
    std::uint64_t pipelines = 0;
    double pipeline_ms = 0;  ///< creation of the pipelines; part of first_picture_ms
};

struct CaseResult {
    std::string name, group, mode, series, volume, checksum;
    glm::ivec3 dims{0};
    glm::ivec2 size{0};
    Sampled frame, raycast;  ///< wall ms
    Sampled processor;       ///< processor ms of all threads during a frame
    Sampled ratio;           ///< frame / ray caster, by BenchRun::clock
    Sampled wall_ratio;
    NamedTimes passes;  ///< GPU ms of a frame
    Sampled setup;      ///< estimation and collection, wall ms
    NamedTimes setup_passes;
    ColdStart cold;
    RenderStats stats;  ///< of the cold start's picture with its setup; fragments are counted
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
    std::optional<int> rounds;     ///< exact number of rounds
    std::optional<double> budget;  ///< seconds, instead of the suite's
    accuracy::VisitLimits visit{.milliseconds = 300, .triples = 24};
};

/// Measures each case from a cold start, then rounds over all cases, each round in another order, until the budget is
/// spent; at least one round. Throws accuracy::Interrupted if `progress` returns false, and Error.
BenchRun run_suite(const Suite& suite, const BenchOptions& options, const accuracy::ProgressFunction& progress);

/// Fits how the costs of each series grow.
std::vector<Scaling> scaling_of(const std::vector<CaseResult>& cases);

}  // namespace edgesplat::bench
