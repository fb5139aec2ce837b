// Renderers on the processor, exact to a tolerance: the model itself (`reference`) and the exact scene (`truth`).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/edgesplat/render_output.h"
#include "engine/scene/scene_document.h"

/// Cost and error of one frame.
struct CpuMeasurements {
    double seconds = 0;
    double error_estimate = 0;  ///< largest over pixels and channels
    std::uint64_t samples = 0;  ///< points evaluated
};

/// Settings of a rendering, without volume, scene and camera.
struct CpuRequest {
    edgesplat::OutputChoice output;  ///< renderer, tolerance, size, extra outputs
    edgesplat::Settings settings;
    bool quiet = false;  ///< no progress bar (which only a terminal shows)
    /// Polled while rendering; if it returns true, reference::Cancelled is thrown. Empty: never cancelled.
    std::function<bool()> interruption{};
};

struct CpuFrames {
    std::vector<RenderedFrame> frames;          ///< with `compare_plain`, the plain frame comes first
    std::vector<CpuMeasurements> measurements;  ///< one per frame
};

/// Checks a document before anything is read or computed. The only extra output is tau, of `reference`. `truth` accepts
/// only builtin volumes, neither filtered nor cropped. Other renderers are not checked. Throws edgesplat::Error.
void check_cpu_request(const edgesplat::SceneDocument& document);

/// Renders the requested frames. Throws edgesplat::Error.
CpuFrames render_on_processor(const CpuRequest& request, const edgesplat::Volume& volume, const edgesplat::Scene& scene,
                              const edgesplat::Camera& camera);

/// Adds the renderer's name to `statistics`. If `measurements` is not empty (processor renderers), also adds them to
/// each frame and removes entries that only a device has.
void add_renderer_statistics(nlohmann::ordered_json& statistics, const edgesplat::OutputChoice& output,
                             const std::vector<CpuMeasurements>& measurements);
