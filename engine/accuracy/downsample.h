// What a coarser volume loses and edge preservation wins back: a real volume is the truth, its box-filtered and
// decimated copies are rendered.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/accuracy/edge_profiles.h"
#include "engine/accuracy/report_cameras.h"
#include "engine/accuracy/work_list.h"
#include "engine/renderer.h"

namespace edgesplat::accuracy {

/// Each voxel the mean of factor^3; what is left over at the upper ends is dropped. Voxel centres lie in the world
/// where the middle of those was. Throws Error unless the factor is at least 2 and 2 voxels are left along each axis.
Volume box_downsampled(const Volume& volume, int factor);

/// Points of the surface of an iso-value in a volume, at random, always the same; axes are unit normals, voxels of the
/// volume. Left out: where the value is not on one side of the iso-value up to `room` voxels away along the normal, and
/// what lies within `room` + 2 of the border.
SurfacePoints surface_points(const Volume& volume, double iso, int count, double room);

/// How two pictures of first surfaces differ. Shares of all pixels.
struct SurfaceDifference {
    double invented = 0;   ///< a surface where the finer picture has none
    double lost = 0;       ///< none where the finer picture has one
    double displaced = 0;  ///< both have one, more than the given distance apart
};

/// Of opacities (alpha of `color`, a surface from 0.5) and depths (mm).
SurfaceDifference surface_difference(const RenderResult& coarse, const RenderResult& fine, double distance_mm);

/// One way to render one coarser copy; fine voxels, all cameras together.
struct VariantResult {
    /// plain, paper, edge; rays: the trilinear ray caster, against its own picture of the full volume.
    std::string name;
    Settings settings;
    EdgeFigures edges;
    double rmse = 0;              ///< against the picture of the full volume, full scale = 1
    double recovered_rise = 0;    ///< (plain - this) / (plain - full), of the mean rise; 1: as sharp as the full volume
    double recovered_rmse = 0;    ///< (plain - this) / plain, of the RMSE
    SurfaceDifference surface;    ///< by more than a coarse voxel; of rays `displaced` is not known, and NaN
    std::vector<Image> pictures;  ///< per camera
};

struct FactorResult {
    int factor = 2;
    glm::ivec3 dims{0};
    int points = 0, disturbed = 0, near_border = 0;
    EdgeFigures full;  ///< of the full volume at the same points
    std::vector<VariantResult> variants;
};

struct ResolutionRequest {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    std::vector<int> factors{2};
    glm::ivec2 size{192};
    Settings settings;  ///< `edge`, and of the full volume
    int surface_points = 200;
    std::string program, command;
};

struct ResolutionReport {
    ResolutionRequest request;
    DeviceInfo device;
    std::vector<ReportCamera> cameras;
    std::vector<Image> full;  ///< per camera
    std::vector<FactorResult> factors;
};

/// Leaves the full volume in the renderer. `progress` as in work_list.h. Throws Error.
ResolutionReport measure_resolution(Renderer& renderer, const ResolutionRequest& request,
                                    const ProgressFunction& progress = {});

/// Writes resolution.json, resolution.csv and resolution.html into the folder, which is created; all or none.
void write_resolution(const ResolutionReport& report, const std::filesystem::path& folder);

/// The same as a short table for the terminal.
std::string resolution_table(const ResolutionReport& report);

}  // namespace edgesplat::accuracy
