// Everything a picture needs, as plain data: what a scene file holds and what the command line fills in. What is left
// open ("chosen from the data") is decided by `resolve_scene` and `resolve_camera` once the volume is there.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/camera.h"
#include "engine/scene/camera_path.h"
#include "engine/scene/renderer_kind.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// Which samples, and what is done to them first: threshold or labels, box filter, crop, in this order.
struct VolumeSource {
    std::string path;                               ///< file, folder, pattern of slices, or builtin:NAME
    std::string raw, series;                        ///< see LoadOptions; empty: not given
    std::optional<int> component, frame;            ///< from 0
    bool resample = false;                          ///< unevenly spaced DICOM slices are interpolated
    std::optional<glm::dvec3> spacing;              ///< mm, instead of the file's
    std::optional<double> threshold;                ///< 1 from this value up, else 0
    std::optional<bool> labels;                     ///< things by number (drawn_labels); open: `recognise_labels`
    bool box_filter = false;                        ///< mean over 3x3x3 voxels
    std::optional<glm::ivec3> crop_low, crop_high;  ///< first and last voxel kept; both or none
    std::string checksum;  ///< of the samples as drawn, 16 hexadecimal digits; empty: any will do
    bool operator==(const VolumeSource&) const = default;
};

/// A material, of which anything may be left to a preset or to the defaults of `resolve_scene`.
struct MaterialChoice {
    std::string preset, name;
    std::optional<glm::dvec3> color;
    std::optional<double> extinction, ambient, diffuse, specular, shininess;
    bool operator==(const MaterialChoice&) const = default;
};

/// A named view, or an eye with a target or a direction, or a direction alone, which frames the volume.
struct CameraChoice {
    std::string view;
    std::optional<glm::dvec3> eye, target, direction, up;
    bool voxel = false;  ///< eye and target are voxel indices, direction and up run along the volume's own axes
    double fov = 45;     ///< full vertical angle, degrees
    bool operator==(const CameraChoice&) const = default;
};

/// How accurately.
struct QualityChoice {
    std::string preset;               ///< the row of the ladder that `settings` began with; empty: none
    Settings settings;                ///< the row, with every knob that was said on top
    std::optional<double> max_error;  ///< RMS of full scale, (0, 1): settings are chosen to keep it
    bool operator==(const QualityChoice&) const = default;
};

/// What becomes of it.
struct OutputChoice {
    std::string file;               ///< .png or .exr; empty: said elsewhere
    glm::ivec2 size{512, 512};      ///< pixels
    std::vector<std::string> aovs;  ///< extra outputs: tau, depth, normal, distance
    bool compare_plain = false;     ///< conventional splatting beside it
    bool compare_raycast = false;   ///< what the ray caster makes of it beside it
    RendererKind renderer = RendererKind::Splat;
    double raycast_step = 0.5;  ///< voxels
    RaycastFilter raycast_filter = RaycastFilter::Trilinear;
    double tolerance = 1e-4;  ///< of reference and truth
    bool operator==(const OutputChoice&) const = default;
};

/// Once around the volume's centre, starting at the scene's camera.
struct OrbitChoice {
    double degrees = 360, seconds = 8;
    glm::dvec3 axis{0, 0, 1};
    bool operator==(const OrbitChoice&) const = default;
};

/// Along a curve through points.
struct FlightChoice {
    std::vector<double> points;  ///< x, y, z of each
    double seconds = 8, look_ahead = 10;
    glm::dvec3 up{0, 0, 1};
    double fov = 60;
    bool operator==(const FlightChoice&) const = default;
};

/// A number of the scene that changes with time.
struct AnimationChoice {
    std::string key;
    std::vector<double> times, values;  ///< as many of the one as of the other
    bool operator==(const AnimationChoice&) const = default;
};

/// How the picture moves: by keys, by an orbit, or by a flight.
struct MovieChoice {
    double fps = 25;
    bool voxel = false;  ///< positions are voxel indices; directions run along the volume's axes
    bool loop = false;
    std::vector<CameraKey> path;
    std::optional<OrbitChoice> orbit;
    std::optional<FlightChoice> flight;
    std::vector<AnimationChoice> animate;
    bool operator==(const MovieChoice&) const = default;
};

