// Passes 3 and 4 with sliced sheets: every splat is in exactly the sheets that its support touches.
#include <algorithm>
#include <cmath>

#include "engine/reference/footprints.h"
#include "footprints/kernel.h"
#include "footprints/paper_warp.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kSlicedSize{48, 40};

struct SheetRange {
    bool drawn = false;
    int first = 0, last = 0;
};

struct Drawn {
    std::vector<SheetRange> ranges;
    std::vector<std::uint32_t> order;
    std::vector<shader::SheetGroup> groups;
};

Drawn drawn(DeviceUnderTest& state, const PassScene& s) {
    state.draw(s.scene, s.camera, layered(s.settings), kSlicedSize, shader::PAYLOAD_COLOR);
    Drawn result;
    for (const std::uint32_t code :
         download<std::uint32_t>(state, state.targets().sheet_of, state.lists().splat_count)) {
        const auto first = static_cast<int>(code & ((1U << shader::SHEET_BITS) - 1U));
        result.ranges.push_back(
            {code != shader::SHEET_NONE, first, first + static_cast<int>(code >> shader::SHEET_BITS)});
    }
    result.order =
        download<std::uint32_t>(state, state.targets().order, state.targets().drawn.mapped<std::uint32_t>(1)[0]);
    const auto groups = state.targets().groups.mapped<shader::SheetGroup>(state.plan().params.group_count);
    result.groups.assign(groups.begin(), groups.end());
    return result;
}

struct Variant {
    const char* name;
    FootprintMode mode;
    WarpFamily warp;
    double spacing;
};

class SlicedSheets : public NeedsLayers<testing::TestWithParam<Variant>> {
  protected:
    static PassScene with(PassScene s) {
        s.settings.sheets = SheetCut::Sliced;
        s.settings.footprints = GetParam().mode;
        s.settings.warp = GetParam().warp;
        s.settings.sheet_spacing = GetParam().spacing;
        if (GetParam().mode == FootprintMode::Isotropic) s.settings.edges = EdgeEstimator::Off;
        return s;
    }
};

TEST_P(SlicedSheets, ContainEverySplatThatTouchesThem) {
    for (const PassScene& plain : pass_scenes()) {
        const PassScene s = with(plain);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto records = device_records(state);
        const Drawn got = drawn(state, s);
        const Oracle oracle(s, records, kSlicedSize);
        const double thickness = reference::sheet_thickness(oracle.view, s.settings);
        const int base = state.plan().params.sheet_base, count = static_cast<int>(state.plan().params.sheet_count);
        // The device's box of splats contains whole rows: it may begin earlier.
        EXPECT_LE(base,
                  reference::sheets_of(records, oracle.field, oracle.view, s.settings, oracle.footprints).first());

        // The bounding sphere of an uncut kernel is centred at the voxel. The sphere of a kernel that a face cuts
        // contains the plain kernel, and is bounded by the largest reach. Half extents in sheets: minimum and maximum.
        const double unit =
            glm::length(glm::transpose(s.volume.geometry.index_to_world_axes) * oracle.view.frame.forward) / thickness;
        const auto extents = [&](const reference::VoxelEdge& edge) -> std::pair<double, double> {
            const double uncut = oracle.footprints.kernel().radius;
            if (!draws_warped(s.settings) || !edge.has_edge) return {uncut * unit, uncut * unit};
            const double least = draws_faces(s.settings) ? uncut : kPaperReach;
            // The sphere's centre may be off the voxel by the difference of the radii.
            const double most = draws_faces(s.settings) ? 2 * kernel_reach(s.settings) - uncut : kPaperReach;
            return {least * unit, most * unit};
        };
        std::size_t kept = 0, splats_examined = 0;
        double missed = 0;
        for (std::size_t i = 0; i < records.size(); ++i) {
            const SheetRange& range = got.ranges[i];
            if (!range.drawn) continue;
            ++kept;
            ASSERT_LE(range.first, range.last);
            ASSERT_GE(range.first, 0);
            ASSERT_LT(range.last, count);
            ASSERT_LE(range.last - range.first + 1, static_cast<int>(state.plan().sheets_per_splat));
            const auto [least, most] = extents(records[i].edge);
            const double middle =
                oracle.view.depth(glm::dvec3(oracle.field.voxel(records[i].voxel))) / thickness - base;
            const auto clamped = [&](double sheet) {
                return std::clamp(static_cast<int>(std::floor(sheet)), 0, count - 1);
            };
            // Near a plane between sheets either side is right, within the float32 rounding of some hundred sheets.
            ASSERT_GE(range.first, clamped(middle - most - 2e-3));
            ASSERT_LE(range.first, clamped(middle - least + 2e-3));
            ASSERT_GE(range.last, clamped(middle + least - 2e-3));
            ASSERT_LE(range.last, clamped(middle + most + 2e-3));
            // The splat must be invisible in all other sheets. Only a few splats are tested, since the reference
            // evaluates every pixel.
            if (kept % 60 != 1) continue;
            ++splats_examined;
            const auto& box = oracle.selected[i].box;
            for (int y = box.y0; y < box.y1; y += 3) {
                for (int column = box.x0; column < box.x1; column += 3) {
                    const auto tau = [&](double near, double far) {
                        return oracle.drawer.tau(static_cast<std::uint32_t>(i), column, y,
                                                 reference::DepthRange{near, far});
                    };
                    missed =
                        std::max({missed, tau(thickness * std::max(base - 100, 0), thickness * (base + range.first)),
                                  tau(thickness * (base + range.last + 1), thickness * (base + count + 100))});
                }
            }
        }
        EXPECT_GT(kept, 100U);
        EXPECT_GT(splats_examined, 3U);
        EXPECT_LE(missed, 1e-6);
    }
}

TEST_P(SlicedSheets, AreSortedStablyAndCompletely) {
    for (const PassScene& plain : pass_scenes()) {
        const PassScene s = with(plain);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const Drawn got = drawn(state, s);
        std::vector<std::uint32_t> want;
        std::vector<std::size_t> ends;  // of each sheet, as a position in the order
        for (int sheet = 0; sheet < static_cast<int>(state.plan().params.sheet_count); ++sheet) {
            for (std::uint32_t i = 0; i < got.ranges.size(); ++i) {
                const SheetRange& range = got.ranges[i];
                if (range.drawn && range.first <= sheet && sheet <= range.last) want.push_back(i);
            }
            ends.push_back(want.size());
        }
        ASSERT_EQ(got.order.size(), want.size());
        EXPECT_EQ(got.order, want);
        const std::size_t per_group = state.plan().params.sheets_per_group;
        std::size_t first = 0;
        for (std::size_t g = 0; g < got.groups.size(); ++g) {
            const std::size_t end = ends[std::min((g + 1) * per_group, ends.size()) - 1];
            EXPECT_EQ(got.groups[g].first, first) << "group " << g;
            EXPECT_EQ(got.groups[g].count, end - first) << "group " << g;
            first = end;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, SlicedSheets,
                         testing::Values(Variant{"faces", FootprintMode::Procedural, WarpFamily::Face, 0.5},
                                         Variant{"paper", FootprintMode::Procedural, WarpFamily::Paper, 0.25},
                                         Variant{"isotropic", FootprintMode::Isotropic, WarpFamily::Face, 1},
                                         Variant{"thick", FootprintMode::Procedural, WarpFamily::Face, 16}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace edgesplat::test
