// Two runs of a suite, new over old.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::bench {

/// One figure of one case.
struct MetricChange {
    std::string metric;
    std::optional<double> ratio;  ///< new / old; nothing where either is not known or 0
    bool beyond_scatter = false;  ///< p10..p90 of both runs, 3 samples at least, do not meet; of counts: they differ
};

struct CaseChange {
    std::string name;
    std::vector<MetricChange> metrics;  ///< the same for every case
};

struct Comparison {
    std::vector<CaseChange> cases;   ///< those that both runs have
    std::vector<std::string> notes;  ///< what else differs: device, volume, cases that one of them lacks
};

/// Both as in bench.json.
Comparison compare_runs(const nlohmann::ordered_json& earlier, const nlohmann::ordered_json& later);

/// A row a case, * for what is beyond the scatter, geometric means last.
std::string comparison_table(const Comparison& comparison);

/// Reads bench.json. Throws Error where it is none.
nlohmann::ordered_json read_run(const std::filesystem::path& path);

}  // namespace edgesplat::bench
