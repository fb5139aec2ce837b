#include "engine/volume/find_volumes.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "engine/volume/analytic_volumes.h"
#include "engine/volume/io/readers.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool is_zarr(const fs::path& folder) {
    std::error_code none;
    return folder.extension() == ".zarr" ||
           std::ranges::any_of(std::initializer_list<const char*>{".zgroup", ".zarray", ".zattrs", "zarr.json"},
                               [&](const char* name) { return fs::exists(folder / name, none); });
}

/// The header's text; it contains the names of data files.
std::string start_of(const fs::path& path) {
    constexpr std::size_t kHeader = 65536;
    std::ifstream file(path, std::ios::binary);
    std::string text(kHeader, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

/// Files of one folder that belong to a header in it.
std::set<fs::path> data_files(const std::vector<fs::path>& files) {
    std::set<fs::path> found;
    for (const fs::path& header : files) {
        const std::string name = lower_case(header.filename().string());
        if (name.ends_with(".hdr") || name.ends_with(".hdr.gz")) {
            const std::string stem = name.substr(0, name.rfind(".hdr"));
            for (const fs::path& file : files)
                if (const std::string other = lower_case(file.filename().string());
                    other == stem + ".img" || other == stem + ".img.gz")
                    found.insert(file);
        }
        if (!name.ends_with(".mhd") && !name.ends_with(".nhdr") && !name.ends_with(".dat") && !name.ends_with(".pvti"))
            continue;
        const std::string text = start_of(header);
        for (const fs::path& file : files)
            if (file != header && text.find(file.filename().string()) != std::string::npos) found.insert(file);
    }
    return found;
}

void search(const fs::path& folder, FoundVolumes& found) {
    if (is_zarr(folder)) {
        found.paths.push_back(folder.string());
        return;
    }
    std::vector<fs::path> files, folders;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        if (entry.path().filename().string().starts_with(".")) continue;
        if (entry.is_directory(error))
            folders.push_back(entry.path());
        else if (entry.is_regular_file(error))
            files.push_back(entry.path());
    }
    if (error) fail("{}: cannot be read: {}", folder.string(), error.message());
    std::ranges::sort(files);
    std::ranges::sort(folders);
    const std::set<fs::path> data = data_files(files);
    std::vector<std::string> slices, others;
    bool dicom = false;
    for (const fs::path& file : files) {
        const std::string format = detail::format_of_file(file.string());
        if (file.filename() == "DICOMDIR" || data.contains(file)) continue;
        if (format == "DICOM")
            dicom = true;
        else if (format == "images")
            slices.push_back(file.string());
        else if (format.empty())
            ++found.ignored;
        else
            others.push_back(file.string());
    }
    // DICOM with images in the same folder is refused, and the message says why.
    if (dicom || slices.size() > 1) {
        found.paths.push_back(folder.string());
    } else {
        for (const std::string& slice : slices)
            if (const std::string name = lower_case(slice); name.ends_with(".tif") || name.ends_with(".tiff"))
                others.push_back(slice);
            else
                ++found.ignored;  // a single picture is no volume
    }
    std::ranges::sort(others);
    found.paths.insert(found.paths.end(), others.begin(), others.end());
    for (const fs::path& inside : folders)
        search(inside, found);
}

}  // namespace

FoundVolumes find_volumes(const std::vector<std::string>& paths) {
    FoundVolumes found;
    for (const std::string& path : paths) {
        std::error_code error;
        if (!is_builtin(path) && fs::is_directory(path, error))
            search(path, found);
        else
            found.paths.push_back(path);
    }
    return found;
}

}  // namespace edgesplat