/// A box along the world's axes: six clip planes.
struct ClipBox {
    glm::dvec3 low{0}, high{0};  ///< world mm; high above low along each axis
    bool operator==(const ClipBox&) const = default;
};

struct SceneDocument {
    std::string about;  ///< what is to be seen, in words
    VolumeSource volume;
    std::vector<double> iso_values;         ///< empty: from presets, else chosen from the data
    std::vector<double> iso_sigmas;         ///< in their place: standard deviations above the mean of all samples
    MaterialChoice below;                   ///< below the lowest iso-value; transparent unless said otherwise
    std::vector<MaterialChoice> materials;  ///< from each iso-value up, in the same order; empty: defaults
    std::vector<TransferPoint> transfer;
    std::string transfer_preset;
    double ambient = Scene{}.ambient;
    std::vector<Light> lights{Light{}};
    Lit lit = Lit::Everywhere;
    glm::dvec3 background{0};
    Effects effects;
    std::optional<ClipBox> keep_box;    ///< what lies outside of it is cut away, too
    std::optional<ClipBox> remove_box;  ///< what lies in it is; not beside planes of effects.clip.remove
    CameraChoice camera;
    MovieChoice movie;
    QualityChoice quality;
    OutputChoice output;
    bool operator==(const SceneDocument&) const = default;
};

/// One thing that is wrong, and with which key.
struct DocumentProblem {
    std::string path;  ///< "effects.fog.density"
    std::string text;  ///< the value and what was expected
};

/// What is wrong with it as far as can be told without reading the volume, beyond what a single key's range says:
/// counts, order, combinations, unknown presets, files that are not there. `folders` as for `find_volume`.
std::vector<DocumentProblem> problems_of(const SceneDocument& document,
                                         const std::vector<std::filesystem::path>& folders);

/// The folders that volumes are looked for in: `first` (empty: the working folder), then those that the environment
/// variable EDGESPLAT_VOLUMES names, with colons between.
std::vector<std::filesystem::path> volume_folders(const std::filesystem::path& first);

/// The path to open: builtin:NAME as it is, else the first that exists of absolute path and `folders`/path. Throws
/// Error naming all places looked at.
std::string find_volume(const std::string& path, const std::vector<std::filesystem::path>& folders);

/// Finds, reads and preprocesses the volume and compares its checksum. Throws Error.
Volume load_source(const VolumeSource& source, const std::vector<std::filesystem::path>& folders,
                   const std::function<void(double fraction, std::string_view what)>& progress = {});

/// What `load_source` does to a volume that is read: threshold or labels, box filter, crop, in this order, and the
/// checksum compared. Throws Error.
Volume preprocessed(Volume volume, const VolumeSource& source);

/// Where a scene says neither what of the volume is to be seen nor whether it is a segmentation, and `volume`, as
/// `load_source` gave it for the scene, is one of several things: has each drawn in a colour of its own, by setting
/// `document.volume.labels`, and changes the volume accordingly. Rays are cast through values alone, so a scene that
/// asks for any is left as it is.
void recognise_labels(SceneDocument& document, Volume& volume);

/// The scene for a volume from `load_source`. Iso-values left open: from `iso_sigmas`, those of the materials' presets,
/// of a builtin scene, 0.5 after a threshold, and around labels with a colour for each, else the strongest suggestion
/// for the volume. Extinctions left open: 8 per voxel of
/// mean spacing for the highest material, 0.15 for those below; none below the lowest iso-value. Throws Error.
Scene resolve_scene(const SceneDocument& document, const Volume& volume);

/// The camera, for the size in `document.output`. Where none is asked for: front of a builtin volume and of a patient
/// (top where that is a slab), else the view that tells most. Throws Error.
Camera resolve_camera(const SceneDocument& document, const Volume& volume, const Scene& scene);

/// The camera's way through the movie; without one the camera of `start` stands still. Throws Error.
CameraPath resolve_camera_path(const SceneDocument& document, const Volume& volume, const Camera& start);

/// The movie's animated numbers. Throws Error.
std::vector<AnimatedParameter> resolve_animation(const SceneDocument& document);

/// The same picture, without the movie, with nothing left open and no preset: every choice written out, the checksum of
/// `volume` in it.
SceneDocument resolved(const SceneDocument& document, const Volume& volume, const Scene& scene, const Camera& camera,
                       const Settings& settings);

}  // namespace edgesplat
