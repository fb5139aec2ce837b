// Chooses omitted values of a scene from the volume.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/error.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"
#include "engine/scene/views.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/chord.h"
#include "engine/volume/filters.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/value_text.h"

namespace edgesplat {
namespace {

constexpr double kOpaquePerVoxel = 8;          ///< default extinction of the highest material
constexpr double kTranslucentPerVoxel = 0.15;  ///< default extinction of the materials below it
constexpr double kLabelSurface = 0.5;          ///< iso-value between background and labels

/// Default colours, lowest iso-value first; linear light.
constexpr std::array<glm::dvec3, 6> kPalette{{{1.0, 0.85, 0.75},
                                              {0.45, 0.70, 1.0},
                                              {1.0, 0.72, 0.25},
                                              {0.50, 0.90, 0.50},
                                              {0.90, 0.50, 0.85},
                                              {0.95, 0.40, 0.30}}};

std::vector<double> chosen_iso_values(const SceneDocument& document, const Volume& volume) {
    if (document.volume.threshold) return {0.5};
    if (is_builtin(volume.name)) {
        const std::string name = volume.name.substr(volume.name.find(':') + 1);
        return analytic_scene(name.substr(0, name.find(':'))).iso_values;
    }
    const auto suggestions = suggest_iso_values(volume, 1);
    if (suggestions.empty())
        fail("{}: every voxel has the value {}, so there is no surface to show", volume.name,
             value_text(volume, volume.min_value));
    // cppcheck-suppress containerOutOfBounds; fail() does not return
    return {suggestions.front().value};
}

/// Iso-values at `sigmas` standard deviations above the mean of the samples with data.
std::vector<double> iso_values_of_sigmas(const std::vector<double>& sigmas, const Volume& volume) {
    if (volume.packed)
        return iso_values_of_sigmas(sigmas,
                                    load_level(volume, finest_level_within(*volume.packed, kMaxVoxelsAnalysed)));
    const double mean = mean_of(volume);
    double squares = 0;
    for (std::size_t i = 0; i < volume.values.size(); ++i)
        if (volume.has_data(i)) squares += std::pow(static_cast<double>(volume.values[i]) - mean, 2);
    const auto count = volume.values.size() - volume.non_finite_count;
    const double deviation = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
    std::vector<double> values;
    for (const double sigma : sigmas)
        values.push_back(mean + sigma * deviation);
    return values;
}

/// The colour that a material chooses, also by its preset.
std::optional<glm::dvec3> color_of(const MaterialChoice& choice) {
    if (choice.color || choice.preset.empty()) return choice.color;
    return scene_preset(choice.preset).content.materials.front().color;
}

/// The default view. Front for a patient, unless that shows a slab from its narrow side.
std::string_view default_view(const ViewRequest& request) {
    const Volume& volume = *request.volume;
    if (is_builtin(volume.name)) return "front";
    if (!volume.in_patient) return most_informative_view(request);
    const VolumeGeometry& geometry = volume.geometry;
    glm::dvec3 size(0);
    for (int axis = 0; axis < 3; ++axis)
        size += glm::abs(geometry.index_to_world_axes[axis]) * static_cast<double>(geometry.dims[axis]);
    constexpr double kSlab = 0.25;
    return size.z < kSlab * std::min(size.x, size.y) ? "top" : "front";
}

/// The iso-values of all materials' presets; empty if one has none.
std::vector<double> preset_iso_values(const std::vector<MaterialChoice>& materials) {
    std::vector<double> values;
    for (const MaterialChoice& material : materials) {
        if (material.preset.empty()) return {};
        const ScenePreset preset = scene_preset(material.preset);
        if (preset.content.iso_values.empty()) return {};
        values.push_back(preset.content.iso_values.front());
    }
    return values;
}

void check_iso_values(const std::vector<double>& iso, const Volume& volume) {
    const double low = volume.min_value, high = volume.max_value;
    for (std::size_t i = 0; i < iso.size(); ++i)
        if (!(iso[i] > low && iso[i] <= high))
            fail("iso_values[{}] (--iso {}): no surface has this value; the values of {} lie between {} and {}", i,
                 volume.in_file_unit(iso[i]), volume.name, value_text(volume, volume.min_value),
                 value_text(volume, volume.max_value));
}

/// `usual`, overridden by the choice's preset and then by the choice itself.
Material material_of(const MaterialChoice& choice, const Material& usual) {
    Material material = usual;
    const auto apply = [&material](const MaterialChoice& said) {
        material.color = said.color.value_or(material.color);
        material.extinction = said.extinction.value_or(material.extinction);
        material.response.ambient = said.ambient.value_or(material.response.ambient);
        material.response.diffuse = said.diffuse.value_or(material.response.diffuse);
        material.response.specular = said.specular.value_or(material.response.specular);
        material.response.shininess = said.shininess.value_or(material.response.shininess);
        if (!said.name.empty()) material.name = said.name;
    };
    if (!choice.preset.empty()) {
        const ScenePreset preset = scene_preset(choice.preset);
        if (preset.kind != PresetKind::Material) fail("preset '{}' is not a material", preset.name);
        apply(preset.content.materials.front());
    }
    apply(choice);
    return material;
}

/// Adds planes whose beyond sides are the outside of the box.
void add_planes(const ClipBox& box, std::vector<Plane>& planes) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0);
        normal[axis] = 1;
        planes.push_back({box.low, -normal});
        planes.push_back({box.high, normal});
    }
}

}  // namespace

