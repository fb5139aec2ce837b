// What `edgesplat accuracy` measures and what came out: the data behind report.json, steps.csv and index.html.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/accuracy/configurations.h"
#include "engine/accuracy/edge_profiles.h"
#include "engine/accuracy/frame_times.h"
#include "engine/accuracy/report_cameras.h"

namespace edgesplat::accuracy {

/// What is looked at.
struct ReportInput {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    /// The scene that the volume's samples are of, on the volume's grid; empty where the truth is not known. Then what
    /// stands in for it are the surfaces of the cubic B-spline through the samples, the best that they say.
    std::optional<AnalyticScene> analytic;
    std::string program;  ///< name and version
    std::string command;  ///< as it was given
};

struct ReportOptions {
    Settings base;            ///< steps are taken one at a time from here
    glm::ivec2 size{192};     ///< pixels
    double tolerance = 3e-5;  ///< of the references, largest error of a pixel, full scale = 1
    int repeats = 5;          ///< rounds in which times are taken
    int orbit_frames = 36;    ///< frame pairs, one degree apart; 0: popping is not measured
    int orbit_size = 96;      ///< pixels, both ways
    int surface_points = 200;
    std::vector<std::string> knobs;    ///< whose steps are measured; empty: all, and combinations
    std::vector<std::string> cameras;  ///< that are used; empty: all there are
    std::filesystem::path folder;
    bool restart = false;  ///< throw away what an earlier run left
};

/// One configuration seen by one camera.
struct CameraResult {
    ImageError truth;            ///< against the truth
    ImageError method;           ///< against the converged picture of the model; of rays: of the base's
    double reference_error = 0;  ///< of the reference's worst pixel
    FrameTimes times;
    std::uint64_t splats_drawn = 0, sheets = 0;
};

/// Everything about one set of settings, or one ray caster.
struct SettingsResult {
    Settings settings;
    std::optional<RaycastFilter> rays;
    std::vector<CameraResult> cameras;  ///< as many as the report's, in their order
    ImageError truth, method;           ///< all cameras together
    std::optional<EdgeFigures> edges;
    std::optional<Popping> popping;
    double frame_ms = 0;    ///< mean of the cameras' medians
    double wall_ratio = 0;  ///< the median by the wall clock
    Spread ratio;           ///< to the trilinear ray caster: geometric mean over cameras, of medians, of p10, of p90
    double setup_ms = 0;    ///< edge estimation and collection, median; NaN where switching to it needed none
    std::uint64_t device_bytes = 0;  ///< of a renderer that has rendered nothing else, after all cameras
};

struct Report {
    ReportInput input;
    ReportOptions options;
    DeviceInfo device;
    std::vector<ReportCamera> cameras;
    std::vector<Configuration> rows;
    std::vector<std::size_t> result_of_row;  ///< index into `results`
    std::vector<SettingsResult> results;
    std::vector<std::size_t> front;  ///< rows that nothing is both nearer to the truth than and faster, cheapest first
    std::vector<double> raycast_ms;  ///< of the trilinear ray caster, median per camera
    std::optional<SurfacePoints> surface;
    double largest_reference_error = 0;  ///< worst pixel of all references
    std::vector<std::string> notes;      ///< what was left out and why, one sentence each

    /// What pictures are held against, in words.
    std::string truth_in_words() const {
        return input.analytic ? "the exact scene" : "the surfaces of the cubic spline through the samples";
    }
    const SettingsResult& of_row(std::size_t row) const { return results[result_of_row[row]]; }
};

/// The pictures that a report shows, one camera. Colour over the background.
struct ReportPictures {
    Image plain, base, accurate, reference, trilinear_rays, cubic_rays, truth;
};

}  // namespace edgesplat::accuracy
