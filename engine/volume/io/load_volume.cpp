// Selects the reader: by the kind of path, then by the file's first bytes, then by its name.
#include "engine/volume/load_volume.h"

#include <glob.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>

#include "engine/volume/analytic_volumes.h"
#include "engine/volume/io/hdf5.h"
#include "engine/volume/io/readers.h"
#include "engine/volume/io/tiff.h"
#include "engine/volume/io/zarr.h"
#include "engine/volume/labels.h"
#include "engine/volume/no_data.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/value_text.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using namespace detail;

bool ends_with_any(const std::string& path, std::initializer_list<const char*> endings) {
    std::string lower;
    for (const char c : path)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::any_of(endings.begin(), endings.end(), [&](const char* ending) { return lower.ends_with(ending); });
}

// Checks the kind of file first: opening a FIFO or a device would block.
void check_readable_file(const std::string& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) fail("{}: no such file or folder", path);
    if (error) fail("{}: {}", path, error.message());
    if (status.type() != fs::file_type::regular) fail("{}: neither a file nor a folder", path);
    if (access(path.c_str(), R_OK) != 0) fail("{}: cannot be read: {}", path, std::strerror(errno));
    if (fs::file_size(path) == 0) fail("{}: the file is empty", path);
}

std::string first_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes(1024, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

// Fails if a name inside the file was given, for files and folders in which nothing has a name.
void refuse_inner(const std::string& path, const LoadOptions& options, std::string_view what) {
    if (!options.inner.empty())
        fail("{}:{}: {} has no names inside; expected the path alone, without ':{}'", path, options.inner, what,
             options.inner);
}

bool is_packed_volume(const std::string& path) {
    std::error_code error;
    return fs::is_regular_file(path, error) && first_bytes(path).starts_with(kHdf5Signature) && is_packed(path);
}

void refuse_level(const std::string& path, const LoadOptions& options) {
    if (options.level) fail("{}: --level {}: only OME-Zarr images have levels", path, *options.level);
}

Volume named(Volume volume, std::string_view format) {
    if (volume.format.empty()) volume.format = format;
    return volume;
}

Volume load_packed(const std::string& path, const LoadOptions& options) {
    refuse_inner(path, options, "a packed volume");
    (void)chosen_component(path, options, 1);
    (void)chosen_frame(path, options, 1);
    refuse_level(path, options);
    if (options.spacing)
        fail("{}: --spacing: a packed volume keeps the spacing it was packed with (edgesplat pack --spacing)", path);
    if (options.no_data)
        fail("{}: --no-data: a packed volume keeps the values it was packed with (edgesplat pack --no-data)", path);
    return named(open_packed(path), "packed volume");
}

Volume load_folder(const std::string& path, const LoadOptions& options);
Volume load_file(const std::string& path, const LoadOptions& options, int depth);

// What detection sees of a file.
struct Start {
    const std::string& path;
    const std::string& head;  // the first 1024 bytes
    bool begins(std::string_view text) const { return head.starts_with(text); }
    bool is_named(std::initializer_list<const char*> endings) const { return ends_with_any(path, endings); }
};

// A format of single files: its name in messages, how its files are recognised, its reader.
struct Format {
    std::string_view name;
    bool (*recognises)(const Start& file);
    Volume (*load)(const std::string& path, const LoadOptions& options);
    bool takes_inner = false;  // whether the reader understands options.inner
};

// Signatures first, then names; the first format that recognises a file reads it.
constexpr std::array kFormats{
    Format{"NRRD",
           [](const Start& f) {
               return f.begins("NRRD0") || (f.begins("\x1f\x8b") && f.is_named({".nrrd.gz", ".nhdr.gz"}));
           },
           load_nrrd},
    Format{"legacy VTK image data", [](const Start& f) { return f.begins("# vtk DataFile"); }, load_vtk_legacy, true},
    Format{"VTI and VTR", [](const Start& f) { return f.head.find("<VTKFile") != std::string::npos; }, load_vtk_xml,
           true},
    Format{"MINC",
           [](const Start& f) {
               return f.is_named({".mnc", ".mnc2", ".mnc.gz"}) || is_minc(f.path);
           },
           load_minc},
    Format{"netCDF",
           [](const Start& f) {
               return f.begins("CDF\x01") || f.begins("CDF\x02") || f.begins("CDF\x05") ||
                      (f.begins(kHdf5Signature) && is_netcdf4(f.path));
           },
           load_netcdf, true},
    Format{"HDF5", [](const Start& f) { return f.begins(kHdf5Signature); }, load_hdf5, true},
    Format{"NIfTI and Analyze",
           [](const Start& f) {
               return f.is_named({".nii", ".nii.gz"}) || is_nifti(f.path) ||
                      (f.is_named({".hdr", ".hdr.gz", ".img", ".img.gz"}) && !is_dicom(f.path));
           },
           load_nifti},
    Format{"MGH and MGZ",
           [](const Start& f) {
               return f.is_named({".mgh", ".mgz", ".mgh.gz"}) || is_mgh(f.path);
           },
           load_mgh},
    Format{"MRC and CCP4 maps",
           [](const Start& f) {
               return f.is_named({".mrc", ".mrcs", ".ccp4", ".rec", ".mrc.gz", ".ccp4.gz", ".rec.gz"}) ||
                      is_mrc(f.path) || (f.is_named({".map", ".st", ".ali", ".preali"}) && !is_dicom(f.path));
           },
           load_mrc},
    Format{"NumPy .npy and .npz", [](const Start& f) { return f.is_named({".npy"}) || is_npy(f.path); }, load_npy},
    Format{"MetaImage",
           [](const Start& f) {
               return f.is_named({".mha", ".mhd", ".mha.gz", ".mhd.gz"});
           },
           load_meta},
    Format{"GIPL",
           [](const Start& f) {
               return f.is_named({".gipl", ".gipl.gz"});
           },
           load_gipl},
    Format{"Voreen and Inviwo", [](const Start& f) { return is_volume_dat(f.path, f.head); }, load_volume_dat},
    Format{"DICOM", [](const Start& f) { return is_dicom(f.path); },
           [](const std::string& path, const LoadOptions& options) { return load_dicom(path, {path}, options); }},
    Format{"TIFF", [](const Start& f) { return begins_as_tiff(f.head); },
           [](const std::string& path, const LoadOptions& options) { return load_tiff(path, {path}, options); }},
};

std::string format_names() {
    std::string names;
    for (const Format& format : kFormats)
        names += fmt::format("{}, ", format.name);
    return names;
}

constexpr std::initializer_list<const char*> kImageNames{".tif", ".tiff", ".png", ".bmp",
                                                         ".jpg", ".jpeg", ".pgm", ".tga"};

MemberKind member_kind(const std::string& path) {
    const std::string head = first_bytes(path);
    const Start start{path, head};
    if (head.empty()) return MemberKind::Other;
    if (start.is_named({".pvti", ".pvtr"})) return MemberKind::Parts;
    // The header of a pair of files is the volume.
    for (const char* ending : {".img", ".img.gz"})
        if (start.is_named({ending}) &&
            fs::exists(path.substr(0, path.size() - std::string_view(ending).size()) + ".hdr"))
            return MemberKind::Other;
    for (const Format& format : kFormats)
        if (format.recognises(start)) return format.name == "DICOM" ? MemberKind::Dicom : MemberKind::Volume;
    if (ends_with_any(path, kImageNames)) return MemberKind::Image;
    return is_compressed(head) || is_archive(path, head) ? MemberKind::Volume : MemberKind::Other;
}

/// The part of the names that the files of one series have in common: the extension, else the name without numbers.
std::string kind_of_name(const std::string& path) {
    const auto in_lower_case = [](std::string text) {
        std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return text;
    };
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const std::string extension = fs::path(path).extension().string();
    if (std::ranges::any_of(extension, [](unsigned char c) { return std::isalpha(c) != 0; }))
        return in_lower_case(extension);
    std::string name = fs::path(path).filename().string();
    std::erase_if(name, is_digit);
    return in_lower_case(name);
}

/// Takes those files that are named as the DICOM files are, but are none, out of the others; warns of them.
std::vector<std::string> warnings_of_lost_slices(const std::vector<std::string>& dicom,
                                                 std::vector<std::string>& others) {
    std::set<std::string> kinds;
    for (const std::string& file : dicom)
        kinds.insert(kind_of_name(file));
    std::vector<std::string> lost;
    std::erase_if(others, [&](const std::string& file) {
        if (!kinds.contains(kind_of_name(file))) return false;
        std::error_code error;
        lost.push_back(fs::path(file).filename().string() + (fs::file_size(file, error) == 0 ? " (empty)" : ""));
        return true;
    });
    if (lost.empty()) return {};
    std::ranges::sort(lost);
    constexpr std::size_t kShown = 8;
    const std::size_t shown = std::min(lost.size(), kShown), rest = lost.size() - shown;
    lost.resize(shown);
    return {fmt::format("Left out, as no DICOM files although named like them: {}{}.", fmt::join(lost, ", "),
                        rest > 0 ? fmt::format(" and {} more", rest) : "")};
}

/// Reads the DICOM files among the others.
Volume load_dicom_among(const std::string& path, const std::vector<std::string>& dicom,
                        std::vector<std::string>& others, const LoadOptions& options) {
    const auto warnings = warnings_of_lost_slices(dicom, others);
    Volume volume = load_dicom(path, dicom, options);
    volume.warnings.insert(volume.warnings.end(), warnings.begin(), warnings.end());
    return named(std::move(volume), "DICOM");
}

// `depth`: archives and compressed files around the unpacked file.
ArchiveLoader archive_loader(int depth) {
    return {.kind = member_kind,
            .load = [depth](const std::string& path, const std::vector<fs::path>& files, const LoadOptions& options) {
                if (!fs::is_directory(path)) {
                    check_readable_file(path);
                    return load_file(path, options, depth);
                }
                std::vector<std::string> dicom, others;
                for (const fs::path& file : files)
                    if (file.string().starts_with(path + "/"))
                        (member_kind(file.string()) == MemberKind::Dicom ? dicom : others).push_back(file.string());
                if (dicom.empty()) return load_folder(path, options);
                refuse_inner(path, options, "a folder of slices");
                return load_dicom_among(path, dicom, others, options);
            }};
}

Volume load_file(const std::string& path, const LoadOptions& options, int depth) {
    if (!options.raw.empty()) {
        refuse_inner(path, options, "a raw file");
        return named(load_raw(path, options), "raw data");
    }
    const std::string head = first_bytes(path);
    const Start start{path, head};
    refuse_foreign(path, head);
    // Compressed files of a format that unpacks them itself are its reader's; others are unpacked first.
    const bool compressed =
        is_compressed(head) &&
        !start.is_named({".nii.gz", ".hdr.gz", ".img.gz", ".gipl.gz", ".mgz", ".mgh.gz", ".nrrd.gz", ".nhdr.gz",
                         ".mha.gz", ".mhd.gz", ".mrc.gz", ".ccp4.gz", ".rec.gz", ".mnc.gz"});
    if (is_archive(path, head) && is_zarr_zip(path)) {
        refuse_inner(path, options, "a Zarr archive");
        return named(load_zarr(path, options), "Zarr");
    }
    refuse_level(path, options);
    if (is_archive(path, head) && start.is_named({".npz"})) return named(load_npz(path, options), "NumPy");
    // Archives can be nested without end.
    if ((compressed || !is_compressed(head)) && is_archive(path, head)) {
        if (depth > 0) fail("{}: an archive in an archive", path);
        return load_archive(path, options, archive_loader(depth + 1));
    }
    if (compressed) {
        if (depth > 1) fail("{}: compressed more than twice", path);
        return load_compressed(path, options, archive_loader(depth + 1));
    }
    for (const Format& format : kFormats)
        if (format.recognises(start)) {
            if (!format.takes_inner) refuse_inner(path, options, fmt::format("a file of the format {}", format.name));
            return named(format.load(path, options), format.name);
        }
    refuse_inner(path, options, "a file of this format");
    const std::string kind = foreign_kind(path, head);
    if ((kind.empty() || kind.starts_with("it begins")) &&
        start.is_named({".raw", ".dat", ".bin", ".zraw", ".den", ".vol"}))
        fail(
            "{}: has no header; open the header that belongs to it (.nhdr, .mhd, .dat), or describe it with "
            "--raw DXxDYxDZ:TYPE:little|big[:sx,sy,sz[:skip]]",
            path);
    if (is_image_file(path)) return named(load_images(path, {path}, options), "images");
    fail(
        "{}: unknown volume format{}{}. Supported are {}images, packed volumes, archives (zip, tar) and compressed "
        "files "
        "of these, or raw data described with --raw DXxDYxDZ:TYPE:little|big",
        path, kind.empty() ? "" : ": ", kind, format_names());
}

/// DICOM files in the folders inside: a study often has a folder per series. `others`: the other files there.
std::vector<std::string> dicom_files_below(const std::string& path, std::vector<std::string>& others) {
    constexpr int kDeepest = 6;
    constexpr std::size_t kMostFiles = 65535;
    std::vector<std::string> found;
    std::size_t looked_at = 0;
    std::error_code error;
    for (auto at = fs::recursive_directory_iterator(path, fs::directory_options::skip_permission_denied, error);
         !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
        if (at.depth() >= kDeepest) at.disable_recursion_pending();
        const std::string name = at->path().filename().string();
        if (!at->is_regular_file(error) || name.starts_with(".") || name == "DICOMDIR") continue;
        if (++looked_at > kMostFiles)
            fail("{}: its folders have more than {} files; give the folder of one series", path, kMostFiles);
        const bool is_one = at->file_size(error) > 0 && is_dicom(at->path().string());
        (is_one ? found : others).push_back(at->path().string());
    }
    std::ranges::sort(found);
    return found;
}

Volume load_folder(const std::string& path, const LoadOptions& options) {
    if (!options.raw.empty()) fail("{}: --raw describes a file, this is a folder", path);
    refuse_inner(path, options, "a folder of slices");
    if (is_zarr_folder(path)) return named(load_zarr(path, options), "Zarr");
    refuse_level(path, options);
    std::vector<std::string> dicom, images, others, others_below;
    std::size_t folders = 0;
    report(options, 0.0, "searching the folder");
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(path, error)) {
        const auto file = entry.path().string();
        if (entry.is_directory()) ++folders;
        if (!entry.is_regular_file() || entry.path().filename().string().starts_with(".")) continue;
        if (entry.path().filename() == "DICOMDIR") continue;
        if (entry.file_size() > 0 && is_dicom(file))
            dicom.push_back(file);
        else if (ends_with_any(file, kImageNames))
            images.push_back(file);
        else
            others.push_back(file);
    }
    if (error) fail("{}: cannot be read: {}", path, error.message());
    if (!dicom.empty() && !images.empty())
        fail(
            "{}: holds {} DICOM files and {} images; keep one kind in the folder, or name the images by a pattern such "
            "as slice_%03d.png",
            path, dicom.size(), images.size());
    std::vector<std::string> notes;
    Volume volume;
    if (!dicom.empty()) {
        volume = load_dicom_among(path, dicom, others, options);
    } else if (!images.empty()) {
        images = ordered_slices(path, images, notes);
        volume = named(load_images(path, images, options), "images");
    } else if (folders > 0 && !(dicom = dicom_files_below(path, others_below)).empty()) {
        volume = load_dicom_among(path, dicom, others_below, options);
    } else {
        if (fs::exists(fs::path(path) / "attributes.json"))
            fail("{}: an N5 container, which is not read; convert it to OME-Zarr", path);
        fail(
            "{}: no DICOM files and no images in this folder ({} other files, {} folders inside); give a file or one "
            "of its folders",
            path, others.size(), folders);
    }
    if (!others.empty()) notes.push_back(fmt::format("{} other files in the folder were ignored.", others.size()));
    volume.notes.insert(volume.notes.end(), notes.begin(), notes.end());
    return volume;
}

