// Zarr hierarchies in folders and zip archives.
#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "engine/volume/io/zarr.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

/// Maximum bytes of a metadata file.
constexpr std::uintmax_t kMostMetadata = 16 << 20;
constexpr std::size_t kMostEntries = 1 << 22;
constexpr std::string_view kMetadataNames[] = {"zarr.json", ".zarray", ".zgroup", ".zattrs"};

bool is_metadata_name(std::string_view key) {
    const std::string_view name = key.substr(key.rfind('/') == std::string_view::npos ? 0 : key.rfind('/') + 1);
    return std::ranges::find(kMetadataNames, name) != std::end(kMetadataNames);
}

class ZarrFolder : public ZarrStore {
  public:
    explicit ZarrFolder(const std::string& path) : path_(path) {}

    std::optional<std::string> text(const std::string& key) const override {
        const fs::path file = path_ / key;
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) return std::nullopt;
        const std::uintmax_t size = fs::file_size(file);
        if (size > kMostMetadata) fail("{}: {} bytes of metadata, expected at most 16 MiB", file.string(), size);
        return content(file, static_cast<std::size_t>(size));
    }

    void visit(const std::vector<std::string>& keys,
               const std::function<void(std::size_t, const std::string&)>& take) const override {
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const fs::path file = path_ / keys[i];
            std::error_code ignored;
            if (!fs::is_regular_file(file, ignored)) continue;
            const std::uintmax_t size = fs::file_size(file);
            check_memory(file.string(), "a chunk", size);
            take(i, content(file, static_cast<std::size_t>(size)));
        }
    }

    std::vector<std::string> children(const std::string& key) const override {
        std::vector<std::string> names;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(path_ / key, ignored))
            if (entry.is_directory(ignored) && is_zarr_folder(entry.path().string()))
                names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }

    std::string shown(const std::string& key) const override {
        return key.empty() ? path_.string() : (path_ / key).string();
    }

  private:
    static std::string content(const fs::path& file, std::size_t size) {
        std::ifstream in(file, std::ios::binary);
        std::string bytes(size, '\0');
        in.read(bytes.data(), static_cast<std::streamsize>(size));
        if (!in) fail("{}: cannot be read", file.string());
        return bytes;
    }

    fs::path path_;
};

using Archive = std::unique_ptr<archive, int (*)(archive*)>;

Archive opened_zip(const std::string& path) {
    Archive in(archive_read_new(), &archive_read_free);
    archive_read_support_format_zip_seekable(in.get());
    if (archive_read_open_filename(in.get(), path.c_str(), 1 << 16) != ARCHIVE_OK)
        fail("{}: truncated or damaged zip archive", path);
    return in;
}

/// Moves to the next file; false at the end.
bool next_file(archive* in, const std::string& path, std::string& name, archive_entry*& entry) {
    while (true) {
        const int result = archive_read_next_header(in, &entry);
        if (result == ARCHIVE_EOF) return false;
        if (result != ARCHIVE_OK && result != ARCHIVE_WARN) fail("{}: truncated or damaged zip archive", path);
        const char* full = archive_entry_pathname(entry);
        if (full == nullptr || archive_entry_filetype(entry) != AE_IFREG) continue;
        name = full;
        while (name.starts_with("./"))
            name.erase(0, 2);
        return true;
    }
}

std::string file_content(archive* in, const std::string& path, const std::string& name, std::uintmax_t limit) {
    std::string bytes;
    std::vector<char> part(1 << 16);
    while (true) {
        const la_ssize_t got = archive_read_data(in, part.data(), part.size());
        if (got < 0) fail("{}: its file {} is truncated or damaged", path, name);
        if (got == 0) return bytes;
        bytes.append(part.data(), static_cast<std::size_t>(got));
        if (bytes.size() > limit) fail("{}: its file {} has more than {} bytes", path, name, limit);
        check_memory(path, "a file of it", bytes.size());
    }
}

