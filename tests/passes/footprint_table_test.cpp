// Footprints from the table: the selection in pass 3, and the pictures of both drawing methods.
#include <cstdio>

#include "engine/image/image_compare.h"
#include "engine/plan/resources.h"
#include "footprints/footprint_table.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kTableSize{72, 64};
constexpr std::uint32_t kPlain = 1U << 31U, kIntegrated = 1U << 30U, kBlend = 1023;

PassScene with_table(PassScene s) {
    s.settings.footprints = FootprintMode::Table;
    return s;
}

Settings tiled(Settings settings) {
    settings.sheet_format = SheetFormat::Tiles;
    return settings;
}

/// The axis of a record; 0 for a plain kernel.
glm::dvec3 axis_of(const glm::uvec2& record) {
    if ((record.x & kPlain) != 0) return glm::dvec3(0);
    return decode_edge(record.y, shader::EDGE_NORMAL << 26U).n;
}

TEST(SelectLayers, MatchesTheReferenceForLayersAndTiles) {
    for (const PassScene& plain : pass_scenes()) {
        const PassScene s = with_table(plain);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto records = device_records(state);
        const Oracle oracle(s, records, kTableSize);
        for (const Settings& settings : {layered(s.settings), tiled(s.settings)}) {
            if (settings.sheet_format == SheetFormat::Layers && !layers_obstacle().empty()) continue;
            state.draw(s.scene, s.camera, settings, kTableSize, shader::PAYLOAD_COLOR);
            const auto sheets = download<std::uint32_t>(state, state.targets().sheet_of, records.size());
            const auto got = download<glm::uvec2>(state, state.targets().footprints, records.size());
            std::size_t plain_ones = 0, cut = 0, other = 0;
            // With culled bricks, slots are not splat numbers.
            if (state.plan().variant.culled) continue;
            for (std::size_t i = 0; i < records.size(); ++i) {
                if (sheets[i] == shader::SHEET_NONE) continue;
                const FootprintLayer& want = oracle.selected[i].layer;
                const bool is_plain = (got[i].x & kPlain) != 0;
                ++(is_plain ? plain_ones : cut);
                EXPECT_EQ(is_plain, oracle.selected[i].axis == glm::dvec3(0)) << "splat " << i;
                EXPECT_EQ((got[i].x & kIntegrated) == 0, oracle.footprints.tabulated(records[i].edge)) << "splat " << i;
                const auto layer =
                    decode_footprint_layer(got[i].x & ~(kPlain | kIntegrated), table_depth(s.scene, s.volume.geometry));
                EXPECT_NEAR(layer.middle, want.middle, 1e-3) << "splat " << i;
                EXPECT_NEAR(layer.cosine, want.cosine, 1e-3) << "splat " << i;
                other += (layer.code & kBlend) != (want.code & kBlend) ? 1U : 0U;
                // Along the normal, any axis is right.
                const double turned = glm::length(axis_of(got[i]) - oracle.selected[i].axis);
                EXPECT_LT(want.cosine < 0.99 ? turned : 0, 2e-3) << "splat " << i;
            }
            EXPECT_GT(cut, 100U);
            EXPECT_LE(other, cut / 100) << "of " << cut;
            EXPECT_GT(plain_ones + cut, 200U);
        }
    }
}

TEST(FootprintTableOnTheDevice, ExistsOnlyWhileNeeded) {
    PassScene s = pass_scenes()[0];
    DeviceUnderTest& state = prepared(s);
    const auto draw = [&](FootprintMode mode) {
        s.settings.footprints = mode;
        state.draw(s.scene, s.camera, s.settings, kTableSize, shader::PAYLOAD_COLOR);
    };
    draw(FootprintMode::Procedural);
    EXPECT_FALSE(state.targets().footprint_table);
    EXPECT_FALSE(state.targets().footprints);
    draw(FootprintMode::Table);
    ASSERT_TRUE(state.targets().footprint_table);
    EXPECT_GE(state.targets().footprints.bytes(), state.lists().splat_count * sizeof(glm::uvec2));
    const auto got = download<std::uint16_t>(state, state.targets().footprint_table);
    const double depth = table_depth(s.scene, s.volume.geometry);
    EXPECT_TRUE(std::ranges::equal(got, kept_footprint_table(depth).texels()));
    // The other scene's faces have another depth.
    s.scene.materials.back().extinction = depth < FACE_DEPTH ? 40 : 0.1;
    draw(FootprintMode::Table);
    const double other = table_depth(s.scene, s.volume.geometry);
    ASSERT_NE(other, depth);
    EXPECT_TRUE(std::ranges::equal(download<std::uint16_t>(state, state.targets().footprint_table),
                                   kept_footprint_table(other).texels()));
    draw(FootprintMode::Isotropic);
    EXPECT_FALSE(state.targets().footprint_table);
    EXPECT_FALSE(state.targets().footprints);
}

}  // namespace
}  // namespace edgesplat::test
