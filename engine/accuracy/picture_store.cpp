#include "engine/accuracy/picture_store.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "engine/error.h"
#include "engine/image/image_file.h"

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

std::string bytes_of(const Image& image) {
    std::string bytes(image.pixels.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), image.pixels.data(), bytes.size());
    return bytes;
}

/// The picture that the entry describes; nullopt if the file has changed.
std::optional<ReferencePicture> read(const std::filesystem::path& path, const ordered_json& entry) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    ReferencePicture picture{Image(entry["width"], entry["height"], entry["channels"]), entry["error_estimate"]};
    if (bytes.size() != picture.image.pixels.size() * sizeof(float) || entry["checksum"] != checksum_of(bytes))
        return {};
    std::memcpy(picture.image.pixels.data(), bytes.data(), bytes.size());
    return picture;
}

}  // namespace

std::filesystem::path PictureStore::file_of(const std::string& key) const {
    return folder_ / (checksum_of(key) + ".float32");
}

ordered_json PictureStore::make(const std::string& key, const std::function<ReferencePicture()>& compute) const {
    const ReferencePicture picture = compute();
    const std::string bytes = bytes_of(picture.image);
    const FileContent file{file_of(key), bytes};
    write_files({&file, 1});
    return {{"width", picture.image.width},
            {"height", picture.image.height},
            {"channels", picture.image.channels},
            {"error_estimate", picture.error_estimate},
            {"checksum", checksum_of(bytes)}};
}

ReferencePicture PictureStore::get(const std::string& key, const std::function<ReferencePicture()>& compute) {
    if (const ordered_json* entry = journal_.find(key))
        if (auto picture = read(file_of(key), *entry)) return std::move(*picture);
    journal_.add(key, make(key, compute));
    auto picture = read(file_of(key), *journal_.find(key));
    if (!picture) fail("{}: cannot read the picture that was just written", file_of(key).string());
    return std::move(*picture);
}

}  // namespace edgesplat::accuracy
