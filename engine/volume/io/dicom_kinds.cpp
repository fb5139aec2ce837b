// What a DICOM file is, by its SOP class: pictures, or something that is no volume and is named.
#include <algorithm>
#include <cctype>
#include <utility>

#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

constexpr std::string_view kDicomStorage = "1.2.840.10008.5.1.4.1.1.";

struct DicomKind {
    std::string_view classes;  ///< after kDicomStorage; one that ends with "." stands for all that begin so
    std::string_view name;
};

// Files without pixels, and those with pixels that make no volume: 77.
constexpr std::array kKindsWithoutPictures{
    DicomKind{"481.3", "an RT structure set (contours)"},
    DicomKind{"481.5", "an RT plan"},
    DicomKind{"481.8", "an RT ion plan"},
    DicomKind{"481.", "a record of a radiotherapy"},
    DicomKind{"88.59", "a key object selection (a list of images)"},
    DicomKind{"88.", "a structured report"},
    DicomKind{"11.", "a presentation state (how to show other images)"},
    DicomKind{"9.", "a waveform"},
    DicomKind{"104.1", "a PDF document"},
    DicomKind{"104.3", "an STL surface"},
    DicomKind{"104.", "a document"},
    DicomKind{"66.5", "a surface segmentation (meshes)"},
    DicomKind{"66.1", "a spatial registration"},
    DicomKind{"66.2", "spatial fiducials (points)"},
    DicomKind{"66.3", "a deformable registration"},
    DicomKind{"66.6", "tractography results (lines)"},
    DicomKind{"66", "raw data of a scanner"},
    DicomKind{"67", "a mapping of real world values"},
    DicomKind{"68.", "a surface scan (mesh)"},
    DicomKind{"4.2", "MR spectroscopy (spectra)"},
    DicomKind{"77.1.1.1", "a video (endoscopy)"},
    DicomKind{"77.1.2.1", "a video (microscopy)"},
    DicomKind{"77.1.4.1", "a video (photographs)"},
    DicomKind{"77.1.6", "a whole slide microscopy image"},
};

std::string dicom_lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

}  // namespace

bool is_dicom_directory(const DicomItem& data) {
    return data.find(0x00041220) != nullptr;
}

bool is_dicom_segmentation(const DicomItem& data) {
    const std::string uid = data.text(0x00080016);
    return uid == std::string(kDicomStorage) + "66.4" || uid == std::string(kDicomStorage) + "66.7";
}

std::string dicom_kind_without_pictures(const DicomItem& data) {
    const std::string uid = data.text(0x00080016), modality = data.text(0x00080060);
    const bool pixels =
        data.find(0x7fe00010) != nullptr || data.find(0x7fe00008) != nullptr || data.find(0x7fe00009) != nullptr;
    if (uid.starts_with(kDicomStorage)) {
        const std::string_view own = std::string_view(uid).substr(kDicomStorage.size());
        for (const DicomKind& kind : kKindsWithoutPictures)
            if ((!pixels || kind.classes.starts_with("77.")) &&
                (kind.classes == own || (kind.classes.ends_with('.') && own.starts_with(kind.classes))))
                return std::string(kind.name);
    }
    if (pixels) return "";
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kModalities{
        {{"RTSTRUCT", "an RT structure set (contours)"},
         {"RTPLAN", "an RT plan"},
         {"SR", "a structured report"},
         {"KO", "a key object selection (a list of images)"},
         {"PR", "a presentation state (how to show other images)"},
         {"REG", "a spatial registration"}}};
    for (const auto& [name, kind] : kModalities)
        if (modality == name) return std::string(kind);
    return fmt::format("a DICOM file without pixels (modality {}, SOP class {})",
                       modality.empty() ? "not given" : modality, uid.empty() ? "not given" : uid);
}

std::vector<std::string> files_of_dicom_directory(const std::string& path, std::vector<std::string>& warnings) {
    namespace fs = std::filesystem;
    const DicomFile file(path);
    const fs::path folder = fs::path(path).parent_path();
    std::vector<std::string> files;
    std::size_t missing = 0;
    std::string example;
    for (const DicomItem& record : file.data().items(0x00041220)) {
        const std::string id = record.text(0x00041500);
        if (id.empty()) continue;
        fs::path found = folder;
        std::error_code error;
        for (std::size_t from = 0; from <= id.size();) {
            const std::size_t to = std::min(id.find('\\', from), id.size());
            const std::string part = trimmed(id.substr(from, to - from));
            from = to + 1;
            if (found.empty()) continue;
            if (part.empty() || part == ".." || part.find('/') != std::string::npos)
                found.clear();
            else if (fs::exists(found / part, error))
                found /= part;
            else  // copied from a disk, names are often in lower case
                found /= dicom_lower_case(part);
        }
        if (!fs::is_regular_file(found, error)) found.clear();
        if (!found.empty()) {
            files.push_back(found.string());
            continue;
        }
        ++missing;
        example = id;
    }
    if (files.empty())
        fail("{}: a DICOMDIR lists the files of its folder, and none is there; give a folder with DICOM files", path);
    if (missing > 0)
        warnings.push_back(
            fmt::format("{}: {} of the files that it lists are not there, such as {}.", path, missing, example));
    std::ranges::sort(files);
    files.erase(std::unique(files.begin(), files.end()), files.end());
    return files;
}

}  // namespace edgesplat::detail
