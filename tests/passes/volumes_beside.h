// Volumes beside each other, and their pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "engine/reference/reference_renderer.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {

inline constexpr glm::ivec2 kBesideSize{72, 60};

/// Depth below a ball's surface, mm, on a grid that holds it.
inline std::shared_ptr<const Volume> ball_on_grid(const glm::dvec3& middle, double radius, const glm::dmat3& axes) {
    auto volume = std::make_shared<Volume>();
    volume->name = "ball";
    VolumeGeometry& geometry = volume->geometry;
    geometry.index_to_world_axes = axes;
    const double spacing = std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
    geometry.dims = glm::ivec3(static_cast<int>(2 * radius / spacing) + 9);
    geometry.origin = middle - axes * (glm::dvec3(geometry.dims - 1) * 0.5 + glm::dvec3(0.2, -0.1, 0.3));
    for (int z = 0; z < geometry.dims.z; ++z)
        for (int y = 0; y < geometry.dims.y; ++y)
            for (int x = 0; x < geometry.dims.x; ++x) {
                const glm::dvec3 at = geometry.to_world(glm::dvec3(x, y, z));
                volume->values.push_back(static_cast<float>(radius - glm::length(at - middle)));
            }
    finish_volume(*volume);
    return volume;
}

inline const glm::dmat3 kStraight(1.0);
/// Turned, left-handed, with other spacings.
inline const glm::dmat3 kOblique(glm::dvec3(0.66, 0.41, 0.1), glm::dvec3(0.5, -0.75, 0.15),
                                 glm::dvec3(-0.1, 0.12, 0.93));

constexpr Material solid_matter(const glm::dvec3& color) {
    return {.color = color, .extinction = 9};
}

inline AddedVolume added_volume(std::shared_ptr<const Volume> volume, std::vector<double> iso_values,
                                std::vector<Material> above) {
    AddedVolume out{.volume = std::move(volume),
                    .iso_values = std::move(iso_values),
                    .materials = {{}},
                    .transfer = {},
                    .label_colors = {}};
    out.materials.insert(out.materials.end(), above.begin(), above.end());
    return out;
}

/// An opaque ball, and one on another grid that reaches into it.
inline PassScene two_balls() {
    PassScene s;
    s.name = "two balls";
    s.volume = *ball_on_grid({0, 0, 0}, 8, kStraight);
    s.scene.iso_values = {0};
    s.scene.materials = {{}, solid_matter({1, 0.8, 0.5})};
    s.scene.lights = {directional_light({0.4, -0.5, 0.6})};
    s.scene.added = {added_volume(ball_on_grid({7, -3, 2}, 6, kOblique), {0}, {solid_matter({0.4, 0.6, 1})})};
    s.settings.pixels = PixelChoice::Every;
    s.camera = {.eye = {9, -50, 22}, .direction = {-6, 49, -21}, .up = {0.1, 0.05, 1}, .fov_y = 32};
    return s;
}

inline std::vector<glm::vec4> drawn_beside(const PassScene& s, std::uint32_t payload = shader::PAYLOAD_COLOR) {
    DeviceUnderTest& state = prepared(s);
    state.draw(s.scene, s.camera, s.settings, kBesideSize, payload);
    const auto pixels =
        state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kBesideSize.x * kBesideSize.y));
    return {pixels.begin(), pixels.end()};
}

/// PSNR without the worst pixel of 200: where a ray only touches a surface, rounding decides.
inline double decibels_beside(std::span<const glm::vec4> got, std::span<const float> want, int channels, double scale) {
    std::vector<double> squares(got.size(), 0);
    for (std::size_t i = 0; i < got.size(); ++i)
        for (int c = 0; c < channels; ++c) {
            const auto at = i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c);
            squares[i] += std::pow(static_cast<double>(got[i][c] - want[at]) / scale, 2);
        }
    std::ranges::sort(squares);
    squares.resize(squares.size() - squares.size() / 200);
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    return -10 * std::log10(sum / (channels * static_cast<double>(squares.size())) + 1e-20);
}

/// A scene's volume that is moved without changing its order in the list.
inline Scene exchanged(const PassScene& s, Volume& first) {
    Scene scene = s.scene;
    const AddedVolume was = scene.added[0];
    scene.added[0] = {.volume = std::make_shared<const Volume>(s.volume),
                      .iso_values = s.scene.iso_values,
                      .materials = s.scene.materials,
                      .transfer = s.scene.transfer,
                      .label_colors = s.scene.label_colors};
    scene.iso_values = was.iso_values;
    scene.materials = was.materials;
    scene.transfer = was.transfer;
    first = *was.volume;
    return scene;
}

/// The pictures are those of the reference.
inline void expect_references(const std::vector<PassScene>& scenes) {
    for (const PassScene& s : scenes) {
        SCOPED_TRACE(s.name);
        const auto got = drawn_beside(s);
        const reference::PreparedVolume reference(s.volume, s.scene, s.settings, true);
        const Image want = reference.render(s.camera, kBesideSize.x, kBesideSize.y);
        const double psnr = decibels_beside(got, want.pixels, 4, 1);
        std::printf("%-28s %.1f dB\n", s.name.c_str(), psnr);
        EXPECT_GE(psnr, 55);
    }
}

/// The pictures of two volumes do not change if the scene lists them the other way round.
inline void expect_no_order(const std::vector<PassScene>& scenes) {
    for (const PassScene& s : scenes) {
        const AddedVolume& beside = s.scene.added[0];
        if (s.scene.added.size() != 1 || !beside.clipped || beside.replaces) continue;
        SCOPED_TRACE(s.name);
        PassScene other = s;
        other.scene = exchanged(s, other.volume);
        EXPECT_TRUE(drawn_beside(s) == drawn_beside(other));
    }
}

/// The same of all pixels, between two pictures.
inline double decibels_between(std::span<const glm::vec4> got, std::span<const glm::vec4> want) {
    double squares = 0;
    for (std::size_t i = 0; i < got.size(); ++i)
        squares += static_cast<double>(glm::dot(got[i] - want[i], got[i] - want[i])) / 4;
    return -10 * std::log10(squares / static_cast<double>(got.size()) + 1e-20);
}

}  // namespace edgesplat::test
