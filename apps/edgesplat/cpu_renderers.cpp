#include "apps/edgesplat/cpu_renderers.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "engine/error.h"
#include "engine/reference/truth.h"
#include "engine/volume/analytic_volumes.h"

namespace {

using Clock = std::chrono::steady_clock;
using edgesplat::reference::DirectOptions;
using edgesplat::reference::DirectResult;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A bar and the time left on stderr, where that is a terminal; wiped when it is done.
class ProgressBar {
  public:
    explicit ProgressBar(bool shown) : shown_(shown && isatty(STDERR_FILENO) == 1) {}
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar() {
        if (drawn_) fmt::print(stderr, "\r\033[K");
    }
    /// `done` 0..1 of all there is to do.
    void update(double done) {
        if (!shown_ || !(done > 0) || Clock::now() - last_ < std::chrono::milliseconds(100)) return;
        last_ = Clock::now();
        drawn_ = true;
        constexpr int kWidth = 30;
        const int filled = static_cast<int>(done * kWidth);
        const auto left = static_cast<int>(std::ceil(seconds_since(begin_) * (1 - done) / done));
        fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3.0f} %, {}:{:02} left", "", filled, "", kWidth - filled,
                   100 * done, left / 60, left % 60);
        std::fflush(stderr);
    }

  private:
    bool shown_;
    bool drawn_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

/// The scene behind a builtin volume, on the volume's grid.
edgesplat::AnalyticScene scene_behind(const edgesplat::Volume& volume) {
    const std::string name = volume.name.substr(volume.name.find(':') + 1);
    const edgesplat::AnalyticScene scene = edgesplat::analytic_scene(name.substr(0, name.find(':')));
    return scene.dims == volume.geometry.dims ? scene : edgesplat::resized(scene, volume.geometry.dims);
}

}  // namespace

void check_cpu_request(const RendererOptions& renderer, const std::string& volume_path, const SceneOptions& scene,
                       const std::vector<std::string>& aovs, bool compare_plain) {
    if (!on_processor(renderer.kind)) return;
    const std::string_view name = name_of(renderer.kind);
    for (const std::string& aov : aovs)
        if (renderer.kind != RendererKind::Reference || aov != "tau")
            edgesplat::fail("--aov {}: --renderer {} has {}", aov, name,
                            renderer.kind == RendererKind::Reference ? "no extra output but tau" : "no extra outputs");
    if (renderer.kind != RendererKind::Truth) return;
    if (!edgesplat::is_builtin(volume_path))
        edgesplat::fail(
            "{}: --renderer truth needs the exact scene, which only builtin:NAME volumes have; "
            "--renderer reference takes any volume",
            volume_path);
    if (scene.threshold || scene.box_filter)
        edgesplat::fail("--{}: --renderer truth shows the exact scene and knows of no filtered samples",
                        scene.threshold ? "threshold" : "box-filter");
    if (compare_plain) edgesplat::fail("--compare plain: --renderer truth has no kernels that could be plain");
}

CpuFrames render_on_processor(const CpuRequest& request, const edgesplat::Volume& volume, const edgesplat::Scene& scene,
                              const edgesplat::Camera& camera) {
    using edgesplat::reference::Output;
    CpuFrames result;
    if (request.compare_plain) {
        edgesplat::Settings plain = request.settings;
        plain.edges = edgesplat::EdgeEstimator::Off;
        result.frames.push_back({"plain", plain, {}});
    }
    const bool edges = request.settings.edges != edgesplat::EdgeEstimator::Off;
    result.frames.push_back({edges ? "edges" : "plain", request.settings, {}});

    ProgressBar bar(!request.quiet);
    const double pictures = static_cast<double>(result.frames.size()) + (request.tau ? 1 : 0);
    double before = 0;
    const DirectOptions options{request.renderer.tolerance, [&](double done) {
                                    bar.update((before + done) / pictures);
                                    return true;
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
        if (request.renderer.kind == RendererKind::Truth) {
            frame.result.color = take(edgesplat::reference::truth(scene_behind(volume), volume.geometry, scene, camera,
                                                                  request.size.x, request.size.y, options));
        } else {
            const edgesplat::reference::PreparedVolume prepared(volume, scene,
                                                                edgesplat::reference::without_tables(frame.settings));
            const auto picture = [&](Output output) {
                return take(edgesplat::reference::direct_evaluation(prepared, camera, request.size.x, request.size.y,
                                                                    output, options));
            };
            frame.result.color = picture(Output::Color);
            if (request.tau) frame.result.tau = picture(Output::Tau);
        }
        measured.seconds = seconds_since(begin);
        frame.result.stats.voxels = volume.geometry.voxel_count();
        result.measurements.push_back(measured);
    }
    return result;
}

void add_renderer_statistics(nlohmann::ordered_json& statistics, const RendererOptions& renderer,
                             const std::vector<CpuMeasurements>& measurements) {
    statistics["renderer"] = name_of(renderer.kind);
    if (measurements.empty()) return;
    statistics["tolerance"] = renderer.tolerance;
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
