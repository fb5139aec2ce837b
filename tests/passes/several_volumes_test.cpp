// Scenes of several volumes, each on its own grid: on the device, by the reference, and in closed form.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/reference/reference_renderer.h"
#include "engine/renderer.h"
#include "tests/passes/volumes_beside.h"

namespace edgesplat::test {
namespace {

std::vector<PassScene> scenes() {
    std::vector<PassScene> all{two_balls()};
    const auto add = [&](const char* name, const auto& change) {
        all.push_back(two_balls());
        all.back().name = name;
        change(all.back());
    };
    add("core in a shell", [](PassScene& s) {
        // Translucent matter of one volume around opaque matter of another.
        s.scene.materials[1] = {{0.3, 0.5, 1}, 0.12};
        s.scene.added = {added_volume(ball_on_grid({1, -1, 0.5}, 5, kOblique), {0}, {solid_matter({1, 0.8, 0.5})})};
    });
    add("shell around a core", [](PassScene& s) {
        s.scene.added = {added_volume(ball_on_grid({1, -1, 0.5}, 11, kOblique), {0}, {{{0.3, 0.5, 1}, 0.1}})};
    });
    add("transfer function", [](PassScene& s) {
        s.scene.iso_values = {1};
        s.scene.materials = {{}, {}};
        s.scene.transfer = {{-2, {0.2, 0.4, 1}, 0}, {3, {0.4, 1, 0.5}, 0.1}, {8, {1, 0.3, 0.2}, 0.25}};
    });
    add("mixture and ball", [](PassScene& s) {
        s.scene.iso_values = {0, 4};
        s.scene.materials = {{}, {{0.3, 0.5, 1}, 0.12}, solid_matter({1, 0.8, 0.5})};
    });
    add("thin layers", [](PassScene& s) {
        s.scene.iso_values = {0, 0.9};
        s.scene.materials = {{}, {{1, 0.8, 0.5}, 4.1}, {}};
        s.scene.added[0].iso_values = {0, 1};
        s.scene.added[0].materials = {{}, {{0.4, 0.6, 1}, 6.5}, {}};
    });
    add("one is cut", [](PassScene& s) {
        s.scene.effects.clip.keep = {{{2, -4, 0}, {0.2, -1, 0.3}}};
        s.scene.added[0].clipped = false;
    });
    add("three", [](PassScene& s) {
        s.scene.added.push_back(
            added_volume(ball_on_grid({-6, -4, -3}, 5, 0.8 * kOblique), {0}, {solid_matter({0.5, 1, 0.5})}));
        s.scene.added.push_back(added_volume(ball_on_grid({0, 0, 0}, 12, kStraight), {0}, {{{1, 0.5, 0.5}, 0.05}}));
    });
    add("eye between", [](PassScene& s) {
        s.camera = {.eye = {1, -13, 3}, .direction = {2, 10, -2}, .up = {0, 0, 1}, .fov_y = 90};
    });
    add("shadowed", [](PassScene& s) {
        s.scene.lights[0] = directional_light({0.8, -0.5, 0.3});
        s.scene.lights[0].shadows = true;
        s.scene.lights.push_back({.kind = Light::Kind::Point, .position = {40, -30, 10}, .shadows = true});
    });
    add("occluded", [](PassScene& s) {
        s.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 6};
        s.scene.ambient = 0.8;
    });
    add("shaded in a shell", [](PassScene& s) {
        // Kernels, cut by a plane that does not cut the other volume, attenuate its light and it theirs.
        s.scene.materials[1] = {{0.3, 0.5, 1}, 0.12};
        s.scene.effects.clip.keep = {{{2, -2, 0}, {0.2, -1, 0.3}}};
        s.scene.added = {added_volume(ball_on_grid({3, -1, 0.5}, 5, kOblique), {0}, {solid_matter({1, 0.8, 0.5})})};
        s.scene.added[0].clipped = false;
        s.scene.lights[0].shadows = true;
        s.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 6};
        s.scene.ambient = 0.5;
    });
    add("inside", [](PassScene& s) {
        // The surfaces of both lie half a voxel apart.
        s.scene.added[0] =
            added_volume(ball_on_grid({2, -4, 1}, 5, 0.7 * kOblique), {-0.5}, {solid_matter({1, 0.8, 0.5})});
        s.scene.added[0].replaces = true;
    });
    add("outlines", [](PassScene& s) { s.scene.effects.smooth_outlines = true; });
    add("refined", [](PassScene& s) {
        s.settings.pixels = PixelChoice::Refined;
        s.camera = {.eye = {9, -24, 8}, .direction = {-6, 24, -8}, .up = {0, 0, 1}, .fov_y = 30};
    });
    return all;
}