glm::dvec3 default_color(std::size_t place) {
    return kPalette[place % kPalette.size()];
}

glm::dvec3 default_label_color(std::size_t label) {
    // Hues a golden ratio of the circle apart, so that successive numbers are distinguishable; every second one is
    // paler.
    constexpr double kGolden = 0.6180339887498949;
    const double turn = std::fmod(0.08 + kGolden * static_cast<double>(label - 1), 1.0);
    const double pale = label % 2 == 0 ? 0.45 : 0.12, bright = label % 3 == 0 ? 0.6 : 0.85;
    glm::dvec3 color;
    for (int channel = 0; channel < 3; ++channel) {
        const double around = std::abs(std::fmod(turn + (3 - channel) / 3.0, 1.0) * 6 - 3);
        const double pure = std::clamp(around - 1, 0.0, 1.0);
        color[channel] = bright * (pale + (1 - pale) * pure);
    }
    return color;
}

std::vector<glm::dvec3> label_colors(const LabelTable& table) {
    // Small numbers have the same colours in every volume.
    constexpr std::uint64_t kSmall = 256;
    const bool numbered = std::ranges::all_of(table.labels, [](const Label& label) { return label.id <= kSmall; });
    std::vector<glm::dvec3> colors;
    for (std::size_t place = 0; place < table.labels.size(); ++place) {
        const Label& label = table.labels[place];
        const std::size_t number = numbered ? std::max<std::uint64_t>(label.id, 1) : place + 1;
        colors.push_back(label.color.value_or(default_label_color(number)));
    }
    return colors;
}

double default_extinction(bool highest, const VolumeGeometry& geometry) {
    return (highest ? kOpaquePerVoxel : kTranslucentPerVoxel) / geometry.mean_spacing();
}

MaterialChoice choice_of(const Material& material) {
    const LightResponse& r = material.response;
    return {{}, material.name, material.color, material.extinction, r.ambient, r.diffuse, r.specular, r.shininess};
}

void write_out_materials(SceneDocument& document, const Scene& scene, const Volume& volume) {
    document.below = choice_of(scene.materials.front());
    if (volume.is_label_mask() && !scene.label_colors.empty()) {
        // Labels keep their own colours and surface.
        MaterialChoice all = choice_of(scene.materials.back());
        all.color = document.materials.empty() ? std::nullopt : color_of(document.materials.front());
        document.materials = {all};
    } else {
        document.iso_values = scene.iso_values;
        for (double& value : document.iso_values)
            value = volume.in_file_unit(value);
        document.materials.clear();
        for (std::size_t m = 1; m < scene.materials.size(); ++m)
            document.materials.push_back(choice_of(scene.materials[m]));
    }
    // The volume's opacity decides the extinctions.
    for (MaterialChoice& material : document.materials)
        if (document.volume.opacity) material.extinction.reset();
}