// Reads the files that match a pattern: a DICOM series (sorted by position) or images (sorted by number).
Volume load_slices(const std::string& path, std::vector<std::string> files, const LoadOptions& options) {
    if (!options.raw.empty()) fail("{}: --raw describes a file, this is a pattern", path);
    refuse_level(path, options);
    if (files.empty()) fail("{}: no file matches this pattern", path);
    std::vector<std::string> images;
    for (const auto& file : files) {
        check_readable_file(file);
        if (!is_dicom(file)) images.push_back(file);
    }
    if (images.empty()) return named(load_dicom(path, files, options), "DICOM");
    if (images.size() < files.size())
        fail("{}: {} of the {} files that match are DICOM, and {} is not; expected one kind", path,
             files.size() - images.size(), files.size(), images.front());
    std::vector<std::string> notes;
    files = ordered_slices(path, files, notes);
    auto volume = named(load_images(path, files, options), "images");
    volume.notes.insert(volume.notes.end(), notes.begin(), notes.end());
    return volume;
}

// "slice_%03d.tif": reads the matching files of the folder, sorted by number.
Volume load_pattern(const std::string& path, const LoadOptions& options) {
    const auto name = fs::path(path).filename().string();
    const auto percent = name.find('%');
    auto end = percent + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0)
        ++end;
    const auto folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    const bool good = percent != std::string::npos && end < name.size() && (name[end] == 'd' || name[end] == 'u') &&
                      name.find('%', end) == std::string::npos;
    if (!good) fail("{}: no such file; a pattern of slices has one number in its last part, like slice_%03d.tif", path);
    const auto before = name.substr(0, percent), after = name.substr(end + 1);
    std::vector<std::string> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const auto file = entry.path().filename().string();
        if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
            continue;
        const auto middle = file.substr(before.size(), file.size() - before.size() - after.size());
        if (std::all_of(middle.begin(), middle.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
            files.push_back(entry.path().string());
    }
    return load_slices(path, files, options);
}