TEST(SeveralVolumes, LookLikeTheReferences) {
    expect_references(scenes());
}

TEST(SeveralVolumes, HaveTheReferencesOutputs) {
    const PassScene s = two_balls();
    const reference::PreparedVolume reference(s.volume, s.scene, s.settings, true);
    for (const auto& [payload, output, channels, scale] :
         {std::tuple{shader::PAYLOAD_NORMAL, reference::Output::Normal, 3, 1.0},
          {shader::PAYLOAD_DEPTH_DISTANCE, reference::Output::Depth, 1, 50.0}}) {
        const auto got = drawn_beside(s, payload);
        const Image want = reference.render(s.camera, kBesideSize.x, kBesideSize.y, output);
        EXPECT_GE(decibels_beside(got, want.pixels, channels, scale), 45) << payload;
    }
}

/// Two balls without light: each pixel has the colour of the nearer one.
TEST(SeveralVolumes, AreExactForUnlitBalls) {
    PassScene s = two_balls();
    s.scene.lights.clear();
    const auto got = drawn_beside(s);
    const reference::View view(s.camera, s.volume.geometry, kBesideSize.x, kBesideSize.y);
    int wrong = 0, met = 0;
    for (int y = 0; y < kBesideSize.y; ++y)
        for (int x = 0; x < kBesideSize.x; ++x) {
            double nearest = 1e9;
            glm::dvec4 want(0);
            bool touches = false;
            for (const auto& [middle, radius, color] :
                 {std::tuple{glm::dvec3(0), 8.0, s.scene.materials[1].color},
                  {glm::dvec3(7, -3, 2), 6.0, s.scene.added[0].materials[1].color}}) {
                const glm::dvec3 from = s.camera.eye - middle, u = view.ray(x, y);  // both grids' first is the world's
                const double b = glm::dot(from, u), beside = std::sqrt(glm::dot(from, from) - b * b);
                touches = touches || std::abs(beside - radius) < 0.15;
                const double at = -b - std::sqrt(std::max(radius * radius - beside * beside, 0.0));
                if (beside > radius || at > nearest) continue;
                touches = touches || std::abs(at - nearest) < 0.3;
                nearest = at;
                want = glm::dvec4(color, 1);
            }
            if (touches) continue;
            met += want.a > 0 ? 1 : 0;
            const glm::dvec4 off = glm::abs(glm::dvec4(got[static_cast<std::size_t>(y * kBesideSize.x + x)]) - want);
            wrong += std::max({off.x, off.y, off.z, off.w}) > 2e-3 ? 1 : 0;
        }
    EXPECT_GT(met, 800);
    // Where both balls' surfaces meet, the nearer one may be either.
    EXPECT_LE(wrong, 12);
}

TEST(SeveralVolumes, DoNotDependOnTheirOrder) {
    expect_no_order(scenes());
}

/// The same object twice, on different grids, is the object once.
TEST(SeveralVolumes, OfOneObjectShowThatObject) {
    PassScene alone = two_balls();
    alone.scene.added.clear();
    PassScene twice = two_balls();
    twice.scene.added = {added_volume(ball_on_grid({0, 0, 0}, 8, kOblique), {0}, {twice.scene.materials[1]})};
    const auto one = drawn_beside(alone), two = drawn_beside(twice);
    std::vector<float> want;
    for (const glm::vec4& pixel : one)
        want.insert(want.end(), &pixel.x, &pixel.x + 4);
    EXPECT_GE(decibels_beside(two, want, 4, 1), 50);
}

