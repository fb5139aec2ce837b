// The complete description of a picture as plain data, from a scene file or the command line. `resolve_scene` and
// `resolve_camera` choose omitted values from the data once the volume is loaded.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
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

/// What is seen where volumes overlap: the matter of both; within this volume's grid only its own; or neither: this
/// volume is not drawn, and its matter removes that of the others.
enum class VolumeRule { Add, Inside, Cut };

/// The volume, its preprocessing (threshold or labels, box filter, crop, in this order) and its place in the scene.
struct VolumeSource {
    std::string path;                               ///< file, folder, pattern of slices, or builtin:NAME
    std::string raw, series;                        ///< see LoadOptions; empty: not given
    std::optional<int> component, frame, level;     ///< from 0
    double frame_share = 0;                         ///< of the frame after it, mixed in, [0, 1]
    bool resample = false;                          ///< unevenly spaced DICOM slices are interpolated
    std::optional<glm::dvec3> spacing;              ///< mm, instead of the file's
    std::optional<double> no_data;                  ///< samples with this value contain no data
    std::optional<double> threshold;                ///< 1 from this value up, else 0
    std::optional<bool> labels;                     ///< draws labels (drawn_labels); not given: see `choose_labels`
    std::vector<std::string> only, hide;            ///< labels that are shown, or hidden (chosen_labels)
    std::string segmentation;                       ///< whose labels colour the volume (add_segmentation); empty: none
    std::string label_names;                        ///< file with names and colours of labels; empty: none
    std::string registration;                       ///< file of an ITK transform, whose inverse moves it; empty: none
    bool box_filter = false;                        ///< mean over 3x3x3 voxels
    std::optional<glm::ivec3> crop_low, crop_high;  ///< first and last voxel kept; both or none
    std::vector<double> transform;  ///< 4 x 4, row by row: moves the volume in the world; empty: not moved
    bool visible = true;            ///< whether its matter is drawn
    bool clip = true;               ///< whether the scene's clip planes cut it
    /// Share of a ray that the matter takes in the mean of its chords (mean_chord), (0, 1]; instead of extinctions
    std::optional<double> opacity;
    VolumeRule rule = VolumeRule::Add;
    double rim = 0;        ///< mm, of VolumeRule::Inside (AddedVolume::rim)
    std::string checksum;  ///< of the preprocessed samples, 16 hexadecimal digits; empty: not checked
    bool operator==(const VolumeSource&) const = default;

    /// The files beside the volume's own; empty ones are not given.
    std::array<std::string*, 3> other_files() { return {&segmentation, &label_names, &registration}; }
};

/// A material. Omitted values come from its preset or from the defaults of `resolve_scene`.
struct MaterialChoice {
    std::string preset, name;
    std::optional<glm::dvec3> color;
    std::optional<double> extinction, ambient, diffuse, specular, shininess;
    bool operator==(const MaterialChoice&) const = default;
};

/// A camera: a named view; or an eye with a target or direction; or a direction alone, which frames the volume.
struct CameraChoice {
    std::string view;
    std::optional<glm::dvec3> eye, target, direction, up;
    bool voxel = false;  ///< eye and target are voxel indices, direction and up run along the volume's own axes
    double fov = 45;     ///< full vertical angle, degrees
    bool operator==(const CameraChoice&) const = default;
};

/// Accuracy of the picture.
struct QualityChoice {
    std::string preset;               ///< preset of the ladder that initialised `settings`; empty: none
    Settings settings;                ///< the preset with all individually given knobs applied
    std::optional<double> max_error;  ///< maximum RMS error of full scale, (0, 1); settings are chosen to meet it
    bool operator==(const QualityChoice&) const = default;
};

/// Output of the picture.
struct OutputChoice {
    std::string file;               ///< .png or .exr; empty: given elsewhere
    glm::ivec2 size{512, 512};      ///< pixels
    std::vector<std::string> aovs;  ///< extra outputs: tau, depth, normal, distance
    bool compare_plain = false;     ///< adds a picture with conventional splatting beside it
    bool compare_raycast = false;   ///< adds a ray cast picture beside it
    RendererKind renderer = RendererKind::Splat;
    double raycast_step = 0.5;  ///< voxels
    RaycastFilter raycast_filter = RaycastFilter::Trilinear;
    double tolerance = 1e-4;  ///< for reference and truth
    bool operator==(const OutputChoice&) const = default;
};