// "*.dcm", "slice_??.png": reads the matching files.
Volume load_glob(const std::string& path, const LoadOptions& options) {
    glob_t found{};
    const int result = glob(path.c_str(), GLOB_NOSORT, nullptr, &found);
    std::vector<std::string> files(found.gl_pathv, found.gl_pathv + (result == 0 ? found.gl_pathc : 0));
    globfree(&found);
    std::ranges::sort(files);
    return load_slices(path, files, options);
}

}  // namespace

std::string detail::format_of_file(const std::string& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0) return "";
    const std::string head = first_bytes(path);
    const Start start{path, head};
    for (const Format& format : kFormats)
        if (format.recognises(start)) return std::string(format.name);
    if (is_compressed(head) || is_archive(path, head)) return "archive";
    return start.is_named({".tif", ".tiff", ".png", ".bmp", ".jpg", ".jpeg", ".pgm", ".tga"}) ? "images" : "";
}

void detail::add_value_notes(Volume& volume) {
    const float largest = std::max(std::abs(volume.min_value), std::abs(volume.max_value));
    const bool wide =
        volume.stored_type.find("32") != std::string::npos || volume.stored_type.find("64") != std::string::npos;
    constexpr const char* kRounded = "Samples beyond 2^24 are rounded to 24 significant bits.";
    if (volume.stored_type.find("int") != std::string::npos && wide && largest > 16777216.0F &&
        std::ranges::find(volume.notes, kRounded) == volume.notes.end())
        volume.notes.emplace_back(kRounded);
    if (volume.non_finite_count > 0)
        volume.notes.push_back(
            fmt::format("{} of {} samples contain no data.", volume.non_finite_count, volume.geometry.voxel_count()));
    // Few steps of float32 between the values: a type with more digits distinguished more.
    const double range = static_cast<double>(volume.max_value) - static_cast<double>(volume.min_value);
    if (wide && volume.stored_type != "float32" && range > 0 && range < std::ldexp(static_cast<double>(largest), -16))
        volume.notes.push_back(
            fmt::format("The values lie close together ({} to {}), and are rounded to 24 significant bits: to steps of "
                        "{:.2g}. Subtract an offset before saving to keep more digits.",
                        value_text(volume, volume.min_value), value_text(volume, volume.max_value),
                        volume.in_file_unit(std::ldexp(1.0, std::ilogb(largest) - 23))));
    for (const SuspectedFill& fill : suspected_fill(volume))
        volume.warnings.push_back(text_of(fill, volume));
    if (!volume.labels) volume.labels = labels_of(volume);
    if (volume.labels)
        volume.notes.push_back(fmt::format("Labels of a segmentation: {} whole numbers without transitions.",
                                           volume.labels->labels.size()));
}

