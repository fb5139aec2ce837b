// Translucent matter of several volumes, whose kernels are drawn as one list: against the reference, in closed form,
// and against one volume with the matter of both.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "engine/reference/reference_renderer.h"
#include "engine/volume/labels.h"
#include "tests/passes/volumes_beside.h"

namespace edgesplat::test {
namespace {

constexpr Material cloud(const glm::dvec3& color, double extinction) {
    return {.color = color, .extinction = extinction};
}

/// Two translucent balls on different grids that reach into each other.
PassScene two_clouds() {
    PassScene s = two_balls();
    s.name = "two clouds";
    s.scene.materials[1] = cloud({1, 0.8, 0.5}, 0.1);
    s.scene.added[0].materials[1] = cloud({0.4, 0.6, 1}, 0.2);
    return s;
}

const std::vector<TransferPoint> kTable{{-2, {0.2, 0.4, 1}, 0}, {3, {0.4, 1, 0.5}, 0.1}, {8, {1, 0.3, 0.2}, 0.25}};

void use_table(Scene& scene) {
    scene.iso_values = {1};
    scene.materials = {{}, {}};
    scene.transfer = kTable;
}

void use_table(AddedVolume& volume) {
    volume.iso_values = {1};
    volume.materials = {{}, {}};
    volume.transfer = {{-1, {1, 0.2, 0.2}, 0}, {4, {1, 1, 0.2}, 0.3}};
}

std::vector<PassScene> cloud_scenes() {
    std::vector<PassScene> all{two_clouds()};
    const auto add = [&](const char* name, const auto& change) {
        all.push_back(two_clouds());
        all.back().name = name;
        change(all.back());
    };
    add("table and cloud", [](PassScene& s) { use_table(s.scene); });
    add("two tables", [](PassScene& s) {
        use_table(s.scene);
        use_table(s.scene.added[0]);
    });
    add("opaque table", [](PassScene& s) {
        use_table(s.scene);
        s.scene.transfer.back().extinction = 9;
    });
    add("mixture and cloud", [](PassScene& s) {
        s.scene.iso_values = {0, 4};
        s.scene.materials = {{}, cloud({0.3, 0.5, 1}, 0.12), solid_matter({1, 0.8, 0.5})};
    });
    add("two mixtures", [](PassScene& s) {
        s.scene.iso_values = {0, 4};
        s.scene.materials = {{}, cloud({0.3, 0.5, 1}, 0.12), solid_matter({1, 0.8, 0.5})};
        s.scene.added[0].iso_values = {0, 3};
        s.scene.added[0].materials = {{}, cloud({0.3, 1, 0.5}, 0.2), solid_matter({1, 0.3, 0.3})};
    });
    add("three clouds and a core", [](PassScene& s) {
        s.scene.added.push_back(
            added_volume(ball_on_grid({-6, -4, -3}, 5, 0.8 * kOblique), {0}, {solid_matter({0.5, 1, 0.5})}));
        s.scene.added.push_back(
            added_volume(ball_on_grid({0, 0, 0}, 12, 1.7 * kStraight), {0}, {cloud({1, 0.5, 0.5}, 0.05)}));
    });
    add("one is cut", [](PassScene& s) {
        s.scene.effects.clip.keep = {{{2, -4, 0}, {0.2, -1, 0.3}}};
        s.scene.added[0].clipped = false;
    });
    add("a region is removed from one", [](PassScene& s) {
        s.scene.effects.clip.remove = {{{0, -3, 0}, {0.2, 1, 0.3}}, {{1, 0, 0}, {-1, 0, 0}}};
        s.scene.added[0].clipped = false;
    });
    add("inside", [](PassScene& s) {
        s.scene.added[0] =
            added_volume(ball_on_grid({1, -2, 0.5}, 4, 0.7 * kOblique), {-1.5}, {cloud({0.4, 0.6, 1}, 0.2)});
        s.scene.added[0].replaces = true;
    });
    add("mixtures, one inside", [](PassScene& s) {
        s.scene.iso_values = {0, 4};
        s.scene.materials = {{}, cloud({0.3, 0.5, 1}, 0.12), solid_matter({1, 0.8, 0.5})};
        s.scene.added[0] = added_volume(ball_on_grid({0, 0, 0}, 6, 0.6 * kOblique), {-1.5, 2},
                                        {cloud({0.3, 0.5, 1}, 0.12), solid_matter({1, 0.8, 0.5})});
        s.scene.added[0].replaces = true;
        s.scene.added[0].rim = 2;
    });
    add("eye in both", [](PassScene& s) {
        s.camera = {.eye = {4, -2, 1}, .direction = {-3, 5, -1}, .up = {0, 0, 1}, .fov_y = 90};
    });
    add("shaded", [](PassScene& s) {
        s.scene.lights[0] = directional_light({0.8, -0.5, 0.3});
        s.scene.lights[0].shadows = true;
        s.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 6};
        s.scene.ambient = 0.5;
    });
    add("outlines", [](PassScene& s) {
        s.scene.effects.smooth_outlines = true;
        s.scene.materials[1].extinction = 0.6;
    });
    add("sliced", [](PassScene& s) {
        s.settings.sheets = SheetCut::Sliced;
        s.settings.sheet_spacing = 1;
    });
    add("as in the paper", [](PassScene& s) { s.settings = paper_settings(s.settings); });
    add("plain", [](PassScene& s) { s.settings.edges = EdgeEstimator::Off; });
    return all;
}

TEST(TranslucentVolumes, LookLikeTheReferences) {
    expect_references(cloud_scenes());
}

TEST(TranslucentVolumes, DoNotDependOnTheirOrder) {
    expect_no_order(cloud_scenes());
}

/// Half of the matter twice is the matter once.
TEST(TranslucentVolumes, AddTheirMatter) {
    const auto compare = [](const char* name, double least, const auto& change) {
        PassScene once = two_clouds();
        once.scene.added.clear();
        change(once);
        // How deep light falls into matter depends on the extinction of its own volume alone.
        once.scene.lights.clear();
        PassScene twice = once;
        for (Material& material : twice.scene.materials)
            material.extinction /= 2;
        for (TransferPoint& point : twice.scene.transfer)
            point.extinction /= 2;
        twice.scene.added = {AddedVolume{.volume = std::make_shared<const Volume>(once.volume),
                                         .iso_values = twice.scene.iso_values,
                                         .materials = twice.scene.materials,
                                         .transfer = twice.scene.transfer,
                                         .label_colors = {}}};
        const auto want = drawn_beside(once);
        const double same = decibels_between(drawn_beside(twice), want);
        // The same ball, sampled on another grid.
        if (twice.scene.transfer.empty()) twice.scene.added[0].volume = ball_on_grid({0, 0, 0}, 8, kOblique);
        const double turned = decibels_between(drawn_beside(twice), want);
        std::printf("%-8s on one grid %.1f dB, on two %.1f dB\n", name, same, turned);
        EXPECT_GE(same, 100);
        EXPECT_GE(turned, least);
    };
    compare("cloud", 95, [](PassScene&) {});
    compare("dense", 90, [](PassScene& s) { s.scene.materials[1].extinction = 0.4; });
    compare("table", 100, [](PassScene& s) { use_table(s.scene); });
}

/// A coarse scan of the whole, a fine one of two thirds: inside the rim the picture is that of the fine whole, outside
/// that of the coarse one, and along the rim it lies between both.
TEST(TranslucentVolumes, GiveWayAlongTheRim) {
    PassScene fine;
    fine.volume = sample(torus_scene({56, 52, 40}, {27.3, 25.6, 19.4}, 15.2, 7.6));
    fine.scene.iso_values = {0.5};
    fine.scene.materials = {{}, cloud({1, 0.8, 0.5}, 0.08)};
    fine.settings.pixels = PixelChoice::Every;
    fine.camera = {.eye = {27, -120, 62}, .direction = {0, 145, -43}, .up = {0, 0, 1}, .fov_y = 22};
    PassScene coarse = fine;
    coarse.volume = halved(fine.volume);
    PassScene both = coarse;
    constexpr int kLast = 36;
    constexpr double kRim = 12;  // six voxels of the coarse scan
    both.scene.added = {added_volume(std::make_shared<const Volume>(cropped(fine.volume, {0, 0, 0}, {kLast, 51, 39})),
                                     {0.5}, {fine.scene.materials[1]})};
    both.scene.added[0].replaces = true;
    const auto want = drawn_beside(fine), other = drawn_beside(coarse), got = drawn_beside(both);
    const reference::View view(fine.camera, fine.volume.geometry, kBesideSize.x, kBesideSize.y);
    double in_fine = 0, beyond = 0, worst = 0;
    int fine_pixels = 0, other_pixels = 0, rim_pixels = 0;
    for (int y = 0; y < kBesideSize.y; ++y)
        for (int x = 0; x < kBesideSize.x; ++x) {
            const auto i = static_cast<std::size_t>(y * kBesideSize.x + x);
            // The ray through the torus between these x, voxels.
            const glm::dvec3 u = view.ray(x, y);
            const auto x_at = [&](double depth) { return view.eye_index.x + u.x / u.y * (depth - view.eye_index.y); };
            const double low = std::min(x_at(0), x_at(51)), high = std::max(x_at(0), x_at(51));
            const auto squares = [&](const glm::vec4& by) { return static_cast<double>(glm::dot(by, by)) / 4; };
            if (want[i].a < 0.02F) continue;
            if (high < kLast - kRim - 2.5) {
                in_fine += squares(got[i] - want[i]);
                ++fine_pixels;
            } else if (low > kLast + 2.5) {
                beyond += squares(got[i] - other[i]);
                ++other_pixels;
            } else {
                ++rim_pixels;
                const glm::vec4 least = glm::min(want[i], other[i]), most = glm::max(want[i], other[i]);
                const glm::vec4 off = glm::abs(got[i] - glm::clamp(got[i], least, most));
                worst = std::max(worst, static_cast<double>(std::max({off.r, off.g, off.b, off.a})));
            }
        }
    std::printf("fine part %.1f dB, coarse part %.1f dB, rim at most %.4f off\n",
                -10 * std::log10(in_fine / fine_pixels + 1e-20), -10 * std::log10(beyond / other_pixels + 1e-20),
                worst);
    EXPECT_GT(std::min({fine_pixels, other_pixels, rim_pixels}), 100);
    EXPECT_LE(in_fine / fine_pixels, 1e-6);
    EXPECT_LE(beyond / other_pixels, 1e-6);
    EXPECT_LE(worst, 0.01);
}

/// What two balls let through along a ray depends on the lengths in both alone.
TEST(TranslucentVolumes, AbsorbAsTheirLengthsOnTheRays) {
    PassScene s = two_clouds();
    s.scene.lights.clear();
    const auto got = drawn_beside(s);
    const reference::View view(s.camera, s.volume.geometry, kBesideSize.x, kBesideSize.y);
    double squares = 0;
    int both = 0, met = 0;
    for (int y = 0; y < kBesideSize.y; ++y)
        for (int x = 0; x < kBesideSize.x; ++x) {
            double tau = 0;
            int balls = 0;
            for (const auto& [middle, radius, extinction] :
                 {std::tuple{glm::dvec3(0), 8.0, s.scene.materials[1].extinction},
                  {glm::dvec3(7, -3, 2), 6.0, s.scene.added[0].materials[1].extinction}}) {
                const glm::dvec3 from = s.camera.eye - middle, u = view.ray(x, y);
                const double b = glm::dot(from, u), beside2 = glm::dot(from, from) - b * b;
                tau += extinction * 2 * std::sqrt(std::max(radius * radius - beside2, 0.0));
                balls += beside2 < radius * radius ? 1 : 0;
            }
            both += balls == 2 ? 1 : 0;
            met += balls > 0 ? 1 : 0;
            const double a = static_cast<double>(got[static_cast<std::size_t>(y * kBesideSize.x + x)].a);
            squares += balls > 0 ? std::pow(a - (1 - std::exp(-tau)), 2) : a * a;
        }
    const double psnr = -10 * std::log10(squares / met);
    std::printf("%.1f dB of %d pixels, %d behind both\n", psnr, met, both);
    EXPECT_GT(both, 100);
    EXPECT_GE(psnr, 45);
}

/// More splats in a sheet than are prepared at once.
TEST(TranslucentVolumes, LookTheSameBeyondThePreparedSplats) {
    PassScene s = two_clouds();
    s.volume = *ball_on_grid({0, 0, 0}, 16, kStraight);
    s.scene.added[0] = added_volume(ball_on_grid({7, -3, 2}, 14, kOblique), {0}, {cloud({0.4, 0.6, 1}, 0.1)});
    s.settings.sheet_spacing = 16;
    const auto got = drawn_beside(s);
    const FramePlan& plan = device_under_test().plan();
    const auto starts = device_under_test().targets().sheet_starts.mapped<std::uint32_t>(plan.params.sheet_count + 1);
    std::uint32_t most = 0;
    for (std::uint32_t sheet = 0; sheet < plan.params.sheet_count; ++sheet)
        most = std::max(most, starts[sheet + 1] - starts[sheet]);
    EXPECT_GT(most, plan.params.prepared_mask + 1);
    const reference::PreparedVolume reference(s.volume, s.scene, s.settings, true);
    EXPECT_GE(decibels_beside(got, reference.render(s.camera, kBesideSize.x, kBesideSize.y).pixels, 4, 1), 55);
}

/// The names in messages and the colours of labels are those of the splat's volume.
TEST(TranslucentVolumes, HaveTheirOwnLabelColors) {
    const auto labelled = [](const glm::dvec3& origin, int width) {
        auto volume = std::make_shared<Volume>();
        volume->geometry.dims = {10, 10, 10};
        volume->geometry.origin = origin;
        for (int i = 0; i < 1000; ++i) {
            const glm::ivec3 at(i % 10, i / 10 % 10, i / 100);
            const bool inside = std::min({at.x, at.y, at.z}) > 1 && std::max({at.x, at.y, at.z}) < 8;
            volume->values.push_back(inside ? static_cast<float>(1 + (at.x - 2) / width) : 0.0F);
        }
        finish_volume(*volume);
        return volume;
    };
    PassScene s;
    s.name = "labels";
    s.volume = drawn_labels(*labelled({-5, -5, -5}, 2));
    s.scene.iso_values = {0.5};
    s.scene.materials = {{}, cloud({1, 1, 1}, 0.2)};
    s.scene.label_colors = {{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // the first is the background's
    s.scene.lights.clear();
    s.scene.added = {added_volume(std::make_shared<const Volume>(drawn_labels(*labelled({2, -8, 0}, 3))), {0.5},
                                  {cloud({1, 1, 1}, 0.2)})};
    s.scene.added[0].label_colors = {{}, {1, 1, 0}, {0, 1, 1}};
    s.settings.pixels = PixelChoice::Every;
    s.camera = {.eye = {9, -50, 22}, .direction = {-7, 49, -21}, .up = {0.1, 0.05, 1}, .fov_y = 26};
    const auto got = drawn_beside(s);
    const reference::PreparedVolume reference(s.volume, s.scene, s.settings, true);
    EXPECT_GE(decibels_beside(got, reference.render(s.camera, kBesideSize.x, kBesideSize.y).pixels, 4, 1), 50);
}

}  // namespace
}  // namespace edgesplat::test
