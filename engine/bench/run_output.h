// A measured suite for people and programs: tables, bench.json, bench.csv, plots. The keys are in docs/benchmarks.md.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/bench/run.h"

namespace edgesplat::bench {

inline constexpr const char* kSchema = "edgesplat bench 1";

nlohmann::ordered_json run_json(const BenchRun& run);

/// One line a case; the first names the columns. Full precision, a point as decimal sign, empty where nothing is known.
std::string run_csv(const BenchRun& run);

/// Times, passes, work, memory, fits and what was skipped.
std::string run_tables(const BenchRun& run);

/// A plot as a file: its name and its text.
struct PlotFile {
    std::string name, text;
};

/// ratio.svg and, with scaling cases, frame_scaling.svg and setup_scaling.svg. Throws Error where gnuplot fails.
std::vector<PlotFile> run_plots(const BenchRun& run);

/// Refuses, before anything is measured, a folder that could not be made or written. Throws Error.
void check_run_folder(const std::filesystem::path& folder);

/// Writes bench.json, bench.csv and the plots, all or none. Returns what is to be said of it: empty, or why there are
/// no plots. Throws Error.
std::string write_run(const BenchRun& run, const std::filesystem::path& folder);

}  // namespace edgesplat::bench