/// Light that both take is as if one volume had the matter of both.
TEST(SeveralVolumes, ShadeEachOtherAsOneVolumeWould) {
    constexpr glm::dvec3 kBallMiddle(0, 4, 13);
    PassScene two = two_balls();
    two.scene.added[0] = added_volume(ball_on_grid(kBallMiddle, 4, kOblique), {0}, {two.scene.materials[1]});
    two.camera = {.eye = {9, -40, 45}, .direction = {-9, 41, -40}, .up = {0, 0, 1}, .fov_y = 30};
    PassScene one = two;
    one.scene.added.clear();
    VolumeGeometry& geometry = one.volume.geometry;
    geometry.dims = {24, 24, 34};
    geometry.origin = {-11.3, -11.4, -11.2};
    one.volume.values.clear();
    for (int z = 0; z < geometry.dims.z; ++z)
        for (int y = 0; y < geometry.dims.y; ++y)
            for (int x = 0; x < geometry.dims.x; ++x) {
                const glm::dvec3 at = geometry.to_world(glm::dvec3(x, y, z));
                one.volume.values.push_back(
                    static_cast<float>(std::max(8 - glm::length(at), 4 - glm::length(at - kBallMiddle))));
            }
    finish_volume(one.volume);
    const auto compare = [&](const char* name, double least, const auto& change) {
        PassScene a = two, b = one, alone = two;
        for (PassScene* s : {&a, &b, &alone})
            change(s->scene);
        alone.scene.lights[0].shadows = false;
        alone.scene.effects.occlusion.reset();
        const auto together = drawn_beside(a), whole = drawn_beside(b), unshaded = drawn_beside(alone);
        std::vector<float> want;
        for (const glm::vec4& pixel : whole)
            want.insert(want.end(), &pixel.x, &pixel.x + 4);
        const double psnr = decibels_beside(together, want, 4, 1), without = decibels_beside(unshaded, want, 4, 1);
        std::printf("%-10s %.1f dB, with light from everywhere %.1f dB\n", name, psnr, without);
        EXPECT_GE(psnr, least);
        EXPECT_GE(psnr, without + 8);
    };
    compare("shadows", 30, [](Scene& scene) {
        scene.lights[0] = directional_light({0, 0.5, 1});
        scene.lights[0].shadows = true;
    });
    compare("occlusion", 30, [](Scene& scene) {
        scene.lights[0].intensity = 0;
        scene.ambient = 1;
        scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 12};
    });
}

/// A coarse scan of the whole, a fine one of two thirds: the picture is that of the fine whole, without a seam.
TEST(SeveralVolumes, InsideAFinerScanOnlyThatIsShown) {
    PassScene fine;
    fine.volume = sample(torus_scene({56, 52, 40}, {27.3, 25.6, 19.4}, 15.2, 7.6));
    fine.scene.iso_values = {0.5};
    fine.scene.materials = {{}, solid_matter({1, 0.8, 0.5})};
    fine.settings.pixels = PixelChoice::Every;
    fine.camera = {.eye = {30, -50, 62}, .direction = {-3, 75, -43}, .up = {0, 0, 1}, .fov_y = 34};
    PassScene both = fine;
    both.volume = halved(fine.volume);
    constexpr int kLast = 36;
    both.scene.added = {added_volume(std::make_shared<const Volume>(cropped(fine.volume, {0, 0, 0}, {kLast, 51, 39})),
                                     {0.5}, {fine.scene.materials[1]})};
    both.scene.added[0].replaces = true;
    PassScene coarse = both;
    coarse.scene.added.clear();
    const auto want = drawn_beside(fine), depths = drawn_beside(fine, shader::PAYLOAD_DEPTH_DISTANCE),
               got = drawn_beside(both), whole_coarse = drawn_beside(coarse);
    const reference::View view(fine.camera, fine.volume.geometry, kBesideSize.x, kBesideSize.y);
    struct Part {
        int pixels = 0, off = 0;  // by more than a hundredth of full scale
        double squares = 0;
        void add(const glm::vec4& by) {
            ++pixels;
            squares += static_cast<double>(glm::dot(by, by)) / 4;
            off += std::max({std::abs(by.r), std::abs(by.g), std::abs(by.b), std::abs(by.a)}) > 0.01F ? 1 : 0;
        }
        double decibels() const { return -10 * std::log10(squares / pixels + 1e-20); }
    };
    Part in_fine, at_seam, beyond;
    for (int y = 1; y + 1 < kBesideSize.y; ++y)
        for (int x = 1; x + 1 < kBesideSize.x; ++x) {
            const auto i = static_cast<std::size_t>(y * kBesideSize.x + x);
            const auto inner = [&](std::size_t at) { return want[at].a > 0.999F; };
            // Where a ray only touches the torus, it sees all of it or nothing.
            const auto width = static_cast<std::size_t>(kBesideSize.x);
            if (!inner(i) || !inner(i - 1) || !inner(i + 1) || !inner(i - width) || !inner(i + width)) continue;
            const glm::dvec3 u = view.ray(x, y);
            const double depth = static_cast<double>(depths[i].x);
            const glm::dvec3 at = view.eye_index + u * (depth / glm::dot(u, view.frame.forward));
            const double beside = at.x - (kLast - 1);  // of the cut, voxels
            // At the seam nothing is seen that neither scan shows: what counts is how far a colour is from both.
            const glm::vec4 low = glm::min(want[i], whole_coarse[i]), high = glm::max(want[i], whole_coarse[i]);
            if (beside < -1.5)
                in_fine.add(got[i] - want[i]);
            else if (beside < 1.5)
                at_seam.add(got[i] - glm::clamp(got[i], low, high));
            else
                beyond.add(got[i] - whole_coarse[i]);
        }
    std::printf("fine part %.1f dB; seam %.1f dB, off %d of %d; coarse part %.1f dB\n", in_fine.decibels(),
                at_seam.decibels(), at_seam.off, at_seam.pixels, beyond.decibels());
    EXPECT_GT(in_fine.pixels, 300);
    EXPECT_GT(at_seam.pixels, 40);
    EXPECT_GT(beyond.pixels, 100);
    EXPECT_GE(in_fine.decibels(), 60);
    EXPECT_GE(beyond.decibels(), 60);
    EXPECT_GE(at_seam.decibels(), 48);
}

