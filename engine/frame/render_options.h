// Options that a renderer's user sets for the next pictures (engine/renderer.h).
#pragma once

#include <filesystem>
#include <functional>
#include <limits>

#include "engine/error.h"

namespace edgesplat {

struct RenderOptions {
    double patience = std::numeric_limits<double>::infinity();  ///< milliseconds: Renderer::set_patience
    std::function<bool()> interruption;                         ///< Renderer::set_interruption
    std::function<void(double)> progress;                       ///< Renderer::set_progress
    std::uint64_t memory_budget = 0;                            ///< bytes; 0: the device's memory
    bool counting = false;                                      ///< Renderer::count_fragments
    bool check_numbers = false;                                 ///< DeviceChoice::check_numbers
    std::filesystem::path kept_splats;                          ///< folder of DeviceChoice::keep_splats; empty: none

    /// Throws Interrupted if an interruption is requested.
    void throw_if_interrupted() const {
        if (interruption && interruption()) throw Interrupted();
    }
};

}  // namespace edgesplat
