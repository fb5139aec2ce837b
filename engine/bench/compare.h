// Compares two runs of a suite: new / old.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::bench {

/// The change of one quantity of one case.
struct MetricChange {
    std::string metric;
    std::optional<double> ratio;  ///< new / old; nullopt if either is unknown or 0
    bool beyond_scatter = false;  ///< p10..p90 of both runs, of at least 3 samples, do not overlap; counts: they differ
};

struct CaseChange {
    std::string name;
    std::vector<MetricChange> metrics;  ///< the same for every case
};

struct Comparison {
    std::vector<CaseChange> cases;   ///< cases in both runs
    std::vector<std::string> notes;  ///< other differences: device, volume, cases in only one run
};

/// Both runs as in bench.json.
Comparison compare_runs(const nlohmann::ordered_json& earlier, const nlohmann::ordered_json& later);

/// One row per case; * marks changes beyond the scatter; geometric means come last.
std::string comparison_table(const Comparison& comparison);

/// Reads bench.json. Throws Error if the file is not one.
nlohmann::ordered_json read_run(const std::filesystem::path& path);

}  // namespace edgesplat::bench
