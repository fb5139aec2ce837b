#include "apps/edgesplat/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/edgesplat/renderer_option.h"
#include "engine/error.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "engine/volume/packed_volume.h"

using edgesplat::fail;
using edgesplat::SceneDocument;

namespace {

constexpr int kMaxFrames = 1'000'000;
constexpr std::string_view kVolumeKeys = "volume.";

/// Sets a number to its value at `time`.
void animate(SceneDocument& document, const edgesplat::AnimatedParameter& parameter, double time) {
    const double value = value_at(parameter, time);
    if (!document.movie.interpolate_frames || !parameter.key.ends_with("volume.frame"))
        return animate_number(document, parameter.key, value);
    animate_number(document, parameter.key, std::floor(value));
    animate_number(document, parameter.key + "_share", value - std::floor(value));
}

SceneDocument document_at(const Film& film, double time) {
    SceneDocument document = film.document;
    for (const edgesplat::AnimatedParameter& parameter : film.animation)
        animate(document, parameter, time);
    for (SceneDocument& entry : document.volumes)
        entry.volume.checksum.clear();  // that of the first frame
    return document;
}

/// Surfaces that statistics of the first frame choose are those of all frames.
void keep_surfaces(Film& film) {
    if (!film.whole->is_label_mask()) set_open_iso_values(film.document, *film.whole);
    for (SceneDocument& entry : film.document.volumes)
        if (!entry.read->volume->is_label_mask()) set_open_iso_values(entry, *entry.read->volume);
}

/// Reads the volumes that `document` shows, if the renderer holds others.
void show_volume(Film& film, edgesplat::Renderer& renderer, SceneDocument& document) {
    read_volumes(document, film.folders);
    if (document.volume != film.source) {
        film.source = document.volume;
        document.volume.checksum.clear();  // that of the first frame
        film.whole = std::make_shared<const edgesplat::Volume>(
            prepared_volume(document, read_source(document.volume, film.folders)));
    }
    const auto before = std::exchange(film.volume, film.cuts.apply(document, film.whole));
    if (film.volume != before) renderer.set_volume(film.volume);
}

}  // namespace

void check_film(const SceneDocument& document) {
    if (!document.output.aovs.empty() || document.output.compare_plain || document.output.compare_raycast ||
        on_processor(document.output.renderer))
        fail("a movie has no extra outputs and no comparisons; it needs --renderer splat or raycast");
}

void start_volume(SceneDocument& document) {
    const auto& path = document.movie.path;
    for (const edgesplat::AnimatedParameter& parameter : resolve_animation(document))
        if (parameter.key.starts_with(kVolumeKeys))
            animate(document, parameter, path.empty() ? 0.0 : path.front().time);
}

Film film_of(SceneDocument document, const std::vector<std::filesystem::path>& folders,
             std::shared_ptr<const edgesplat::Volume> volume, std::optional<double> seconds) {
    Film film;
    film.document = std::move(document);
    film.source = film.document.volume;
    film.folders = folders;
    film.whole = film.document.whole.volume ? film.document.whole.volume : std::move(volume);
    film.volume = film.cuts.apply(film.document, film.whole);
    if (!film.document.movie.animate.empty()) keep_surfaces(film);
    const edgesplat::RendererKind renderer = film.document.output.renderer;
    if (renderer != edgesplat::RendererKind::Splat)
        require_samples(*film.volume, fmt::format("--renderer {}", name_of(renderer)));
    if (film.document.quality.max_error) require_samples(*film.volume, "--max-error");
    const edgesplat::Scene scene = resolve_scene(film.document, *film.volume);
    const edgesplat::Camera start = resolve_camera(film.document, *film.volume, scene);
    film.path = resolve_camera_path(film.document, *film.volume, start);
    film.animation = resolve_animation(film.document);
    film.settings = film.document.quality.settings;
    film.fps = film.document.movie.fps;
    double until = duration(film.path);
    for (const edgesplat::AnimatedParameter& parameter : film.animation)
        until = std::max(until, parameter.values.back().time - film.path.keys.front().time);
    until = seconds.value_or(until);
    if (!(until > 0)) fail("the movie has no duration: give --orbit DEGREES, --seconds, or a scene file with [movie]");
    const double count = std::max(1.0, std::round(until * film.fps));
    if (!(count <= kMaxFrames)) fail("the movie has {} frames; at most {} are possible", count, kMaxFrames);
    film.count = static_cast<int>(count);
    return film;
}

edgesplat::Scene scene_at(const Film& film, double time) {
    return resolve_scene(document_at(film, time), *film.volume);
}

edgesplat::RenderResult draw_frame(Film& film, edgesplat::Renderer& renderer, int frame) {
    const double time = film.time_of(frame);
    SceneDocument document = document_at(film, time);
    show_volume(film, renderer, document);
    const edgesplat::Scene scene = resolve_scene(document, *film.volume);
    const edgesplat::Camera camera = camera_at(film.path, time);
    const edgesplat::OutputChoice& output = film.document.output;
    if (output.renderer == edgesplat::RendererKind::Raycast)
        return renderer.raycast(scene, camera, film.settings, raycast_settings(output), output.size.x, output.size.y);
    return renderer.render(scene, camera, film.settings, output.size.x, output.size.y);
}