namespace {

/// Gives all matter the extinction of volume.opacity.
void set_opacity(Scene& scene, const SceneDocument& document, const Volume& volume) {
    if (!scene.transfer.empty())
        fail("volume.opacity: the transfer function has extinctions of its own; expected one of them");
    for (std::size_t m = 0; m < document.materials.size(); ++m)
        if (document.materials[m].extinction)
            fail("volume.opacity: materials[{}] has an extinction of its own; expected one of them", m);
    if (volume.packed) fail("volume.opacity: {} is packed; expected materials[].extinction", volume.name);
    const double chord = mean_chord(volume, scene.iso_values.front()), opacity = *document.volume.opacity;
    const double extinction =
        opacity < 1 && chord > 0 ? -std::log1p(-opacity) / chord : default_extinction(true, volume.geometry);
    for (std::size_t m = 1; m < scene.materials.size(); ++m)
        scene.materials[m].extinction = extinction;
}

/// The scene of a document's first volume. `number`: of the volume; each has other default colours.
Scene resolved_alone(const SceneDocument& document, const Volume& volume, std::size_t number) {
    Scene scene;
    scene.transfer = document.transfer;
    std::vector<double> iso = document.iso_values;
    if (!document.transfer_preset.empty()) {
        const ScenePreset preset = scene_preset(document.transfer_preset);
        scene.transfer = preset.content.transfer;
        if (iso.empty()) iso = preset.content.iso_values;
    }
    if (iso.empty() && document.iso_sigmas.empty()) iso = preset_iso_values(document.materials);
    // The document's values are in the file's unit, the scene's in that of the samples.
    for (double& value : iso)
        value /= volume.value_scale;
    for (TransferPoint& point : scene.transfer)
        point.value /= volume.value_scale;
    if (iso.empty() && !document.iso_sigmas.empty()) iso = iso_values_of_sigmas(document.iso_sigmas, volume);
    if (volume.shown_labels) scene.label_colors = label_colors(*volume.labels);
    if (volume.is_label_mask()) {
        if (!iso.empty() || !scene.transfer.empty())
            fail(
                "{}: is drawn by its labels, which have their own surfaces and colours; set volume.labels to false "
                "(--labels off) for {} of its numbers",
                volume.name, iso.empty() ? "a transfer function" : "surfaces");
        iso = {kLabelSurface};
        const auto chosen = document.materials.empty() ? std::nullopt : color_of(document.materials.front());
        if (chosen) std::ranges::fill(scene.label_colors, *chosen);
    }
    if (iso.empty() && scene.transfer.empty()) iso = chosen_iso_values(document, volume);
    if (!volume.is_label_mask()) check_iso_values(iso, volume);
    if (!document.materials.empty() && document.materials.size() != iso.size())
        fail("materials (--color, --extinction, --material): given {} times; expected once per iso-value, {} times",
             document.materials.size(), iso.size());

    std::vector<std::size_t> order(iso.size());  // indices of the document's iso-values, by ascending value
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return iso[a] < iso[b]; });
    scene.materials.push_back(material_of(document.below, {.color = glm::dvec3(0)}));
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const bool highest = rank + 1 == order.size();
        const Material usual{.color = default_color(number + rank),
                             .extinction = default_extinction(highest, volume.geometry)};
        scene.iso_values.push_back(iso[order[rank]]);
        scene.materials.push_back(document.materials.empty() ? usual
                                                             : material_of(document.materials[order[rank]], usual));
    }
    if (document.volume.opacity) set_opacity(scene, document, volume);
    scene.ambient = document.ambient;
    scene.lights = document.lights;
    scene.lit = document.lit;
    scene.background = document.background;
    scene.effects = document.effects;
    Clip& clip = scene.effects.clip;
    if (document.keep_box) add_planes(*document.keep_box, clip.keep);
    if (document.remove_box) add_planes(*document.remove_box, clip.remove);
    scene.clipped = document.volume.clip;
    if (!document.volume.visible) {
        for (Material& material : scene.materials)
            material.extinction = 0;
        for (TransferPoint& point : scene.transfer)
            point.extinction = 0;
    }
    return scene;
}

}  // namespace

