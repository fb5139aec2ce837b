// Light on walls whose kernels have two faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/reference/5_draw_splats.h"
#include "engine/reference/reference_renderer.h"
#include "footprints/kernel.h"
#include "tests/unit/reference_volumes.h"

namespace edgesplat::reference {
namespace {

using namespace testing_volumes;

/// A plate across y in the middle of the grid, `thickness` voxels thick.
Volume plate(double thickness) {
    return sampled(glm::ivec3(24, 21, 24),
                   [&](const glm::dvec3& x) { return blurred(std::abs(x.y - 10.2) - thickness / 2); });
}

TEST(WallLight, ThinPlatesAreEvenlyLitFromBothSides) {
    Settings settings;
    settings.sheet_spacing = 0.25;
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        settings.sheets = sheets;
        for (const double thickness : {2.0, 2.4}) {
            const Volume volume = plate(thickness);
            const PreparedVolume prepared(volume, solid_scene(4), settings);
            for (const double side : {1.0, -1.0}) {
                Camera camera = looking_at(volume, {0, side, 0}, 60, 10);
                camera.up = {0, 0, 1};
                const Image image = prepared.render(camera, 24, 24);
                double low = 1e9, high = 0;
                for (int y = 2; y < 22; ++y) {
                    for (int x = 2; x < 22; ++x) {
                        const double l = static_cast<double>(image.at(x, y, 1));
                        low = std::min(low, l);
                        high = std::max(high, l);
                    }
                }
                std::printf("plate of %.1f from %+.0f, %s: luminance %.4f to %.4f\n", thickness, side,
                            std::string(name_of(sheets)).c_str(), low, high);
                // Face on, a headlight shows the material's own colour; at the picture's border, 5 degrees off, .4 %
                // less. The background contributes exp(-4 * 2).
                EXPECT_GE(low / high, 0.99);
                EXPECT_NEAR(high, 0.8, 0.01);
            }
        }
    }
}

TEST(WallLight, VoxelsBehindMiddleShowNearFace) {
    const Settings settings;
    const Volume volume = plate(2);
    const PreparedVolume prepared(volume, solid_scene(4), settings);
    const Camera camera = looking_at(volume, {0.3, 1, 0.2}, 60, 10);
    const View view(camera, volume.geometry, 8, 8);
    int walls = 0, turned = 0;
    for (std::size_t at = 0; at < prepared.edges().size(); ++at) {
        const VoxelEdge& edge = prepared.edges()[at];
        if (!edge.has_edge || !(edge.D2 < edge_reach(settings))) continue;
        const SplatRecord record{static_cast<std::uint32_t>(at), 1, edge};
        const glm::dvec3 n = payload_of(record, prepared.field(), prepared.scene(), view, settings, Payload::Normal);
        const glm::dvec3 to_eye = view.eye_index - glm::dvec3(prepared.field().voxel(at));
        ASSERT_GE(glm::dot(n, to_eye), 0);
        ++walls;
        turned += glm::dot(edge.n, to_eye) < 0 ? 1 : 0;
    }
    EXPECT_GT(walls, 500);
    EXPECT_GT(turned, walls / 4) << "with their own normals these voxels would be dark";
}

TEST(WallLight, ThickBodiesKeepTheirNormals) {
    const Volume volume = ball(24, 8);
    const Settings settings;
    const PreparedVolume prepared(volume, solid_scene(4), settings);
    const View view(looking_at(volume, {0.3, 1, 0.2}, 60, 10), volume.geometry, 8, 8);
    for (std::size_t at = 0; at < prepared.edges().size(); ++at) {
        const VoxelEdge& edge = prepared.edges()[at];
        if (!edge.has_edge) continue;
        const SplatRecord record{static_cast<std::uint32_t>(at), 1, edge};
        const glm::dvec3 n = payload_of(record, prepared.field(), prepared.scene(), view, settings, Payload::Normal);
        ASSERT_NEAR(glm::dot(n, edge.n), 1, 1e-12);
    }
}

}  // namespace
}  // namespace edgesplat::reference