/// A volume without matter changes no bit.
TEST(SeveralVolumes, CostNothingIfTheyHaveNoMatter) {
    for (PassScene s : scenes()) {
        if (s.scene.added[0].replaces) continue;
        SCOPED_TRACE(s.name);
        PassScene alone = s;
        alone.scene.added.clear();
        for (AddedVolume& beside : s.scene.added)
            for (Material& material : beside.materials)
                material.extinction = 0;
        alone.scene.clipped = s.scene.clipped = true;
        EXPECT_TRUE(drawn_beside(s) == drawn_beside(alone));
    }
}

/// Whatever lies beside a volume, the picture is finite, and opacities are shares.
TEST(SeveralVolumes, GiveFiniteNumbers) {
    const auto far = [](double by) {
        auto moved = std::make_shared<Volume>(*ball_on_grid({0, 0, 0}, 6, kOblique));
        moved->geometry.origin.x += by;
        return moved;
    };
    const auto with_holes = [] {
        auto holed = std::make_shared<Volume>(*ball_on_grid({7, -3, 2}, 6, kOblique));
        for (std::size_t i = 0; i < holed->values.size(); i += 7)
            holed->values[i] =
                i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
        finish_volume(*holed);
        return holed;
    };
    const auto slice = [] {
        auto flat = std::make_shared<Volume>();
        flat->geometry.dims = {9, 9, 1};
        flat->geometry.origin = {-4, -12, 0};
        for (int i = 0; i < 81; ++i)
            flat->values.push_back(static_cast<float>(i % 9 > 2));
        finish_volume(*flat);
        return flat;
    };
    const auto constant = [] {
        auto same = std::make_shared<Volume>();
        same->geometry.dims = {4, 4, 4};
        same->values.assign(64, 3);
        finish_volume(*same);
        return same;
    };
    std::vector<std::pair<const char*, AddedVolume>> beside;
    const auto add = [&](const char* name, std::shared_ptr<const Volume> volume, double iso) {
        beside.emplace_back(name, added_volume(std::move(volume), {iso}, {solid_matter({0.4, 0.6, 1})}));
    };
    add("far away", far(1e6), 0);
    add("behind the eye", far(-300), 0);
    add("samples without data", with_holes(), 0);
    add("a slice", slice(), 0.5);
    add("one value", constant(), 2);
    add("around everything", ball_on_grid({0, 0, 0}, 90, 6.0 * kOblique), 0);
    add("tiny", ball_on_grid({0, -9, 0}, 0.02, 0.004 * kOblique), 0);
    add("the same", std::make_shared<const Volume>(two_balls().volume), 0);
    add("mirrored", ball_on_grid({0, 0, 0}, 8, glm::dmat3(-1)), 0);
    struct Way {
        double extinction;  // of both
        bool replaces, eye_inside;
    };
    for (const auto& [name, volume] : beside)
        for (const Way& way :
             {Way{9, false, false}, {9, false, true}, {0.1, false, true}, {0.1, true, false}, {9, true, true}}) {
            SCOPED_TRACE(testing::Message() << name << ", " << way.extinction << (way.replaces ? ", replaces" : ""));
            PassScene s = two_balls();
            s.scene.added = {volume};
            s.scene.added[0].replaces = way.replaces;
            s.scene.materials[1].extinction = s.scene.added[0].materials[1].extinction = way.extinction;
            if (!way.replaces) {
                s.scene.lights[0].shadows = true;
                s.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 5};
            }
            if (way.eye_inside) s.camera.eye = {0.3, 0.2, 0.1};
            for (const std::uint32_t payload : {shader::PAYLOAD_COLOR, shader::PAYLOAD_DEPTH_DISTANCE})
                for (const glm::vec4& pixel : drawn_beside(s, payload)) {
                    ASSERT_TRUE(std::isfinite(glm::dot(pixel, pixel)));
                    ASSERT_TRUE(pixel.a >= 0 && pixel.a <= 1.00001F) << pixel.a;
                }
        }
}