bool cuts(const SceneDocument& entry) {
    return entry.volume.rule == VolumeRule::Cut;
}

Scene resolve_scene(const SceneDocument& document, const Volume& volume) {
    Scene scene = resolved_alone(document, document.whole.volume ? *document.whole.volume : volume, 0);
    for (std::size_t i = 0; i < document.volumes.size(); ++i) {
        const SceneDocument& entry = document.volumes[i];
        if (!entry.read) fail("volumes[{}]: {} is not read", i, entry.volume.path);
        if (cuts(entry)) {
            if (entry.volume.visible && !document.whole.volume)
                fail("volumes[{}]: {} has not cut the others", i, entry.volume.path);
            continue;
        }
        try {
            Scene one = resolved_alone(entry, *entry.read->volume, i + 1);
            scene.added.push_back({entry.cut.volume ? entry.cut.volume : entry.read->volume, std::move(one.iso_values),
                                   std::move(one.materials), std::move(one.transfer), std::move(one.label_colors),
                                   one.clipped, entry.volume.rule == VolumeRule::Inside && entry.volume.visible,
                                   entry.volume.rim});
        } catch (const Error& error) {
            fail("volumes[{}]: {}", i, error.what());
        }
    }
    if (scene.added.empty()) scene = scene_of_volume(scene, 0);
    validate(scene);
    return scene;
}

Camera resolve_camera(const SceneDocument& document, const Volume& volume, const Scene& scene) {
    const CameraChoice& choice = document.camera;
    const VolumeGeometry& geometry = volume.geometry;
    const ViewRequest request{&volume, &scene, choice.fov, document.output.size.x, document.output.size.y, true};
    const auto point = [&](const glm::dvec3& p) { return choice.voxel ? geometry.to_world(p) : p; };
    const auto along = [&](const glm::dvec3& v) { return choice.voxel ? volume_axes(geometry) * v : v; };
    for (const auto& [name, vector] : {std::pair{"direction", choice.direction}, {"up", choice.up}})
        if (vector && !(glm::length(*vector) > 0)) fail("camera.{} (--{}) must not be 0,0,0", name, name);

    const glm::dvec3 up = along(choice.up.value_or(glm::dvec3(0, 0, 1)));
    if (choice.eye) {
        const glm::dvec3 eye = point(*choice.eye);
        const glm::dvec3 center = geometry.center();
        const glm::dvec3 direction =
            choice.direction ? along(*choice.direction) : (choice.target ? point(*choice.target) : center) - eye;
        if (!(glm::length(direction) > 0))
            fail("camera.eye (--eye) equals {}; give another target, or a direction",
                 choice.target ? "its target" : "the volume's centre");
        return {eye, direction, up, choice.fov};
    }
    if (choice.direction) return framing_camera(along(*choice.direction), up, request);
    Camera camera = named_view(choice.view.empty() ? default_view(request) : choice.view, request);
    if (choice.up) camera.up = up;
    return camera;
}