InnerPath split_inner(const std::string& path) {
    std::error_code error;
    if (fs::exists(path, error)) return {path, {}};
    for (auto colon = path.rfind(':'); colon != std::string::npos && colon > 0; colon = path.rfind(':', colon - 1))
        if (colon + 1 < path.size() && fs::exists(path.substr(0, colon), error))
            return {path.substr(0, colon), path.substr(colon + 1)};
    return {path, {}};
}

Volume load_volume(const std::string& full_path, const LoadOptions& given) {
    if (is_builtin(full_path)) return named(builtin_volume(full_path), "builtin");
    if (full_path.empty()) fail("no volume given");
    const auto [path, inner] = split_inner(full_path);
    LoadOptions options = given;
    options.inner = inner;
    std::error_code error;
    Volume volume;
    try {
        if (options.raw.empty() && is_packed_volume(path)) return load_packed(path, options);
        if (fs::is_directory(path, error)) {
            volume = load_folder(path, options);
        } else if (!fs::exists(path, error) && path.find('%') != std::string::npos) {
            volume = load_pattern(path, options);
        } else if (!fs::exists(path, error) && path.find_first_of("*?") != std::string::npos) {
            volume = load_glob(path, options);
        } else {
            check_readable_file(path);
            volume = load_file(path, options, 0);
        }
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory for it", path);
    } catch (const fs::filesystem_error& problem) {
        fail("{}: {}", path, problem.what());
    }
    volume.name = full_path;
    apply_spacing(volume, options);
    report(options, 0.9, "checking voxels");
    if (options.no_data && declare_no_data(volume, *options.no_data) == 0)
        volume.warnings.push_back(fmt::format("--no-data {}: no sample has this value.", *options.no_data));
    finish_volume(volume);
    add_value_notes(volume);
    report(options, 1.0, "done");
    return volume;
}

}  // namespace edgesplat
