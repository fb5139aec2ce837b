// Selects the reader: by the kind of path, then by the file's first bytes, then by its name.
#include "engine/volume/load_volume.h"

#include <glob.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "engine/volume/analytic_volumes.h"
#include "engine/volume/hdf5_internal.h"
#include "engine/volume/labels.h"
#include "engine/volume/load_internal.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using namespace detail;

constexpr const char* kFormats =
    "NRRD, MetaImage, NIfTI, Analyze, DICOM, MINC, legacy VTK image data, {}GIPL, TIFF and other images, packed "
    "volumes, zip archives of one of these, or raw data described with --raw DXxDYxDZ:TYPE:little|big";

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

Volume load_vtk(const std::string& path, const std::string& head, const LoadOptions& options) {
    std::string upper;
    for (const char c : head)
        upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto at = upper.find("\nDATASET");
    if (at != std::string::npos && upper.find("STRUCTURED_POINTS", at) == std::string::npos)
        fail("{}: a VTK file, but not image data (DATASET STRUCTURED_POINTS)", path);
    // ITK's reader leaves missing values of a short file uninitialised. The values begin after the line that names
    // their lookup table, or after the line that names the values if there is no table.
    std::size_t begin = 0;
    for (const char* key : {"\nLOOKUP_TABLE", "\nSCALARS", "\nCOLOR_SCALARS", "\nVECTORS", "\nTENSORS"}) {
        const auto found = upper.find(key);
        if (found == std::string::npos) continue;
        begin = upper.find('\n', found + 1);
        break;
    }
    if (begin == 0 || begin == std::string::npos) fail("{}: a VTK file without values at its points", path);
    const bool ascii = upper.find("\nASCII") != std::string::npos;
    const auto check_data = [&](std::size_t bytes, std::size_t samples) {
        const std::size_t stored = fs::file_size(path) - begin - 1;
        if (!ascii && bytes > stored) fail("{}: truncated: {} of {} bytes of voxels", path, stored, bytes);
        if (!ascii) return;
        std::ifstream file(path);
        file.seekg(static_cast<std::streamoff>(begin));
        std::size_t found = 0;
        for (std::string word; found < samples && file >> word;)
            ++found;
        if (found < samples) fail("{}: truncated: {} of {} values", path, found, samples);
    };
    return load_through_itk({.format = ItkFormat::Vtk, .path = path, .check_data = check_data}, options);
}

Volume load_minc(const std::string& path, const LoadOptions& options) {
    check_netcdf_is_whole(path);
    const std::lock_guard lock(hdf5_mutex());
    return load_through_itk({.format = ItkFormat::Minc, .path = path, .stored_bytes = fs::file_size(path)}, options);
}

// ITK's reader reads missing voxels as 0.
Volume load_gipl(const std::string& path, const LoadOptions& options) {
    constexpr std::size_t kHeader = 256;
    const auto check_data = [&](std::size_t bytes, std::size_t) {
        const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), &gzclose);
        std::vector<char> part(1 << 16);
        std::size_t found = 0;
        for (int count = 1; file && count > 0 && found < kHeader + bytes; found += static_cast<std::size_t>(count))
            count = std::max(gzread(file.get(), part.data(), static_cast<unsigned>(part.size())), 0);
        if (found < kHeader + bytes)
            fail("{}: truncated: {} of {} bytes of voxels", path, found - std::min(found, kHeader), bytes);
    };
    return load_through_itk(
        {.format = ItkFormat::Gipl, .path = path, .stored_bytes = fs::file_size(path), .check_data = check_data},
        options);
}

bool is_hdf5(const std::string& path) {
    std::error_code error;
    return fs::is_regular_file(path, error) && first_bytes(path).starts_with("\x89HDF\r\n\x1a\n");
}

Volume load_packed(const std::string& path, const LoadOptions& options) {
    (void)chosen_component(path, options, 1);
    (void)chosen_frame(path, options, 1);
    if (options.spacing)
        fail("{}: --spacing: a packed volume keeps the spacing it was packed with (edgesplat pack --spacing)", path);
    return open_packed(path);
}

bool is_archive(std::string_view head) {
    return head.starts_with("PK\x03\x04");
}

Volume load_folder(const std::string& path, const LoadOptions& options);
Volume load_file(const std::string& path, const LoadOptions& options);

Volume load_unpacked(const std::string& path, const LoadOptions& options) {
    if (fs::is_directory(path)) return load_folder(path, options);
    check_readable_file(path);
    // Refused, because archives can be nested without end.
    if (is_archive(first_bytes(path))) fail("{}: an archive in an archive", path);
    return load_file(path, options);
}

Volume load_file(const std::string& path, const LoadOptions& options) {
    if (!options.raw.empty()) return load_raw(path, options);
    const auto head = first_bytes(path);
    const auto starts = [&](std::string_view text) { return head.compare(0, text.size(), text) == 0; };
    if (is_archive(head)) return load_archive(path, options, load_unpacked);
    if (starts("NRRD0")) return load_nrrd(path, options);
    if (starts("# vtk DataFile")) return load_vtk(path, head, options);
    if (head.find("<VTKFile") != std::string::npos) return load_vti(path, options);
    if (starts("CDF\x01") || starts("CDF\x02") || (starts("\x89HDF") && ends_with_any(path, {".mnc", ".mnc2"})))
        return load_minc(path, options);
    if (ends_with_any(path, {".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz"}))
        return load_nifti(path, options);
    if (ends_with_any(path, {".mha", ".mhd"})) return load_meta(path, options);
    if (ends_with_any(path, {".gipl", ".gipl.gz"})) return load_gipl(path, options);
    if (is_dicom(path)) return load_dicom(path, {path}, options);
    if (ends_with_any(path, {".raw", ".dat", ".bin", ".zraw", ".den"}))
        fail(
            "{}: has no header; open the header that belongs to it (.nhdr, .mhd), or describe it with "
            "--raw DXxDYxDZ:TYPE:little|big[:sx,sy,sz[:skip]]",
            path);
    if (is_image_file(path)) return load_images(path, {path}, options);
    fail("{}: unknown volume format. Supported are {}", path, fmt::format(kFormats, can_read_vti() ? "VTI, " : ""));
}

