// The renderers that take no short cut and no Vulkan device: the model itself (`reference`) and the exact scene
// (`truth`).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/edgesplat/render_output.h"
#include "engine/scene/scene_document.h"

/// What such a frame took, and how exact it is.
struct CpuMeasurements {
    double seconds = 0;
    double error_estimate = 0;  ///< largest over pixels and channels
    std::uint64_t samples = 0;  ///< points evaluated
};

/// What is asked of them, beside the volume.
struct CpuRequest {
    edgesplat::OutputChoice output;  ///< which renderer, its tolerance, the size, what beside colour
    edgesplat::Settings settings;
    bool quiet = false;  ///< no progress on stderr, which is shown on a terminal only
    /// Asked now and then; where it says true there is no picture, and reference::Cancelled is thrown. Empty: never.
    std::function<bool()> interruption{};
};

struct CpuFrames {
    std::vector<RenderedFrame> frames;          ///< with `compare_plain` the plain one first
    std::vector<CpuMeasurements> measurements;  ///< one per frame
};

/// Refuses, before anything is read or computed, what these renderers cannot do: extra outputs other than tau of
/// `reference`, and for `truth` anything but a builtin volume as it is. Does nothing for other renderers. Throws
/// edgesplat::Error.
void check_cpu_request(const edgesplat::SceneDocument& document);

/// Throws edgesplat::Error.
CpuFrames render_on_processor(const CpuRequest& request, const edgesplat::Volume& volume, const edgesplat::Scene& scene,
                              const edgesplat::Camera& camera);

/// Puts the renderer, and what `measurements` (empty for others) hold of each frame, into what `statistics` made, and
/// takes out what only a device has.
void add_renderer_statistics(nlohmann::ordered_json& statistics, const edgesplat::OutputChoice& output,
                             const std::vector<CpuMeasurements>& measurements);
