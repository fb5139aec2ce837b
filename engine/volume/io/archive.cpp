// Reads a zip archive of one volume: unpacks it to a folder, which is read like any other; or reads its only file.
#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <fstream>
#include <memory>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

// Maximum number of files in an archive.
constexpr std::size_t kMostFiles = 65535;

struct Unpacked {
    std::size_t files = 0;
    std::string last;  // path of the last file
};

// Files get the last part of their entry's name, so that no path leads out of the folder. A number is prepended if a
// name occurs twice.
Unpacked unpack(const std::string& path, const fs::path& folder, const LoadOptions& options) {
    const std::unique_ptr<archive, int (*)(archive*)> in(archive_read_new(), &archive_read_free);
    archive_read_support_format_zip(in.get());
    const auto check = [&](int result) {
        if (result == ARCHIVE_OK || result == ARCHIVE_WARN || result == ARCHIVE_EOF) return result;
        const char* reason = archive_error_string(in.get());
        fail("{}: truncated or damaged zip archive: {}", path, tidy(reason == nullptr ? "no reason is known" : reason));
    };
    check(archive_read_open_filename(in.get(), path.c_str(), 1 << 16));
    const std::size_t stored = fs::file_size(path);
    Unpacked out;
    std::size_t total = 0;
    std::vector<char> part(1 << 18);
    for (archive_entry* entry = nullptr; check(archive_read_next_header(in.get(), &entry)) != ARCHIVE_EOF;) {
        const char* full_name = archive_entry_pathname(entry);
        const std::string name = full_name == nullptr ? "" : fs::path(full_name).filename().string();
        if (archive_entry_filetype(entry) != AE_IFREG || name.empty() || name.starts_with(".")) continue;
        if (archive_entry_is_encrypted(entry) != 0) fail("{}: its file {} is encrypted", path, full_name);
        if (++out.files > kMostFiles) fail("{}: it contains more than {} files", path, kMostFiles);
        const std::string kept = name.substr(name.size() - std::min<std::size_t>(200, name.size()));
        out.last = folder / kept;
        if (fs::exists(out.last)) out.last = folder / fmt::format("{:05}_{}", out.files, kept);
        std::ofstream file(out.last, std::ios::binary);
        while (true) {
            const la_ssize_t got = archive_read_data(in.get(), part.data(), part.size());
            if (got < 0) check(ARCHIVE_FATAL);
            if (got == 0) break;
            total += static_cast<std::size_t>(got);
            check_stored_size(path, total, stored);
            check_memory(path, "its files unpacked", total);
            file.write(part.data(), got);
            report(options, 0.2, "unpacking");
        }
        file.close();
        if (!file) fail("{}: cannot write a temporary file of {} bytes", path, total);
    }
    return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

}  // namespace

Volume load_archive(const std::string& path, const LoadOptions& options,
                    const std::function<Volume(const std::string&, const LoadOptions&)>& load) {
    const TemporaryFolder folder;
    // The user does not know the temporary folder.
    const std::string place = folder.path().string();
    const auto as_seen = [&](const std::string& text) { return replaced(text, place, path); };
    try {
        const Unpacked unpacked = unpack(path, folder.path(), options);
        if (unpacked.files == 0) fail("{}: a zip archive without files", path);
        Volume volume = load(unpacked.files == 1 ? unpacked.last : place, options);
        volume.name = path;
        for (auto* texts : {&volume.notes, &volume.warnings})
            std::ranges::transform(*texts, texts->begin(), as_seen);
        return volume;
    } catch (const Error& error) {
        fail("{}", as_seen(error.what()));
    }
}

}  // namespace edgesplat::detail