Volume load_folder(const std::string& path, const LoadOptions& options) {
    if (!options.raw.empty()) fail("{}: --raw describes a file, this is a folder", path);
    std::vector<std::string> dicom, images;
    std::size_t others = 0, folders = 0;
    report(options, 0.0, "searching the folder");
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(path, error)) {
        const auto file = entry.path().string();
        if (entry.is_directory()) ++folders;
        if (!entry.is_regular_file() || entry.path().filename().string().starts_with(".")) continue;
        if (entry.path().filename() == "DICOMDIR") continue;
        if (entry.file_size() > 0 && is_dicom(file))
            dicom.push_back(file);
        else if (ends_with_any(file, {".tif", ".tiff", ".png", ".bmp", ".jpg", ".jpeg", ".pgm", ".tga"}))
            images.push_back(file);
        else
            ++others;
    }
    if (error) fail("{}: cannot be read: {}", path, error.message());
    if (!dicom.empty() && !images.empty())
        fail(
            "{}: holds {} DICOM files and {} images; keep one kind in the folder, or name the images by a pattern such "
            "as slice_%03d.png",
            path, dicom.size(), images.size());
    std::vector<std::string> notes;
    if (others > 0) notes.push_back(fmt::format("{} other files in the folder were ignored.", others));
    Volume volume;
    if (!dicom.empty()) {
        volume = load_dicom(path, dicom, options);
    } else if (!images.empty()) {
        images = ordered_slices(path, images, notes);
        volume = load_images(path, images, options);
    } else {
        fail(
            "{}: no DICOM files and no images in this folder ({} other files, {} folders inside); give a file or one "
            "of "
            "its folders",
            path, others, folders);
    }
    volume.notes.insert(volume.notes.end(), notes.begin(), notes.end());
    return volume;
}

// Reads the files that match a pattern: a DICOM series (sorted by position) or images (sorted by number).
Volume load_slices(const std::string& path, std::vector<std::string> files, const LoadOptions& options) {
    if (!options.raw.empty()) fail("{}: --raw describes a file, this is a pattern", path);
    if (files.empty()) fail("{}: no file matches this pattern", path);
    std::vector<std::string> images;
    for (const auto& file : files) {
        check_readable_file(file);
        if (!is_dicom(file)) images.push_back(file);
    }
    if (images.empty()) return load_dicom(path, files, options);
    if (images.size() < files.size())
        fail("{}: {} of the {} files that match are DICOM, and {} is not; expected one kind", path,
             files.size() - images.size(), files.size(), images.front());
    std::vector<std::string> notes;
    files = ordered_slices(path, files, notes);
    auto volume = load_images(path, files, options);
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

void detail::add_value_notes(Volume& volume) {
    const float largest = std::max(std::abs(volume.min_value), std::abs(volume.max_value));
    const bool wide =
        volume.stored_type.find("32") != std::string::npos || volume.stored_type.find("64") != std::string::npos;
    if (volume.stored_type.find("int") != std::string::npos && wide && largest > 16777216.0F)
        volume.notes.push_back("Samples beyond 2^24 are rounded to 24 significant bits.");
    if (volume.non_finite_count > 0)
        volume.notes.push_back(fmt::format("{} samples are not finite; {} replaces them.", volume.non_finite_count,
                                           static_cast<double>(volume.min_value)));
    if (const std::size_t count = labels_of(volume).size(); count > 0)
        volume.notes.push_back(fmt::format("Labels of a segmentation: {} whole numbers without transitions.", count));
}

Volume load_volume(const std::string& path, const LoadOptions& options) {
    if (is_builtin(path)) return builtin_volume(path);
    if (path.empty()) fail("no volume given");
    std::error_code error;
    Volume volume;
    try {
        if (options.raw.empty() && is_hdf5(path) && !ends_with_any(path, {".mnc", ".mnc2"}))
            return load_packed(path, options);
        if (fs::is_directory(path, error)) {
            volume = load_folder(path, options);
        } else if (!fs::exists(path, error) && path.find('%') != std::string::npos) {
            volume = load_pattern(path, options);
        } else if (!fs::exists(path, error) && path.find_first_of("*?") != std::string::npos) {
            volume = load_glob(path, options);
        } else {
            check_readable_file(path);
            volume = load_file(path, options);
        }
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory for it", path);
    } catch (const fs::filesystem_error& problem) {
        fail("{}: {}", path, problem.what());
    }
    apply_spacing(volume, options);
    report(options, 0.9, "checking voxels");
    finish_volume(volume);
    add_value_notes(volume);
    report(options, 1.0, "done");
    return volume;
}

}  // namespace edgesplat