class ZarrZip : public ZarrStore {
  public:
    explicit ZarrZip(const std::string& path) : path_(path) {
        const Archive in = opened_zip(path);
        std::string name;
        archive_entry* entry = nullptr;
        std::size_t entries = 0, bytes = 0;
        while (next_file(in.get(), path, name, entry)) {
            if (++entries > kMostEntries) fail("{}: more than {} files", path, kMostEntries);
            if (!is_metadata_name(name)) continue;
            if (archive_entry_is_encrypted(entry) != 0) fail("{}: its file {} is encrypted", path, name);
            auto& text = texts_[name];
            text = file_content(in.get(), path, name, kMostMetadata);
            check_memory(path, "its metadata", bytes += text.size());
        }
        // The hierarchy may lie in a folder of the archive: the one of the shortest metadata key.
        std::string shortest;
        for (const auto& [key, text] : texts_)
            if (shortest.empty() || std::ranges::count(key, '/') < std::ranges::count(shortest, '/')) shortest = key;
        const auto slash = shortest.rfind('/');
        if (slash != std::string::npos) root_ = shortest.substr(0, slash + 1);
    }

    std::optional<std::string> text(const std::string& key) const override {
        const auto found = texts_.find(root_ + key);
        return found == texts_.end() ? std::nullopt : std::optional(found->second);
    }

    void visit(const std::vector<std::string>& keys,
               const std::function<void(std::size_t, const std::string&)>& take) const override {
        std::map<std::string, std::size_t> wanted;
        for (std::size_t i = 0; i < keys.size(); ++i)
            wanted.emplace(root_ + keys[i], i);
        const Archive in = opened_zip(path_);
        std::string name;
        archive_entry* entry = nullptr;
        while (next_file(in.get(), path_, name, entry)) {
            const auto found = wanted.find(name);
            if (found == wanted.end()) continue;
            if (archive_entry_is_encrypted(entry) != 0) fail("{}: its file {} is encrypted", path_, name);
            const std::string bytes = file_content(in.get(), path_, name, std::uintmax_t{1} << 40);
            const std::size_t index = found->second;
            wanted.erase(found);  // a name that occurs twice is read once
            take(index, bytes);
        }
    }

    std::vector<std::string> children(const std::string& key) const override {
        const std::string group = root_ + (key.empty() ? "" : key + "/");
        std::set<std::string> names;
        for (const auto& [name, text] : texts_) {
            if (!name.starts_with(group)) continue;
            const std::string rest = name.substr(group.size());
            if (const auto slash = rest.find('/'); slash != std::string::npos && rest.rfind('/') == slash)
                names.insert(rest.substr(0, slash));
        }
        return {names.begin(), names.end()};
    }

    std::string shown(const std::string& key) const override {
        return key.empty() ? path_ : fmt::format("{} ({})", path_, root_ + key);
    }

  private:
    std::string path_, root_;  // root_: "" or a folder with its slash
    std::map<std::string, std::string> texts_;
};

}  // namespace

bool is_zarr_folder(const std::string& path) {
    return std::ranges::any_of(kMetadataNames, [&](std::string_view name) {
        std::error_code ignored;
        return fs::is_regular_file(fs::path(path) / name, ignored);
    });
}

bool is_zarr_zip(const std::string& path) {
    try {
        const Archive in = opened_zip(path);
        std::string name;
        archive_entry* entry = nullptr;
        while (next_file(in.get(), path, name, entry))
            if (is_metadata_name(name)) return true;
    } catch (const Error&) {  // the reader of other archives says what is wrong
    }
    return false;
}

std::unique_ptr<ZarrStore> zarr_folder(const std::string& path) {
    return std::make_unique<ZarrFolder>(path);
}

std::unique_ptr<ZarrStore> zarr_zip(const std::string& path) {
    return std::make_unique<ZarrZip>(path);
}

std::string zarr_key(const std::string& group, const std::string& name) {
    return group.empty() ? name : name.empty() ? group : group + "/" + name;
}

}  // namespace edgesplat::detail
