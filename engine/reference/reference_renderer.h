// The whole frame in double precision, passes 1 to 7. The GPU's pictures are tested against it.
#pragma once

#include <memory>

#include "engine/image/image.h"
#include "engine/reference/2b_occlude_ambient.h"
#include "engine/reference/4_sort_sheets.h"
#include "engine/reference/5_draw_splats.h"
#include "engine/reference/surfaces.h"

namespace edgesplat::reference {

enum class Output { Color, Tau, Depth, Distance, Normal };

/// Number of sheets between two tests of pixels for saturation.
constexpr int kSheetsPerGroup = 16;

/// Pass 1 of a volume and a scene, kept for several frames. The volume must outlive it.
class PreparedVolume {
  public:
    /// `quantised`: edges are rounded to the bits that the GPU stores. Throws Error for an invalid scene or settings.
    PreparedVolume(const Volume& volume, const Scene& scene, const Settings& settings, bool quantised = false);

    const Volume& volume() const { return *volume_; }
    const Scene& scene() const { return scene_; }
    const Settings& settings() const { return settings_; }
    /// Whether the scene has no other volume.
    bool is_alone() const { return added_.empty(); }
    const ScaledScene& scaled_scene() const { return scaled_; }
    const Footprints& footprints() const { return footprints_; }
    Field field() const { return {volume_->geometry.dims, values_, coefficients_}; }
    const std::vector<VoxelEdge>& edges() const { return edges_; }
    /// Edges of translucent matter at voxels outside it, in voxel order.
    const std::vector<CarriedEdge>& carried() const { return carried_; }
    /// Those of one voxel.
    std::span<const CarriedEdge> carried_by(std::size_t voxel) const;
    /// classified_values() of the voxels; empty without a transfer function.
    const std::vector<double>& classified() const { return classified_; }

    /// The surface splats that draw the scene instead (draws_surfaces); empty if kernels do.
    const std::vector<SplatRecord>& surfaces() const { return surfaces_; }

    /// Replaces the edge of this voxel and material.
    void replace_edge(std::size_t voxel, int material, const VoxelEdge& edge);

    /// Replaces the face of this voxel's surface splat.
    void replace_surface(std::size_t voxel, const VoxelEdge& edge);

    /// Passes 2 to 7. Color has 4 channels, Normal 3, the others 1, as engine/renderer.h documents. Throws Error for an
    /// invalid camera or a picture without pixels.
    Image render(const Camera& camera, int width, int height, Output output = Output::Color) const;

  private:
    /// The same for a part of a mixture. `whole`: all its matter, which attenuates light.
    PreparedVolume(const Volume& volume, const Scene& scene, const Settings& settings, bool quantised,
                   const Scene& whole);
    /// The surface splats, with the light that reaches them if `output` shows it. `matter`: of all volumes.
    std::vector<SplatRecord> lit_surfaces(Output output, std::span<const LightMatter> matter) const;
    /// Finds the light that reaches each splat: ambient occlusion and shadows.
    void find_light(std::span<SplatRecord> records, std::span<const LightMatter> matter) const;
    /// The kernels of passes 2 and 3, with the light that reaches them if `output` shows it.
    std::vector<SplatRecord> lit_kernels(const glm::dvec3& eye, Output output,
                                         std::span<const LightMatter> matter) const;
    /// All matter of the volume, which attenuates light.
    LightMatter light_matter() const { return {field(), shading_, lighting_, volume_->geometry}; }
    /// The part that surface splats draw, and the one that kernels draw; null if there is none.
    const PreparedVolume* opaque_part() const;
    const PreparedVolume* kernel_part() const;
    /// Adds the surfaces on the view's rays to those of other volumes. Their ways are in mm.
    void add_surfaces(SurfacePicture& seen, std::span<const SplatRecord> lit, const View& view, Output output) const;
    /// The view of the same camera in this volume, its rays moved by `offset`.
    View view_of(const Camera& camera, const glm::ivec2& size, const glm::dvec2& offset, Output output) const;
    /// Kernels of one volume.
    struct Kernels {
        const PreparedVolume* part;
        std::vector<SplatRecord> records;
    };
    class DrawnKernels;
    /// One picture with one ray per pixel, moved by `offset`, of the kernels of some volumes in the same sheets.
    /// `behind`: the surfaces at which rays end, their ways in mm, else null.
    static Image draw(std::span<const Kernels> kernels, const Camera& camera, const glm::ivec2& size,
                      const glm::dvec2& offset, Output output, const SurfacePicture* behind);

    const Volume* volume_;
    Scene scene_;
    Settings settings_;
    Scene lighting_;                ///< all matter, which attenuates light
    ScaledScene scaled_, shading_;  ///< of both scenes
    std::vector<float> values_, coefficients_;
    std::vector<VoxelEdge> edges_;
    std::vector<CarriedEdge> carried_;
    std::optional<SurfaceScene> surface_scene_;  ///< only if surface splats draw the scene
    std::vector<SplatRecord> surfaces_;
    std::vector<double> classified_;
    Footprints footprints_;
    std::shared_ptr<const PreparedVolume> opaque_, translucent_;  ///< the parts of a mixture, else null
    std::vector<std::shared_ptr<const PreparedVolume>> added_;    ///< the scene's other volumes
};

/// All passes at once.
Image render(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings, int width,
             int height, Output output = Output::Color);

}  // namespace edgesplat::reference
