// Options --explain and --memory-budget: the plan of a picture, and the limit of its device memory.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/forecast/description.h"

struct ExplainOption {
    bool explain = false;
    double memory_budget = 0;  ///< MiB; 0: all memory of the device
    std::uint64_t budget_bytes() const { return static_cast<std::uint64_t>(memory_budget * 1024 * 1024); }
};

/// Adds both options in their own group.
void add_explain_options(CLI::App& command, ExplainOption& option);

/// The description's tables as JSON.
nlohmann::ordered_json to_json(const edgesplat::FrameDescription& description);