CameraPath resolve_camera_path(const SceneDocument& document, const Volume& volume, const Camera& start) {
    const MovieChoice& movie = document.movie;
    const VolumeGeometry& geometry = volume.geometry;
    const auto point = [&](const glm::dvec3& p) { return movie.voxel ? geometry.to_world(p) : p; };
    const auto along = [&](const glm::dvec3& v) { return movie.voxel ? volume_axes(geometry) * v : v; };
    const glm::dvec3 center = geometry.center();
    if (const auto& orbit = movie.orbit)
        return orbit_path({start, center, along(orbit->axis), orbit->degrees, orbit->seconds});
    if (const auto& flight = movie.flight) {
        FlyThrough through{{}, flight->seconds, flight->look_ahead, along(flight->up), flight->fov};
        for (std::size_t i = 0; i + 2 < flight->points.size(); i += 3)
            through.points.push_back(point({flight->points[i], flight->points[i + 1], flight->points[i + 2]}));
        return fly_through(through);
    }
    CameraPath path{movie.path, movie.loop};
    for (CameraKey& key : path.keys)
        key = {key.time, point(key.eye), point(key.target), along(key.up), key.fov};
    if (path.keys.empty()) path.keys.push_back({0, start.eye, start.eye + start.direction, start.up, start.fov_y});
    validate(path);
    return path;
}

std::vector<AnimatedParameter> resolve_animation(const SceneDocument& document) {
    std::vector<AnimatedParameter> parameters;
    for (const AnimationChoice& choice : document.movie.animate) {
        if (choice.times.size() != choice.values.size())
            fail("movie.animate of {}: {} times and {} values; expected as many of each", choice.key,
                 choice.times.size(), choice.values.size());
        AnimatedParameter parameter{choice.key, {}};
        for (std::size_t i = 0; i < choice.times.size(); ++i)
            parameter.values.push_back({choice.times[i], choice.values[i]});
        validate(parameter);
        parameters.push_back(std::move(parameter));
    }
    return parameters;
}

namespace {

void write_out_matter(SceneDocument& document, const Scene& scene, const Volume& volume) {
    const Volume& whole = document.whole.volume ? *document.whole.volume : volume;
    document.volume.checksum = fmt::format("{:016x}", whole.checksum);
    write_out_materials(document, scene, volume);
    document.iso_sigmas.clear();
    document.transfer = scene.transfer;
    for (TransferPoint& point : document.transfer)
        point.value = volume.in_file_unit(point.value);
    document.transfer_preset.clear();
}

}  // namespace

SceneDocument resolved(const SceneDocument& document, const Volume& volume, const Scene& scene, const Camera& camera,
                       const Settings& settings) {
    SceneDocument result = document;
    const auto all = [&](bool VolumeSource::*flag) {
        return document.volume.*flag &&
               std::ranges::all_of(document.volumes, [&](const SceneDocument& d) { return d.volume.*flag; });
    };
    if (!all(&VolumeSource::visible) || !all(&VolumeSource::clip) || std::ranges::any_of(document.volumes, cuts)) {
        // What is not shown keeps its matter, and planes that do not clip stay.
        SceneDocument shown = document;
        shown.volume.visible = shown.volume.clip = true;
        for (SceneDocument& entry : shown.volumes) {
            entry.volume.visible = entry.volume.clip = true;
            if (cuts(entry)) entry.volume.rule = VolumeRule::Add;
        }
        result = resolved(shown, volume, resolve_scene(shown, volume), camera, settings);
        result.volume.visible = document.volume.visible;
        result.volume.clip = document.volume.clip;
        for (std::size_t i = 0; i < result.volumes.size(); ++i) {
            result.volumes[i].volume.visible = document.volumes[i].volume.visible;
            result.volumes[i].volume.clip = document.volumes[i].volume.clip;
            result.volumes[i].volume.rule = document.volumes[i].volume.rule;
        }
        return result;
    }
    write_out_matter(result, scene, volume);
    for (std::size_t i = 0; i < result.volumes.size(); ++i)
        write_out_matter(result.volumes[i], scene_of_volume(scene, i + 1), *document.volumes[i].read->volume);
    result.ambient = scene.ambient;
    result.lights = scene.lights;
    result.lit = scene.lit;
    result.background = scene.background;
    result.effects = scene.effects;
    result.keep_box.reset();
    result.remove_box.reset();
    result.camera = {{}, camera.eye, {}, camera.direction, camera.up, false, camera.fov_y};
    result.movie = {};
    result.quality = {{}, settings, {}};
    result.output.file.clear();
    return result;
}

}  // namespace edgesplat
