#include "apps/edgesplat/cpu_renderers.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "apps/edgesplat/progress_bar.h"
#include "engine/error.h"
#include "engine/reference/truth.h"
#include "engine/volume/analytic_volumes.h"

namespace {

using Clock = std::chrono::steady_clock;
using edgesplat::RendererKind;
using edgesplat::reference::DirectOptions;
using edgesplat::reference::DirectResult;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The analytic scene of a builtin volume, on the volume's grid.
edgesplat::AnalyticScene exact_scene_of(const edgesplat::Volume& volume) {
    const std::string name = volume.name.substr(volume.name.find(':') + 1);
    const edgesplat::AnalyticScene scene = edgesplat::analytic_scene(name.substr(0, name.find(':')));
    return scene.dims == volume.geometry.dims ? scene : edgesplat::resized(scene, volume.geometry.dims);
}

}  // namespace

void check_cpu_request(const edgesplat::SceneDocument& document) {
    const edgesplat::OutputChoice& output = document.output;
    const edgesplat::VolumeSource& volume = document.volume;
    if (!on_processor(output.renderer)) return;
    const std::string_view name = name_of(output.renderer);
    const bool reference = output.renderer == RendererKind::Reference;
    for (const std::string& aov : output.aovs)
        if (!reference || aov != "tau")
            edgesplat::fail("--aov {}: --renderer {} has {}", aov, name,
                            reference ? "only the extra output tau" : "no extra outputs");
    if (output.renderer != RendererKind::Truth) return;
    if (!edgesplat::is_builtin(volume.path))
        edgesplat::fail(
            "{}: --renderer truth needs the exact scene, which only builtin:NAME volumes have; --renderer reference "
            "accepts any volume",
            volume.path);
    if (volume.threshold || volume.box_filter)
        edgesplat::fail("--{}: --renderer truth shows the exact scene, which has no samples to filter",
                        volume.threshold ? "threshold" : "box-filter");
    if (volume.crop_low || volume.crop_high)
        edgesplat::fail("volume.crop_low, crop_high: --renderer truth cannot crop the exact scene");
    if (output.compare_plain)
        edgesplat::fail("--compare plain: --renderer truth draws no kernels, so there is no plain picture");
}

CpuFrames render_on_processor(const CpuRequest& request, const edgesplat::Volume& volume, const edgesplat::Scene& scene,
                              const edgesplat::Camera& camera) {
    using edgesplat::reference::Output;
    CpuFrames result;
    if (request.output.compare_plain) {
        edgesplat::Settings plain = request.settings;
        plain.edges = edgesplat::EdgeEstimator::Off;
        result.frames.push_back({"plain", plain, {}});
    }
    const bool edges = request.settings.edges != edgesplat::EdgeEstimator::Off;
    result.frames.push_back({edges ? "edges" : "plain", request.settings, {}});

    const int width = request.output.size.x, height = request.output.size.y;
    const bool tau = !request.output.aovs.empty();
    ProgressBar bar(request.quiet);
    const Clock::time_point start = Clock::now();
    const double pictures = static_cast<double>(result.frames.size()) + (tau ? 1 : 0);
    double before = 0;
    const DirectOptions options{request.output.tolerance, [&](double done) {
                                    const double all = (before + done) / pictures;
                                    if (all > 0) bar.update(all, seconds_since(start) * (1 - all) / all, "");
                                    return !request.interruption || !request.interruption();
                                }};
    for (RenderedFrame& frame : result.frames) {
        const Clock::time_point begin = Clock::now();
        CpuMeasurements measured;
        const auto take = [&](DirectResult&& picture) {
            measured.error_estimate = std::max(measured.error_estimate, picture.error_estimate);
            measured.samples += picture.samples;
            before += 1;
            return std::move(picture.image);
        };
        if (request.output.renderer == RendererKind::Truth) {
            frame.result.color = take(edgesplat::reference::truth(exact_scene_of(volume), volume.geometry, scene,
                                                                  camera, width, height, options));
        } else {
            const edgesplat::reference::PreparedVolume prepared(volume, scene, frame.settings);
            const auto picture = [&](Output output) {
                return take(edgesplat::reference::direct_evaluation(prepared, camera, width, height, output, options));
            };
            frame.result.color = picture(Output::Color);
            if (tau) frame.result.tau = picture(Output::Tau);
        }
        measured.seconds = seconds_since(begin);
        frame.result.stats.voxels = volume.geometry.voxel_count();
        result.measurements.push_back(measured);
    }
    return result;
}

void add_renderer_statistics(nlohmann::ordered_json& statistics, const edgesplat::OutputChoice& output,
                             const std::vector<CpuMeasurements>& measurements) {
    statistics["renderer"] = name_of(output.renderer);
    if (measurements.empty()) return;
    statistics["tolerance"] = output.tolerance;
    statistics.erase("device");
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        auto& frame = statistics["frames"][i];
        for (const char* key : {"setup_ms", "frame_ms", "passes_ms", "splats_collected", "splats_drawn", "edge_splats",
                                "sheets", "sheet_groups", "device_bytes", "validation_messages"})
            frame.erase(key);
        frame["error_estimate"] = measurements[i].error_estimate;
        frame["seconds"] = measurements[i].seconds;
        frame["samples"] = measurements[i].samples;
    }
}