/// Renderers refuse what they cannot draw together, and say why.
TEST(SeveralVolumes, RefuseWhatTheyCannotShow) {
    Renderer renderer({.validation = true});
    const auto refusal = [&](const auto& change, const AovRequest& outputs = {}) {
        PassScene s = two_balls();
        change(s);
        renderer.set_volume(std::make_shared<const Volume>(s.volume));
        try {
            renderer.render(s.scene, s.camera, s.settings, 16, 16, outputs);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    using testing::HasSubstr;
    EXPECT_EQ(refusal([](PassScene&) {}), "");
    const auto many_clouds = [](std::size_t beside) {
        return [beside](PassScene& s) {
            s.scene.added.resize(beside, s.scene.added[0]);  // one volume many times
            for (AddedVolume& volume : s.scene.added)
                volume.materials[1].extinction = 0.01;
        };
    };
    EXPECT_EQ(refusal(many_clouds(shader::MAX_TOGETHER)), "");
    EXPECT_THAT(refusal(many_clouds(shader::MAX_TOGETHER + 1)),
                HasSubstr("9 volumes have translucent matter, expected at most 8"));
    EXPECT_THAT(refusal([](PassScene& s) {
                    s.scene.materials[1].extinction = 0.1;
                    s.settings.sheet_format = SheetFormat::Layers;
                }),
                HasSubstr("expected sheet_format = tiles"));
    EXPECT_THAT(refusal([](PassScene& s) { s.settings.opaque = OpaqueMatter::Kernels; }),
                HasSubstr("opaque = surfaces"));
    EXPECT_THAT(refusal([](PassScene&) {}, {.tau = true}), HasSubstr("tau"));
    EXPECT_THAT(refusal([](PassScene& s) {
                    s.scene.added[0].iso_values = {3, 1};
                }),
                HasSubstr("volumes[0]: scene iso_values"));
    EXPECT_THAT(refusal([](PassScene& s) {
                    s.scene.added[0].replaces = true;
                    s.scene.effects.clip.remove = {{{0, 0, 0}, {1, 0, 0}}};
                }),
                HasSubstr("another region is removed"));
    EXPECT_THAT(refusal([](PassScene& s) {
                    s.scene.added[0].replaces = true;
                    s.scene.effects.occlusion.emplace();
                }),
                HasSubstr("rule = inside"));
    EXPECT_THAT(refusal([](PassScene& s) { s.scene.added[0].volume = nullptr; }), HasSubstr("volumes[0]"));
    EXPECT_THAT(refusal([](PassScene& s) { s.scene.added.resize(16, s.scene.added[0]); }), HasSubstr("at most 16"));
    EXPECT_EQ(refusal([](PassScene& s) { s.scene.added.resize(15, s.scene.added[0]); }), "");
}

/// The renderer keeps each volume's splats, whatever else changes.
TEST(SeveralVolumes, AreCollectedOnce) {
    const PassScene s = two_balls();
    Renderer renderer({.validation = true});
    renderer.set_volume(std::make_shared<const Volume>(s.volume));
    const auto voxels = [&](const Scene& scene) {
        return renderer.render(scene, s.camera, s.settings, 32, 32).stats.voxels_estimated;
    };
    Scene scene = s.scene;
    EXPECT_GT(voxels(scene), 0U);
    EXPECT_EQ(voxels(scene), 0U);
    scene.added[0].materials[1].color = {1, 0, 0};
    scene.effects.clip.keep = {{{2, -4, 0}, {0.2, -1, 0.3}}};
    EXPECT_EQ(voxels(scene), 0U);
    const AddedVolume third = added_volume(ball_on_grid({-6, -4, -3}, 5, kOblique), {0}, {solid_matter({0.5, 1, 0.5})});
    scene.added.insert(scene.added.begin(), third);
    const std::uint64_t of_third = voxels(scene);
    EXPECT_GT(of_third, 0U);
    EXPECT_EQ(of_third, third.volume->geometry.voxel_count());
    scene.added.erase(scene.added.begin());
    EXPECT_EQ(voxels(scene), 0U);
}

}  // namespace
}  // namespace edgesplat::test
