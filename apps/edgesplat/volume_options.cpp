#include "apps/edgesplat/volume_options.h"

#include <cstdio>
#include <functional>

#include "apps/edgesplat/progress_bar.h"

void add_volume_options(CLI::App& command, VolumeOptions& options) {
    command.add_option("--raw", options.raw,
                       "Layout of a file without header: DXxDYxDZ:TYPE:little|big[:sx,sy,sz[:skip]]");
    command.add_option("--component", options.component, "Component of vector or colour data, from 0")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--frame", options.frame, "Frame of 4-D data, from 0")->check(CLI::NonNegativeNumber);
    command.add_option("--level", options.level, "Level of an OME-Zarr image, 0: the finest")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--series", options.series,
                       "Series of a DICOM folder, or image of a file, with several: number, UID or name");
    command.add_flag("--resample", options.resample, "Resample unevenly spaced DICOM slices to even spacing");
    command.add_option("--spacing", options.spacing, "Voxel spacing in mm, instead of the file's")->expected(3);
    command.add_option("--no-data", options.no_data,
                       "Value of samples without data: transparent, and in no statistics (NaN always is)");
    command
        .add_option("--segmentation", options.segmentation,
                    "Segmentation of the same object, on any grid: its labels colour the volume's matter; --only and "
                    "--hide choose among them")
        ->type_name("FILE");
    command
        .add_option("--label-names", options.label_names,
                    "Names and colours of labels: a Slicer colour table, an ITK-SNAP label description, a FreeSurfer "
                    "lookup table, or a table with the columns id and name")
        ->type_name("FILE");
    command
        .add_option("--registration", options.registration,
                    "Result of a registration with this volume as the moving image, whose inverse moves the volume: a "
                    "rigid or affine transform of ITK (.tfm, .txt, .h5, or .mat of ANTs)")
        ->type_name("FILE");
}

void apply(const VolumeOptions& options, edgesplat::VolumeSource& source) {
    if (options.component >= 0) source.component = options.component;
    if (options.frame >= 0) source.frame = options.frame;
    if (options.level >= 0) source.level = options.level;
    if (!options.series.empty()) source.series = options.series;
    if (!options.raw.empty()) source.raw = options.raw;
    if (!options.segmentation.empty()) source.segmentation = options.segmentation;
    if (!options.label_names.empty()) source.label_names = options.label_names;
    if (!options.registration.empty()) source.registration = options.registration;
    if (options.resample) source.resample = true;
    if (options.no_data) source.no_data = options.no_data;
    if (options.spacing.size() == 3)
        source.spacing = glm::dvec3(options.spacing[0], options.spacing[1], options.spacing[2]);
}

edgesplat::Volume load_with_progress(edgesplat::SceneDocument& document,
                                     const std::vector<std::filesystem::path>& folders, bool quiet) {
    return load_with_progress([&](const auto& progress) { return load_scene_volume(document, folders, progress); },
                              quiet);
}

edgesplat::Volume load_with_progress(const edgesplat::VolumeSource& source,
                                     const std::vector<std::filesystem::path>& folders, bool quiet) {
    return load_with_progress([&](const auto& progress) { return load_source(source, folders, progress); }, quiet);
}

edgesplat::Volume load_with_progress(const std::function<edgesplat::Volume(const edgesplat::LoadProgress&)>& load,
                                     bool quiet) {
    edgesplat::Volume volume;
    {
        ProgressLine line(quiet);
        volume = load([&line](double fraction, std::string_view what) { line.update(fraction, what); });
    }
    for (const std::string& warning : volume.warnings)
        std::fprintf(stderr, "edgesplat: warning: %s\n", warning.c_str());
    return volume;
}
