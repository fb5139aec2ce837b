// Input, options and results of `edgesplat accuracy`: the data of report.json, steps.csv and index.html.
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

/// What is measured.
struct ReportInput {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    /// The scene that the volume samples, on the volume's grid. nullopt if it is not known; then the truth is replaced
    /// by the surfaces of the cubic B-spline through the samples, the samples' best estimate.
    std::optional<AnalyticScene> analytic;
    std::string program;  ///< name and version
    std::string command;  ///< as given
};

struct ReportOptions {
    Settings base;            ///< each step changes one knob of these
    glm::ivec2 size{192};     ///< pixels
    double tolerance = 3e-5;  ///< largest error of a reference's pixel, full scale = 1
    int repeats = 5;          ///< rounds of time measurements
    int orbit_frames = 36;    ///< pairs of frames one degree apart; 0: popping is not measured
    int orbit_size = 96;      ///< pixels, width and height
    int surface_points = 200;
    std::vector<std::string> knobs;    ///< knobs whose steps are measured; empty: all, and combinations
    std::vector<std::string> cameras;  ///< names of the cameras that are used; empty: all
    std::filesystem::path folder;
    bool restart = false;  ///< delete the journal of an earlier run
};

/// One configuration and one camera.
struct CameraResult {
    ImageError truth;            ///< against the truth
    ImageError method;           ///< against the converged picture of the model; for rays, of the base's
    double reference_error = 0;  ///< worst pixel of the reference
    FrameTimes times;
    std::uint64_t splats_drawn = 0, sheets = 0;
};

/// All results of one set of settings, or of one ray caster.
struct SettingsResult {
    Settings settings;
    std::optional<RaycastFilter> rays;
    std::vector<CameraResult> cameras;  ///< one per camera of the report, in its order
    ImageError truth, method;           ///< all cameras together
    std::optional<EdgeFigures> edges;
    std::optional<Popping> popping;
    double frame_ms = 0;    ///< mean of the cameras' medians
    double wall_ratio = 0;  ///< the median by the wall clock
    Spread ratio;           ///< time / trilinear ray caster's: geometric means over cameras of median, p10 and p90
    double setup_ms = 0;    ///< edge estimation and collection, median; NaN: never needed
    std::uint64_t device_bytes = 0;  ///< after all cameras, of a renderer that has rendered nothing else
};

struct Report {
    ReportInput input;
    ReportOptions options;
    DeviceInfo device;
    std::vector<ReportCamera> cameras;
    std::vector<Configuration> rows;
    std::vector<std::size_t> result_of_row;  ///< index into `results`
    std::vector<SettingsResult> results;
    std::vector<std::size_t> front;  ///< rows for which no row is both faster and nearer to the truth, cheapest first
    std::vector<double> raycast_ms;  ///< time of the trilinear ray caster, median per camera
    std::optional<SurfacePoints> surface;
    double largest_reference_error = 0;  ///< worst pixel of all references
    std::vector<std::string> notes;      ///< one sentence each: omissions and their reasons

    /// Describes what pictures are compared with.
    std::string truth_description() const {
        return input.analytic ? "the exact scene" : "the surfaces of the cubic spline through the samples";
    }
    const SettingsResult& of_row(std::size_t row) const { return results[result_of_row[row]]; }
};

/// The pictures of one camera in a report: colour over the background.
struct ReportPictures {
    Image plain, base, accurate, reference, trilinear_rays, cubic_rays, truth;
};

}  // namespace edgesplat::accuracy
