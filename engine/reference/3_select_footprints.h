// Pass 3: culls splats and finds the sheet of each remaining one (docs/method/3_select_footprints.md).
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "engine/reference/2_collect_splats.h"
#include "engine/reference/footprints.h"
#include "engine/reference/pixel_filter.h"
#include "engine/reference/volume_piece.h"
#include "engine/scene/camera.h"
#include "engine/scene/clip_planes.h"

namespace edgesplat::reference {

/// A camera, the grid that it shows and the picture's size.
struct View {
    CameraFrame frame;
    VolumeGeometry geometry;
    int width = 0, height = 0;      ///< pixels
    glm::dmat3 world_to_index{1};   ///< S^-1
    glm::dvec3 eye_index{0};        ///< the eye in index space
    double mm_per_voxel_along = 1;  ///< l_view
    glm::dvec2 offset{0};           ///< from a pixel's centre to its ray, pixels
    double low_pass = 0;            ///< smallest width of a footprint, pixels

    View(const Camera& camera, const VolumeGeometry& geometry, int width, int height);
    /// Unit direction, index space, of the ray through the centre of pixel (x, y) moved by `offset`; y counts from the
    /// top.
    glm::dvec3 ray(int x, int y) const;
    /// z of an index-space point: mm along the view axis from the eye.
    double depth(const glm::dvec3& index) const;
    /// Where an index-space point in front of the eye appears, pixels from the picture's upper left corner.
    glm::dvec2 pixel_of(const glm::dvec3& index) const;
};

/// Pixels [x0, x1) x [y0, y1).
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

/// Sphere, index space, outside which a splat is 0.
struct SplatSupport {
    glm::dvec3 center{0};
    double radius = 0;
};

/// Box, clipped to the picture, of the pixels whose centres a sphere in index space can cover. Exact for a sphere in
/// front of the eye plane; the whole picture if the sphere touches that plane; empty if it lies behind.
PixelBox screen_box(const View& view, const SplatSupport& support);

struct Selected {
    bool kept = false;
    int sheet = 0;       ///< counted from the first sheet that can occur
    int last_sheet = 0;  ///< equal to `sheet` unless kernels are sliced
    double z = 0;        ///< sort depth, mm: of the voxel's centre, or of its face
    SplatSupport support;
    PixelFilter filter;
    PixelBox box;
    FootprintLayer layer;  ///< of the footprint table, if it is used; `axis` is the layer's x axis
    glm::dvec3 axis{0};
};

/// Thickness of a sheet, mm along the view axis.
double sheet_thickness(const View& view, const Settings& settings);

/// The sheets of a picture.
struct Sheets {
    double nearest = std::numeric_limits<double>::infinity();  ///< depth of the nearest splat, mm from the eye
    double thickness = std::numeric_limits<double>::infinity();

    /// Number of sheet 0 of the picture, counted from the eye.
    int first() const;
    /// Where sheet `number` of the picture begins, mm from the eye.
    double depth(double number) const { return thickness * (first() + number); }
    /// Those that hold the splats of both.
    Sheets with(const Sheets& other) const;
};

Sheets sheets_of(std::span<const SplatRecord> records, const Field& field, const View& view, const Settings& settings,
                 const Footprints& footprints);

/// One entry per record. Splats that `clip` (index space) cuts away whole are culled.
std::vector<Selected> select_footprints(std::span<const SplatRecord> records, const Field& field, const View& view,
                                        const Settings& settings, const Footprints& footprints, const Sheets& sheets,
                                        const IndexClip& clip = {});

}  // namespace edgesplat::reference
