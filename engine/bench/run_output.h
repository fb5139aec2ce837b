// Output of a measured suite: tables, bench.json, bench.csv, plots. docs/benchmarks.md describes the keys.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/bench/run.h"

namespace edgesplat::bench {

inline constexpr const char* kSchema = "edgesplat bench 1";

nlohmann::ordered_json run_json(const BenchRun& run);

/// One line per case; the first line names the columns. Full precision, decimal point, empty cells for unknown values.
std::string run_csv(const BenchRun& run);

/// Tables of times, passes, work, memory and fits, and the skipped cases.
std::string run_tables(const BenchRun& run);

/// The table of a suite that volume_suite made, for its user: one line a view.
std::string volume_table(const BenchRun& run, const Suite& suite);

/// A plot as a file: its name and its content.
struct PlotFile {
    std::string name, text;
};

/// ratio.svg and, with scaling cases, frame_scaling.svg and setup_scaling.svg. Throws Error if gnuplot fails.
std::vector<PlotFile> run_plots(const BenchRun& run);

/// Checks before a measurement that the folder can be created and written. Throws Error.
void check_run_folder(const std::filesystem::path& folder);

/// Writes bench.json, bench.csv and the plots, all or none. Returns a message: empty, or why there are no plots. Throws
/// Error.
std::string write_run(const BenchRun& run, const std::filesystem::path& folder);

}  // namespace edgesplat::bench
