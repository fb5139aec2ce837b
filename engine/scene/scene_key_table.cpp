// The rows of the scene-file key table.
#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/aov.h"
#include "engine/scene/ladder.h"
#include "engine/scene/scene_key_rows.h"
#include "engine/scene/views.h"

namespace edgesplat {
namespace {

constexpr KeyRange kShare{0, 1};
constexpr KeyRange kFromZero{.low = 0};
constexpr KeyRange kAboveZero{.low = 0, .above_low = true};
constexpr KeyRange kOpacity{.low = 0, .high = 1, .above_low = true};

// An access function of a member, for const and non-const documents.
#define MEMBER(expression) ([](auto& d, [[maybe_unused]] std::size_t i) -> auto& { return d.expression; })

void add_top(KeyTable& t) {
    t.add("about", MEMBER(about), {.help = "Description of the scene", .absent = "nothing"});
    t.add("iso_values", MEMBER(iso_values),
          {.unit = "the volume's",
           .help = "Iso-values, ascending, at most 15; optional with a transfer function",
           .absent = "those of the materials' presets or of the builtin scene, else the strongest that `edgesplat "
                     "info` suggests"});
    t.add("iso_sigmas", MEMBER(iso_sigmas),
          {.unit = "standard deviations",
           .help = "Iso-values as standard deviations above the mean of all samples, ascending; instead of iso_values "
                   "(electron densities)",
           .absent = "none"});
    t.add("transfer_preset", MEMBER(transfer_preset),
          {.help = "A transfer function by name (`edgesplat scene presets`)", .absent = "none"});
    t.add("ambient", MEMBER(ambient), {.help = "Ambient light", .range = kFromZero});
    t.add("lit", MEMBER(lit),
          {.help = "Lit splats: only those at an edge, or all, with their own gradient as normal",
           .choices = {"edges", "everywhere"}});
    t.add("background", MEMBER(background), {.unit = "linear light", .help = "Background colour", .range = kShare});
}

void add_volume(KeyTable& t) {
    t.add("volume.path", MEMBER(volume.path),
          {.help = "File, folder, pattern of slices (slice_%03d.tif) or builtin:NAME; relative to the scene file, then "
                   "to the folders in EDGESPLAT_VOLUMES",
           .absent = "required"});
    t.add("volume.raw", MEMBER(volume.raw),
          {.help = "Layout of a raw file: DXxDYxDZ:TYPE:little|big[:sx,sy,sz[:skip]]", .absent = "none"});
    t.add("volume.component", MEMBER(volume.component),
          {.help = "Component of vector or colour data", .range = {0, 1e6}, .absent = "required for such data"});
    t.add("volume.frame", MEMBER(volume.frame),
          {.help = "Frame of 4-D data", .range = {0, 1e6}, .absent = "required for such data"});
    t.add("volume.frame_share", MEMBER(volume.frame_share),
          {.help = "Share of the frame after it, mixed in: samples between both", .range = kShare});
    t.add("volume.level", MEMBER(volume.level),
          {.help = "Level of an OME-Zarr image, 0: the finest", .range = {0, 63}, .absent = "the finest that fits"});
    t.add("volume.series", MEMBER(volume.series),
          {.help = "Series of a DICOM folder, or image of a file, with several: number, UID or name",
           .absent = "required for such data"});
    t.add("volume.resample", MEMBER(volume.resample),
          {.help = "Resample unevenly spaced DICOM slices to even spacing by cubic interpolation"});
    t.add("volume.spacing", MEMBER(volume.spacing),
          {.unit = "mm", .help = "Voxel spacing along i, j, k", .range = kAboveZero, .absent = "the file's"});
    t.add("volume.no_data", MEMBER(volume.no_data),
          {.unit = "the volume's",
           .help = "Samples with this value contain no data: they are transparent and count in no statistics",
           .absent = "the file's"});
    t.add("volume.threshold", MEMBER(volume.threshold),
          {.unit = "the volume's", .help = "Step 1, binarise: 1 for samples >= this value, else 0", .absent = "none"});
    t.add("volume.labels", MEMBER(volume.labels),
          {.help = "Step 1 for segmentations: samples are labels, each drawn in its own colour",
           .absent = "detected if the scene sets no iso-values and no transfer function"});
    t.add("volume.only", MEMBER(volume.only),
          {.help = "Labels to show, by number, name, or name with * for any letters",
           .absent = "all but the background"});
    t.add("volume.hide", MEMBER(volume.hide), {.help = "Labels to hide, in the same way", .absent = "none"});
    t.add(
        "volume.segmentation", MEMBER(volume.segmentation),
        {.help = "Segmentation of the same object: its labels colour the volume's matter, and `only` and `hide` choose "
                 "among them; relative to the scene file",
         .absent = "none"});
    t.add("volume.label_names", MEMBER(volume.label_names),
          {.help = "File with names and colours of labels: a Slicer colour table, an ITK-SNAP label description, a "
                   "FreeSurfer lookup table, or a table with the columns id and name; relative to the scene file",
           .absent = "the volume's own"});
    t.add("volume.box_filter", MEMBER(volume.box_filter), {.help = "Step 2: mean over 3x3x3 voxels"});
    t.add("volume.crop_low", MEMBER(volume.crop_low),
          {.unit = "voxels", .help = "Step 3: crop, first voxel to keep", .range = {0, 65535}, .absent = "the first"});
    t.add("volume.crop_high", MEMBER(volume.crop_high),
          {.unit = "voxels", .help = "Last voxel to keep", .range = {0, 65535}, .absent = "the last"});
    t.add(
        "volume.registration", MEMBER(volume.registration),
        {.help = "Result of a registration with this volume as the moving image: its inverse moves the volume. A rigid "
                 "or affine transform of ITK: .tfm, .txt, .h5, or .mat of ANTs; relative to the scene file",
         .absent = "none"});
    t.add("volume.transform", MEMBER(volume.transform),
          {.count = 16,
           .unit = "mm",
           .help = "A 4 x 4 matrix, row by row, that moves the volume in the world",
           .absent = "the file's place"});
    t.add("volume.visible", MEMBER(volume.visible), {.help = "Draw the volume's matter"});
    t.add("volume.clip", MEMBER(volume.clip), {.help = "Clip planes cut the volume"});
    t.add("volume.opacity", MEMBER(volume.opacity),
          {.help = "Share of a ray that the matter takes, in the mean of all rays through it; instead of extinctions",
           .range = kOpacity,
           .absent = "the materials' extinctions"});
    t.add("volume.rule", MEMBER(volume.rule),
          {.help = "What a volume beside the first does where it overlaps others. add: both are drawn. inside: only it "
                   "is drawn within its grid, as a finer scan. cut: it is hidden and removes their matter",
           .choices = {"add", "inside", "cut"}});
    t.add("volume.rim", MEMBER(volume.rim),
          {.unit = "mm",
           .help = "With rule = inside: from its sides inwards, over this length, other translucent matter gives way",
           .range = kFromZero,
           .absent = "six voxels of the coarsest"});
    t.add("volume.checksum", MEMBER(volume.checksum),
          {.help = "Checksum of the preprocessed samples; other samples are refused", .absent = "any"});
}

void add_lights(KeyTable& t) {
    t.add(
        "lights[].kind", MEMBER(lights[i].kind),
        {.help = "Position: at the eye, at infinity, or at a point", .choices = {"headlight", "directional", "point"}});
    t.add("lights[].direction", MEMBER(lights[i].direction),
          {.unit = "world", .help = "Direction towards a directional light", .direction = true});
    t.add("lights[].position", MEMBER(lights[i].position), {.unit = "world mm", .help = "Position of a point light"});
    t.add("lights[].color", MEMBER(lights[i].color), {.unit = "linear light", .help = "Colour", .range = kShare});
    t.add("lights[].intensity", MEMBER(lights[i].intensity), {.help = "Factor on the colour", .range = kFromZero});
    t.add("lights[].shadows", MEMBER(lights[i].shadows),
          {.help = "Whether the light casts shadows; not for a headlight, at most 2 lights"});
}

void add_materials(KeyTable& t) {
    // The same rows for the material below all iso-values and for the materials above each.
    const auto rows = [&t](const std::string& table, auto material, const char* color, const char* extinction) {
        const auto add = [&](const char* name, auto access, const SceneKey& facts) {
            t.add((table + name).c_str(), access, facts);
        };
        if (table != "below.")
            add("preset", [material](auto& d, std::size_t i) -> auto& { return material(d, i).preset; },
                {.help = "A material by name (`edgesplat scene presets`); the other keys override its values",
                 .absent = "none"});
        add("name", [material](auto& d, std::size_t i) -> auto& { return material(d, i).name; },
            {.help = "Name in legends", .absent = "none"});
        add("color", [material](auto& d, std::size_t i) -> auto& { return material(d, i).color; },
            {.unit = "linear light", .help = "Colour", .range = kShare, .absent = color});
        add("extinction", [material](auto& d, std::size_t i) -> auto& { return material(d, i).extinction; },
            {.unit = "per mm",
             .help = "Extinction coefficient; 0: transparent",
             .range = kFromZero,
             .absent = extinction});
        add("ambient", [material](auto& d, std::size_t i) -> auto& { return material(d, i).ambient; },
            {.help = "Factor on ambient light", .range = kFromZero, .absent = "1.0"});
        add("diffuse", [material](auto& d, std::size_t i) -> auto& { return material(d, i).diffuse; },
            {.help = "Factor on diffuse reflection", .range = kFromZero, .absent = "1.0"});
        add("specular", [material](auto& d, std::size_t i) -> auto& { return material(d, i).specular; },
            {.help = "Factor on specular highlights; 0: none", .range = kFromZero, .absent = "0.0"});
        add("shininess", [material](auto& d, std::size_t i) -> auto& { return material(d, i).shininess; },
            {.help = "Exponent of specular highlights", .range = {1, 1000}, .absent = "32.0"});
    };
    rows("materials[].", MEMBER(materials[i]), "one of a palette", "8 per voxel for the highest, 0.15 for the others");
    rows("below.", MEMBER(below), "[0.0, 0.0, 0.0]", "0.0");
    t.add("transfer[].value", MEMBER(transfer[i].value),
          {.unit = "the volume's", .help = "Value of the point; ascending"});
    t.add("transfer[].color", MEMBER(transfer[i].color),
          {.unit = "linear light", .help = "Colour at this value", .range = kShare});
    t.add("transfer[].extinction", MEMBER(transfer[i].extinction),
          {.unit = "per mm", .help = "Extinction at this value", .range = kFromZero});
}

void add_effects(KeyTable& t) {
    t.add("effects.background_top", MEMBER(effects.background_top),
          {.unit = "linear light",
           .help = "Background at the top of a vertical gradient; `background` is its bottom",
           .range = kShare,
           .absent = "one colour"});
    t.add("effects.antialias", MEMBER(effects.antialias), {.help = "Footprints of at least one pixel"});
    t.add("effects.smooth_outlines", MEMBER(effects.smooth_outlines),
          {.help = "Antialias outlines: a pixel on an outline blends both sides"});
    t.add("effects.samples", MEMBER(effects.samples),
          {.help = "n: each pixel is the mean of n x n subpixel samples", .range = {1, kMaxSamples}});
    t.add("effects.fog.color", MEMBER(effects.fog->color),
          {.unit = "linear light", .help = "Colour of the fog", .range = kShare});
    t.add("effects.fog.density", MEMBER(effects.fog->density),
          {.unit = "per mm", .help = "Density of the fog", .range = kFromZero});
    t.add("effects.fog.start", MEMBER(effects.fog->start),
          {.unit = "mm", .help = "Depth where the fog begins", .range = kFromZero});
    t.add("effects.silhouette.color", MEMBER(effects.silhouette->color),
          {.unit = "linear light", .help = "Colour of silhouettes", .range = kShare});
    t.add("effects.silhouette.strength", MEMBER(effects.silhouette->strength),
          {.help = "Weight of the colour", .range = kShare});
    t.add("effects.silhouette.sharpness", MEMBER(effects.silhouette->sharpness),
          {.help = "Exponent; larger values give thinner lines", .range = {0.25, 64}});
    t.add("effects.occlusion.strength", MEMBER(effects.occlusion->strength),
          {.help = "Share of the occlusion that is applied", .range = kShare});
    t.add("effects.occlusion.radius", MEMBER(effects.occlusion->radius),
          {.unit = "mm", .help = "Radius within which matter occludes", .range = kAboveZero});
    t.add("effects.clip.keep[].point", MEMBER(effects.clip.keep[i].point),
          {.unit = "world mm", .help = "A point of the plane"});
    t.add("effects.clip.keep[].normal", MEMBER(effects.clip.keep[i].normal),
          {.unit = "world", .help = "Normal towards the side that is removed", .direction = true});
    t.add("effects.clip.remove[].point", MEMBER(effects.clip.remove[i].point),
          {.unit = "world mm", .help = "A point of the plane"});
    t.add("effects.clip.remove[].normal", MEMBER(effects.clip.remove[i].normal),
          {.unit = "world", .help = "Normal out of the region that is removed", .direction = true});
    t.add("effects.clip.keep_box.low", MEMBER(keep_box->low), {.unit = "world mm", .help = "Lowest corner"});
    t.add("effects.clip.keep_box.high", MEMBER(keep_box->high), {.unit = "world mm", .help = "Highest corner"});
    t.add("effects.clip.remove_box.low", MEMBER(remove_box->low), {.unit = "world mm", .help = "Lowest corner"});
    t.add("effects.clip.remove_box.high", MEMBER(remove_box->high), {.unit = "world mm", .help = "Highest corner"});
    t.add("effects.overlays.orientation", MEMBER(effects.overlays.orientation),
          {.help = "Marker of the volume's axes"});
    t.add("effects.overlays.scale_bar", MEMBER(effects.overlays.scale_bar), {.help = "Scale bar in mm"});
    t.add("effects.overlays.legend", MEMBER(effects.overlays.legend),
          {.help = "Legend of the materials or the transfer function"});
}

void add_camera(KeyTable& t) {
    std::vector<std::string> views(view_names().begin(), view_names().end());
    t.add("camera.view", MEMBER(camera.view),
          {.help = "A named view that frames the visible part of the volume; close: near a surface",
           .choices = views,
           .absent = "without eye and direction: front for patients and builtin volumes, else the axis view that shows "
                     "most of the shape"});
    t.add("camera.eye", MEMBER(camera.eye),
          {.unit = "world mm", .help = "Position of the eye", .absent = "chosen to frame the volume"});
    t.add("camera.target", MEMBER(camera.target),
          {.unit = "world mm", .help = "Point at the centre of the picture", .absent = "the volume's centre"});
    t.add("camera.direction", MEMBER(camera.direction),
          {.unit = "world",
           .help = "View direction; without eye the whole volume is framed",
           .absent = "towards the target",
           .direction = true});
    t.add("camera.up", MEMBER(camera.up),
          {.unit = "world",
           .help = "Up direction of the picture",
           .absent = "[0.0, 0.0, 1.0], or the view's own",
           .direction = true});
    t.add("camera.voxel", MEMBER(camera.voxel),
          {.help = "Eye and target are voxel indices, direction and up run along the volume's axes"});
    t.add("camera.fov", MEMBER(camera.fov),
          {.unit = "degrees", .help = "Full vertical angle", .range = {0, 180, true, true}});
}

void add_movie(KeyTable& t) {
    t.add("movie.fps", MEMBER(movie.fps), {.help = "Frames a second", .range = {0, 1000, true}});
    t.add("movie.voxel", MEMBER(movie.voxel),
          {.help = "Positions are voxel indices, directions run along the volume's axes"});
    t.add("movie.loop", MEMBER(movie.loop), {.help = "Closed path: the last key repeats the first"});
    t.add(
        "movie.interpolate_frames", MEMBER(movie.interpolate_frames),
        {.help = "With volume.frame animated: samples between two frames are mixed, instead of those of the nearest"});
    t.add("movie.path[].time", MEMBER(movie.path[i].time), {.unit = "s", .help = "Time; ascending"});
    t.add("movie.path[].eye", MEMBER(movie.path[i].eye), {.unit = "world mm", .help = "Position of the eye"});
    t.add("movie.path[].target", MEMBER(movie.path[i].target),
          {.unit = "world mm", .help = "Point at the centre of the picture"});
    t.add("movie.path[].up", MEMBER(movie.path[i].up),
          {.unit = "world", .help = "Up direction of the picture", .direction = true});
    t.add("movie.path[].fov", MEMBER(movie.path[i].fov),
          {.unit = "degrees", .help = "Full vertical angle", .range = {0, 180, true, true}});
    t.add("movie.orbit.degrees", MEMBER(movie.orbit->degrees), {.unit = "degrees", .help = "Angle of the orbit"});
    t.add("movie.orbit.seconds", MEMBER(movie.orbit->seconds), {.unit = "s", .help = "Duration", .range = kAboveZero});
    t.add("movie.orbit.axis", MEMBER(movie.orbit->axis),
          {.unit = "world", .help = "Axis of rotation", .direction = true});
    t.add("movie.flight.points", MEMBER(movie.flight->points),
          {.unit = "world mm", .help = "Points that the eye passes", .absent = "required", .points = true});
    t.add("movie.flight.seconds", MEMBER(movie.flight->seconds),
          {.unit = "s", .help = "Duration", .range = kAboveZero});
    t.add("movie.flight.look_ahead", MEMBER(movie.flight->look_ahead),
          {.unit = "mm", .help = "Distance of the target ahead on the curve", .range = kAboveZero});
    t.add("movie.flight.up", MEMBER(movie.flight->up),
          {.unit = "world", .help = "Up direction of the picture", .direction = true});
    t.add("movie.flight.fov", MEMBER(movie.flight->fov),
          {.unit = "degrees", .help = "Full vertical angle", .range = {0, 180, true, true}});
    t.add("movie.animate[].key", MEMBER(movie.animate[i].key),
          {.help = "Key of a number in the scene, e.g. effects.fog.density or iso_values[0]", .absent = "required"});
    t.add("movie.animate[].times", MEMBER(movie.animate[i].times),
          {.unit = "s", .help = "Time; ascending", .absent = "required"});
    t.add("movie.animate[].values", MEMBER(movie.animate[i].values),
          {.help = "Values at these times; as many as times", .absent = "required"});
}

void add_quality(KeyTable& t) {
    std::vector<std::string> names;
    for (const Preset& preset : presets())
        names.emplace_back(preset.name);
    t.add("quality.preset", MEMBER(quality.preset),
          {.help = "A preset of the settings; the keys below override its values",
           .choices = names,
           .absent = "none: the defaults below"});
    t.keys.back().set = [](SceneDocument& d, std::size_t, const KeyValue& v) {
        d.quality.preset = std::get<std::string>(v);
        d.quality.settings = preset_named(d.quality.preset).settings;
    };
    t.add("quality.max_error", MEMBER(quality.max_error),
          {.unit = "RMS of full scale",
           .help = "Choose the cheapest method with at most this error against its model",
           .range = {0, 1, true, true},
           .absent = "none"});
    for (const Knob& knob : ladder()) {
        SceneKey key{.help = std::string(knob.help)};
        key.path = "quality." + std::string(knob.name);
        std::replace(key.path.begin(), key.path.end(), '-', '_');
        key.type = knob.number ? KeyType::Number : KeyType::Text;
        if (knob.number) key.range = {knob.low, knob.high, knob.above_low};
        for (const auto* steps : {&knob.steps, &knob.others})
            for (const std::string_view step : *steps)
                if (!knob.number) key.choices.emplace_back(step);
        key.get = [&knob](const SceneDocument& d, std::size_t) -> std::optional<KeyValue> {
            const std::string text = knob.get(d.quality.settings);
            return knob.number ? KeyValue(std::stod(text)) : KeyValue(text);
        };
        key.set = [&knob](SceneDocument& d, std::size_t, const KeyValue& v) {
            const auto* number = std::get_if<double>(&v);
            knob.set(d.quality.settings, number ? fmt::format("{}", *number) : std::get<std::string>(v));
        };
        t.keys.push_back(std::move(key));
    }
    t.add("quality.cull_buried", MEMBER(quality.settings.cull_buried),
          {.help = "Cull voxels that opaque voxels enclose"});
}

void add_output(KeyTable& t) {
    t.add(
        "output.file", MEMBER(output.file),
        {.help = "Picture file: .png (8 bit sRGB) or .exr (float32 linear, with alpha); relative to the working folder",
         .absent = "given on the command line"});
    t.add("output.size", MEMBER(output.size), {.unit = "pixels", .help = "Width and height", .range = {1, 16384}});
    t.add("output.aovs", MEMBER(output.aovs), {.help = "Extra outputs", .choices = aov_names(), .absent = "none"});
    t.add("output.compare_plain", MEMBER(output.compare_plain),
          {.help = "Add a picture with conventional splatting beside it"});
    t.add("output.compare_raycast", MEMBER(output.compare_raycast), {.help = "Add a ray cast picture beside it"});
    t.add("output.renderer", MEMBER(output.renderer),
          {.help = "Rendering method", .choices = {kRendererNames.begin(), kRendererNames.end()}});
    t.add("output.raycast_step", MEMBER(output.raycast_step),
          {.unit = "voxels", .help = "Distance between samples (raycast)", .range = {0.01, 4, true}});
    t.add("output.raycast_filter", MEMBER(output.raycast_filter),
          {.help = "Interpolation between samples: trilinear, or the cubic B-spline through them, which is more "
                   "accurate and several times slower (raycast)",
           .choices = {kRaycastFilterNames.begin(), kRaycastFilterNames.end()}});
    t.add("output.tolerance", MEMBER(output.tolerance),
          {.help = "Maximum error of a pixel, of full scale (reference, truth)", .range = {0, 0.1, true}});
}

template <typename Access>
SceneTable list_table(const char* path, const char* help, std::size_t most, Access access) {
    return {path,
            help,
            true,
            most,
            [access](const SceneDocument& d) { return access(d, 0).size(); },
            [access](SceneDocument& d, std::size_t n) { access(d, 0).resize(n); }};
}

template <typename Access>
SceneTable optional_table(const char* path, const char* help, Access access) {
    return {path,
            help,
            false,
            1,
            [access](const SceneDocument& d) -> std::size_t { return access(d, 0) ? 1 : 0; },
            [access](SceneDocument& d, std::size_t n) {
                if (n == 0)
                    access(d, 0).reset();
                else if (!access(d, 0))
                    access(d, 0).emplace();
            }};
}

/// A document in which every optional table exists, for the defaults.
SceneDocument full_document(std::span<const SceneTable> tables) {
    SceneDocument document;
    for (const SceneTable& table : tables)
        table.resize(document, 1);
    return document;
}

}  // namespace

std::span<const SceneTable> scene_tables() {
    static const std::vector<SceneTable> tables{
        list_table("materials", "One per iso-value, in the same order: the material above that value", kMaxIsoValues,
                   MEMBER(materials)),
        list_table("transfer",
                   "Points of a piecewise-linear transfer function, which defines colour and extinction instead of the "
                   "materials",
                   kMaxTransferPoints, MEMBER(transfer)),
        list_table("lights", "At most 4; with `lights = []` colours are unlit. Default: a headlight", kMaxLights,
                   MEMBER(lights)),
        optional_table("effects.fog", "Depth cueing: distant matter fades", MEMBER(effects.fog)),
        optional_table("effects.silhouette", "Lines where surfaces turn away from the eye", MEMBER(effects.silhouette)),
        optional_table("effects.occlusion", "Ambient occlusion: hollows receive less ambient light",
                       MEMBER(effects.occlusion)),
        list_table("effects.clip.keep", "Clip planes: matter beyond any of them is removed", kMaxClipPlanes,
                   MEMBER(effects.clip.keep)),
        list_table("effects.clip.remove", "Clip planes around a region that is removed", kMaxClipPlanes,
                   MEMBER(effects.clip.remove)),
        optional_table("effects.clip.keep_box", "The outside of the box is removed", MEMBER(keep_box)),
        optional_table("effects.clip.remove_box", "The inside of the box is removed", MEMBER(remove_box)),
        list_table("movie.path", "Camera keys in time", 10000, MEMBER(movie.path)),
        optional_table("movie.orbit", "An orbit around the volume's centre, starting at the scene's camera",
                       MEMBER(movie.orbit)),
        optional_table("movie.flight", "A flight along a smooth curve at constant speed", MEMBER(movie.flight)),
        list_table("movie.animate", "A number that changes with time", 1000, MEMBER(movie.animate)),
    };
    return tables;
}

std::span<const SceneKey> scene_keys() {
    static const std::vector<SceneKey> keys = [] {
        KeyTable t;
        add_top(t);
        add_volume(t);
        add_materials(t);
        add_lights(t);
        add_effects(t);
        add_camera(t);
        add_movie(t);
        add_quality(t);
        add_output(t);
        const SceneDocument defaults = full_document(scene_tables());
        for (SceneKey& key : t.keys)
            if (key.absent.empty()) key.default_value = key.get(defaults, 0);
        return t.keys;
    }();
    return keys;
}

}  // namespace edgesplat