/// An orbit around the volume's centre, starting at the scene's camera.
struct OrbitChoice {
    double degrees = 360, seconds = 8;
    glm::dvec3 axis{0, 0, 1};
    bool operator==(const OrbitChoice&) const = default;
};

/// A flight along a curve through points.
struct FlightChoice {
    std::vector<double> points;  ///< x, y, z of each point
    double seconds = 8, look_ahead = 10;
    glm::dvec3 up{0, 0, 1};
    double fov = 60;
    bool operator==(const FlightChoice&) const = default;
};

/// A number of the scene that changes with time.
struct AnimationChoice {
    std::string key;
    std::vector<double> times, values;  ///< same length
    bool operator==(const AnimationChoice&) const = default;
};

/// Camera motion of a movie: keys, an orbit, or a flight.
struct MovieChoice {
    double fps = 25;
    bool voxel = false;  ///< positions are voxel indices; directions run along the volume's axes
    bool loop = false;
    bool interpolate_frames = false;  ///< volume.frame between whole numbers mixes two frames
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

/// A volume that was read for a document, and what it was read from.
struct ReadVolume {
    VolumeSource source;
    std::vector<double> iso_values;
    VolumeGeometry still;  ///< before the source's transform
    std::shared_ptr<const Volume> volume;
};

/// What follows from the rest of a document, so comparisons do not look at it.
struct DerivedVolume {
    std::shared_ptr<const Volume> volume;
    bool operator==(const DerivedVolume&) const { return true; }
};

struct SceneDocument {
    std::string about;  ///< description in words
    VolumeSource volume;
    std::vector<double> iso_values;  ///< empty: from presets, else chosen from the data
    std::vector<double> iso_sigmas;  ///< instead of iso_values: standard deviations above the mean of all samples
    MaterialChoice below;            ///< below the lowest iso-value; transparent by default
    std::vector<MaterialChoice> materials;  ///< above each iso-value, in the same order; empty: defaults
    std::vector<TransferPoint> transfer;
    std::string transfer_preset;
    double ambient = Scene{}.ambient;
    std::vector<Light> lights{Light{}};
    Lit lit = Lit::Everywhere;
    glm::dvec3 background{0};
    Effects effects;
    std::optional<ClipBox> keep_box;    ///< removes its outside
    std::optional<ClipBox> remove_box;  ///< removes its inside; not together with effects.clip.remove
    CameraChoice camera;
    MovieChoice movie;
    QualityChoice quality;
    OutputChoice output;
    /// Volumes beside the first one. Of each only the volume and its matter count (kAddedKeys).
    std::vector<SceneDocument> volumes;
    std::shared_ptr<const ReadVolume> read;  ///< of an entry of `volumes` (read_volumes)
    DerivedVolume whole;                     ///< the first volume before others cut it (Cuts); null: none does
    DerivedVolume cut;                       ///< of an entry: the volume as others cut it (Cuts); null: none does
    bool operator==(const SceneDocument&) const = default;
};

/// A problem in a document and its key.
struct DocumentProblem {
    std::string path;  ///< "effects.fog.density"
    std::string text;  ///< the value and what was expected
};

/// All problems that can be found without reading the volume and that are not range errors of a single key: counts,
/// order, combinations, unknown presets, missing files. `folders` as for `find_volume`.
std::vector<DocumentProblem> problems_of(const SceneDocument& document,
                                         const std::vector<std::filesystem::path>& folders);

/// The folders in which volumes are searched: `first` (empty: the working folder), then those in the environment
/// variable EDGESPLAT_VOLUMES, separated by colons.
std::vector<std::filesystem::path> volume_folders(const std::filesystem::path& first);

/// The path to open: builtin:NAME unchanged, an absolute path, or the first existing `folders`/path. Throws Error
/// listing the folders that were searched.
std::string find_volume(const std::string& path, const std::vector<std::filesystem::path>& folders);

/// A file that a scene names, in the first of the folders that has it; else the path itself.
std::filesystem::path find_file(const std::string& path, const std::vector<std::filesystem::path>& folders);

using LoadProgress = std::function<void(double fraction, std::string_view what)>;

/// Whether labels are chosen (`only`, `hide`).
bool chooses_labels(const VolumeSource& source);

/// What decides the samples that read_source reads, and where they lie.
VolumeSource reading_part(const VolumeSource& source);
/// Gives a source the reading_part of another one.
void read_as(VolumeSource& source, const VolumeSource& other);

/// Finds and reads the volume, with its segmentation and the names of its labels, without preprocessing. Throws Error.
Volume read_source(const VolumeSource& source, const std::vector<std::filesystem::path>& folders,
                   const LoadProgress& progress = {});

/// Reads and preprocesses the volume, and verifies its checksum. Throws Error.
Volume load_source(const VolumeSource& source, const std::vector<std::filesystem::path>& folders,
                   const LoadProgress& progress = {});

/// Reads a scene's volume, decides whether its labels are drawn (choose_labels), preprocesses it and verifies its
/// checksum. If the scene leaves `volume.labels` open, its checksum is that of the samples or of the drawn labels.
/// Throws Error.
Volume load_scene_volume(SceneDocument& document, const std::vector<std::filesystem::path>& folders,
                         const LoadProgress& progress = {});
/// The same for a volume that is read already. With a segmentation whose labels are chosen, sets the document's
/// iso-values first (set_open_iso_values).
Volume prepared_volume(SceneDocument& document, Volume volume);

/// If the document leaves its iso-values to statistics of the volume, makes those for this volume the document's.
void set_open_iso_values(SceneDocument& document, const Volume& volume);

/// Whether an entry of `volumes` is not drawn, but removes matter of the others.
bool cuts(const SceneDocument& entry);

/// The lowest value of visible matter, in the samples' unit. Throws Error if the lowest samples may be matter.
double lowest_matter(const SceneDocument& document, const Volume& volume);

/// Reads and preprocesses the volumes beside the first one that are not read yet, or whose source has changed. `first`:
/// what read_source gave for the first one; those with the same reading_part are not read again. Throws Error naming
/// the volume.
void read_volumes(SceneDocument& document, const std::vector<std::filesystem::path>& folders,
                  const LoadProgress& progress = {}, const Volume* first = nullptr);

/// Names the labels of a volume from a file (read_label_names). Throws Error if it is no segmentation.
void name_labels(Volume& volume, const std::filesystem::path& path);

/// Preprocesses a volume as `load_source` does: threshold or labels, box filter, crop, in this order; moves it, then
/// verifies the checksum. Throws Error.
Volume preprocessed(Volume volume, const VolumeSource& source);

/// Decides whether the labels of a volume from `read_source` are drawn, each in its own colour, and sets
/// `document.volume.labels`. Iso-values, a transfer function and a threshold are about the file's numbers, so with them
/// labels are not drawn, whatever `volume.labels` says. Otherwise they are if `volume.labels` is true, if labels are
/// chosen (`volume.only`, `volume.hide`), or if `volume.labels` is omitted and the volume is a segmentation in memory
/// that is neither builtin nor filtered and has at least 3 labels, or 2 and a name. Throws Error if labels are chosen
/// but not drawn.
void choose_labels(SceneDocument& document, const Volume& volume);

/// The scene for a volume from `load_source`. Omitted iso-values come from, in this order: `iso_sigmas`; the materials'
/// presets; the builtin scene; 0.5 after a threshold and for drawn labels; the strongest suggestion for the volume.
/// Drawn labels have the colours of their table, by default one by number; with a material's colour all have that.
/// Omitted extinctions: 8 per voxel of mean spacing for the highest material, 0.15 for those below it, 0 below the
/// lowest iso-value. What the data decide, volumes decide as they are before cuts. Its other volumes must be read
/// (read_volumes) and cut (Cuts). Throws Error.
Scene resolve_scene(const SceneDocument& document, const Volume& volume);

/// The camera for the size in `document.output`. By default: front of a builtin volume and of a patient (top if that is
/// a slab), else the most informative view. Throws Error.
Camera resolve_camera(const SceneDocument& document, const Volume& volume, const Scene& scene);

/// The camera path of the movie; without one, the camera `start` stands still. Throws Error.
CameraPath resolve_camera_path(const SceneDocument& document, const Volume& volume, const Camera& start);

/// The movie's animated numbers. Throws Error.
std::vector<AnimatedParameter> resolve_animation(const SceneDocument& document);

/// A document of the same picture with every choice written out: no preset, no movie, with the checksum of `volume`.
SceneDocument resolved(const SceneDocument& document, const Volume& volume, const Scene& scene, const Camera& camera,
                       const Settings& settings);

}  // namespace edgesplat
