#include "apps/paper/picture_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paper/cube_measuring.h"
#include "apps/paper/sharpness.h"
#include "engine/image/image_file.h"
#include "engine/scene/views.h"
#include "engine/volume/filters.h"
#include "engine/volume/load_volume.h"
#include "tests/properties/edge_quality.h"

namespace edgesplat {
namespace {

constexpr int kFigurePixels = 320;
constexpr int kRounds = 6;  // the first is not timed

struct Variant {
    std::string name, stem;
    Settings settings;
};

std::vector<Variant> variants() {
    Settings plain;
    plain.edges = EdgeEstimator::Off;
    plain.footprints = FootprintMode::Isotropic;
    return {{"plain splatting", "plain", plain}, {"the paper's own", "paper", paper_settings()}, {"ours", "ours", {}}};
}

struct Shot {
    Image color;
    std::vector<double> frame, setup;  // milliseconds
    RenderStats stats;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void write_picture(const std::filesystem::path& path, const Image& color, const std::string& volume) {
    Image opaque(color.width, color.height, 3);
    for (int y = 0; y < color.height; ++y)
        for (int x = 0; x < color.width; ++x)
            for (int c = 0; c < 3; ++c)
                opaque.at(x, y, c) = color.at(x, y, c);
    write_image(path, opaque, {{"Software", "edgesplat " EDGESPLAT_VERSION}, {"edgesplat:volume", volume}});
}

/// Opacity of the scene's highest material alone, as a grey picture: its edges are the outline, independent of shading.
Image outline_of(Renderer& renderer, Scene scene, const Camera& camera, const Settings& settings) {
    for (std::size_t m = 0; m + 1 < scene.materials.size(); ++m)
        scene.materials[m].extinction = 0;
    Image image = renderer.render(scene, camera, settings, kFigurePixels, kFigurePixels).color;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y, c) = image.at(x, y, 3);
    return image;
}

struct CubeText {
    std::string rows, note;
};

CubeText cube_text(Renderer& renderer, const Volume& volume) {
    std::string faces = "| sides: rise; location, mean (bias) |", hole = "| hole: rise; location, mean (bias) |";
    const auto cell = [](const test::EdgeProfiles& p) {
        std::string text = fmt::format(" {:.2f}; {:.3f} ({:+.3f})", test::mean(p.rise),
                                       test::mean_magnitude(p.location), test::mean(p.location));
        const std::size_t all = p.rise.size() + static_cast<std::size_t>(p.missed);
        if (p.missed > 0) text += fmt::format("; {} of {} never reach 90 %", p.missed, all);
        return text + " |";
    };
    double radius = 0;
    for (const Variant& variant : variants()) {
        const CubeQuality quality = cube_quality(renderer, volume, variant.settings);
        faces += cell(quality.faces);
        hole += cell(quality.hole);
        radius = quality.hole_radius;
    }
    return {
        faces + "\n" + hole + "\n",
        fmt::format("\nRise (10 to 90 %) and location error in voxels, measured in optical depth along the hole at 40 "
                    "pixels per voxel (the middle slices). Positive bias: the solid is too large. The hole is "
                    "compared with a circle of radius {:.2f}; binary voxels and the filter turn a hole of radius "
                    "3.5 into one of that size.\n",
                    radius)};
}

}  // namespace

Section picture_section(const PictureFigure& figure, Renderer& renderer, const std::filesystem::path& data,
                        const std::filesystem::path& images) {
    Volume loaded = load_volume(figure.is_builtin() ? figure.volume_path : (data / figure.volume_path).string());
    if (figure.box_filter) loaded = box_filter(loaded);
    const auto volume = std::make_shared<const Volume>(std::move(loaded));
    renderer.set_volume(volume);
    const glm::dmat3 axes = volume_axes(volume->geometry);
    const Camera camera{volume->geometry.to_world(figure.eye), axes * figure.direction, axes * figure.up, figure.fov_y};

    const std::vector<Variant> list = variants();
    std::vector<Shot> shots(list.size());
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            RenderResult result = renderer.render(figure.scene, camera, list[i].settings, kFigurePixels, kFigurePixels);
            if (round > 0) {
                shots[i].frame.push_back(result.stats.frame_milliseconds);
                shots[i].setup.push_back(result.stats.setup_milliseconds);
            }
            shots[i].color = std::move(result.color);
            shots[i].stats = std::move(result.stats);
        }
    }

    std::string names = "| |", rule = "|---|", pictures = "| |", energy = "| gradient energy / plain |",
                width = fmt::format("| width of {}, pixels |", figure.outline ? "the outline" : "edges"),
                frame = "| ms per frame |", setup = "| ms once per volume |", splats = "| splats drawn; with an edge |";
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Shot& shot = shots[i];
        const std::string file = fmt::format("figure{}_{}.png", figure.number, list[i].stem);
        write_picture(images / file, shot.color, figure.volume_name);
        names += fmt::format(" {} |", list[i].name);
        rule += ":--:|";
        pictures += fmt::format(" ![{}, {}](images/paper/{}) |", figure.title, list[i].name, file);
        const Sharpness own = sharpness(shot.color), plain = sharpness(shots[0].color);
        energy += fmt::format(" {:.2f} |", own.gradient_energy / plain.gradient_energy);
        const double pixels = figure.outline
                                  ? sharpness(outline_of(renderer, figure.scene, camera, list[i].settings)).edge_width
                                  : own.edge_width;
        width += fmt::format(" {:.2f} |", pixels);
        frame += fmt::format(" {:.0f} |", median(shot.frame));
        setup += fmt::format(" {:.0f} |", median(shot.setup));
        splats += fmt::format(" {}; {} |", shot.stats.splats_drawn, shot.stats.edge_splats);
    }
    std::string table = names + "\n" + rule + "\n" + pictures + "\n";
    CubeText cube;
    if (figure.box_filter) cube = cube_text(renderer, *volume);
    table += cube.rows + width + "\n" + energy + "\n" + frame + "\n" + setup + "\n" + splats + "\n" + cube.note;
    return {"figure " + figure.number,
            fmt::format("## Figure {}: {}\n\n{}\n\n{}\nDevice: {}, {} x {} pixels, median of {} frames, the "
                        "variants in turns.\n",
                        figure.number, figure.title, figure.text, table, shots[0].stats.device.name, kFigurePixels,
                        kFigurePixels, kRounds - 1)};
}

Section seam_section() {
    std::string rows;
    for (const Variant& v : variants()) {
        if (v.stem == "plain") continue;
        const test::Unity exact = test::plane_unity(v.settings, false), picture = test::picture_unity(v.settings);
        const auto percent = [](double x) { return 100 * x; };
        rows += fmt::format("| {} | {:.1f} | {:.2f} | {:.2f} | {:.2f} |\n", v.name, percent(exact.mean_of_max),
                            percent(exact.rms), percent(picture.mean_of_max), percent(picture.rms));
    }
    return {"seams",
            "## Seams: what the figures do not show\n\nIf both sides of an edge have the same extinction, nothing "
            "should be visible. In three dimensions all neighbours share\nthe paper's warp of an interval only if the "
            "edge lies along the grid. A face cuts the kernels of both materials at\nthe same plane, at any "
            "orientation. Deviation of the sum of weights from 1 in percent, planes at 24 random orientations: at\n"
            "points, with the edge known exactly; and in pictures seen edge-on, with the edge estimated from data.\n\n"
            "| | points, mean of largest | rms | pictures, mean of largest | rms |\n|---|--:|--:|--:|--:|\n" +
                rows};
}

}  // namespace edgesplat
