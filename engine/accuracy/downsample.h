// Measures what a coarser volume loses and edge preservation recovers. A real volume is the truth; its box-filtered,
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

/// Each voxel is the mean of factor^3 voxels and lies at their centre; a remainder at the upper ends is discarded.
/// Throws Error unless the factor is at least 2 and leaves 2 voxels along each axis.
Volume box_downsampled(const Volume& volume, int factor);

/// Random points of an iso-surface of a volume, the same in every run; axes are unit normals, in voxels of the volume.
/// Points are left out if another surface lies within `room` voxels along the normal, or the border within `room` + 2
/// voxels.
SurfacePoints surface_points(const Volume& volume, double iso, int count, double room);

/// Differences between two pictures of first surfaces, as shares of all pixels.
struct SurfaceDifference {
    double invented = 0;   ///< a surface where the finer picture has none
    double lost = 0;       ///< none where the finer picture has one
    double displaced = 0;  ///< both have one, more than the given distance apart
};

/// Compares opacities (alpha of `color`; a surface is shown from 0.5 on) and depths (mm).
SurfaceDifference surface_difference(const RenderResult& coarse, const RenderResult& fine, double distance_mm);

/// One way to render one coarser copy. Lengths in fine voxels, over all cameras.
struct VariantResult {
    /// plain, paper, edge; rays: the trilinear ray caster, against its own picture of the full volume.
    std::string name;
    Settings settings;
    EdgeFigures edges;
    double rmse = 0;              ///< against the picture of the full volume, full scale = 1
    double recovered_rise = 0;    ///< (plain - this) / (plain - full) of the mean rise; 1: as sharp as the full volume
    double recovered_rmse = 0;    ///< (plain - this) / plain of the RMSE
    SurfaceDifference surface;    ///< `displaced`: by more than a coarse voxel; NaN for rays
    std::vector<Image> pictures;  ///< per camera
};

struct FactorResult {
    int factor = 2;
    glm::ivec3 dims{0};
    int points = 0, disturbed = 0, near_border = 0;
    EdgeFigures full;  ///< figures of the full volume at the same points
    std::vector<VariantResult> variants;
};

struct ResolutionRequest {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    std::vector<int> factors{2};
    glm::ivec2 size{192};
    Settings settings;  ///< of the variant `edge` and of the full volume
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

/// Measures all factors. The renderer has the full volume afterwards. `progress` as in work_list.h. Throws Error.
ResolutionReport measure_resolution(Renderer& renderer, const ResolutionRequest& request,
                                    const ProgressFunction& progress = {});

/// Writes resolution.json, resolution.csv and resolution.html into the folder (created if missing), all or none.
void write_resolution(const ResolutionReport& report, const std::filesystem::path& folder);

/// A short table for the terminal.
std::string resolution_table(const ResolutionReport& report);

}  // namespace edgesplat::accuracy
