// Reads a volume in an archive (zip, tar, compressed tar) or in a compressed file. The content is unpacked to a
// temporary folder, with its own folders inside, so that headers find their data files.
#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <memory>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

// Maximum number of files in an archive.
constexpr std::size_t kMostFiles = 65535;

struct ArchiveReader {
    ArchiveReader(const std::string& file, bool single) : path(file), in(archive_read_new(), &archive_read_free) {
        // No program is run to unpack a format that libarchive lacks.
        archive_read_support_filter_gzip(in.get());
        archive_read_support_filter_bzip2(in.get());
        archive_read_support_filter_xz(in.get());
        archive_read_support_filter_lzma(in.get());
        archive_read_support_filter_zstd(in.get());
        archive_read_support_filter_lz4(in.get());
        archive_read_support_filter_compress(in.get());
        archive_read_support_format_zip(in.get());
        archive_read_support_format_tar(in.get());
        if (single) archive_read_support_format_raw(in.get());
        check(archive_read_open_filename(in.get(), path.c_str(), 1 << 16));
    }
    int check(int result) const {
        if (result == ARCHIVE_OK || result == ARCHIVE_WARN || result == ARCHIVE_EOF) return result;
        const char* reason = archive_error_string(in.get());
        if (reason != nullptr && std::string_view(reason) == "Unrecognized archive format")
            fail("{}: a compressed file without content", path);
        fail("{}: truncated or damaged archive or compressed file: {}", path,
             tidy(reason == nullptr ? "no reason is known" : reason));
    }
    archive_entry* next() const {
        archive_entry* entry = nullptr;
        return check(archive_read_next_header(in.get(), &entry)) == ARCHIVE_EOF ? nullptr : entry;
    }

    const std::string& path;
    std::unique_ptr<archive, int (*)(archive*)> in;
};

// libarchive does not compare the checksums of gzip.
void check_gzip(const std::string& path) {
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), &gzclose_r);
    if (!file) fail("{}: cannot be read", path);
    if (gzdirect(file.get()) != 0) return;
    std::vector<char> part(1 << 18);
    int got = 0;
    do
        got = gzread(file.get(), part.data(), static_cast<unsigned>(part.size()));
    while (got > 0);
    int error = Z_OK;
    const char* reason = gzerror(file.get(), &error);
    if (got < 0 || error != Z_OK) fail("{}: truncated or damaged gzip data: {}", path, tidy(reason));
}

std::string entry_name(archive_entry* entry) {
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr) name = archive_entry_pathname_utf8(entry);
    std::string text = name == nullptr ? "" : name;
    // Windows programs write folders with backslashes.
    if (text.find('/') == std::string::npos) std::ranges::replace(text, '\\', '/');
    return text;
}

// The path of a member below the folder: ".." and a root lead nowhere. Empty for hidden files, such as those that macOS
// adds; a Zarr store's own are kept.
fs::path member_path(const std::string& name) {
    fs::path inside;
    for (const fs::path& part : fs::path(name)) {
        const std::string text = part.string();
        if (text.empty() || text == "." || text == "/" || text == "..") continue;
        if ((text.starts_with(".") && !text.starts_with(".z")) || text == "__MACOSX") return {};
        // Folders and files may have names of 255 bytes; a number may be prepended.
        inside /= text.substr(text.size() - std::min<std::size_t>(200, text.size()));
    }
    return inside;
}

class Unpacking {
  public:
    Unpacking(const std::string& path, const LoadOptions& options)
        : path_(path), options_(options), stored_(fs::file_size(path)) {
        std::array<char, 4> head{};
        std::ifstream(path, std::ios::binary).read(head.data(), head.size());
        const std::string_view begin(head.data(), head.size());
        const bool deflate = begin.starts_with("\x1f\x8b") || begin.starts_with("PK");
        ratio_ = deflate ? kBestDeflateRatio : kBestPictureRatio;
    }

    void copy(const ArchiveReader& from, const fs::path& to) {
        std::error_code error;
        fs::create_directories(to.parent_path(), error);
        std::ofstream file(to, std::ios::binary);
        while (file) {
            const la_ssize_t got = archive_read_data(from.in.get(), part_.data(), part_.size());
            if (got < 0) from.check(ARCHIVE_FATAL);
            if (got <= 0) break;
            total_ += static_cast<std::size_t>(got);
            check_stored_size(path_, total_, stored_, ratio_);
            check_memory(path_, "its files unpacked", total_);
            file.write(part_.data(), got);
            report(options_, 0.2, "unpacking");
        }
        file.close();
        if (!file) fail("{}: cannot write a temporary file of {} bytes", path_, total_);
    }

  private:
    const std::string& path_;
    const LoadOptions& options_;
    std::size_t stored_ = 0, ratio_ = 0, total_ = 0;
    std::vector<char> part_ = std::vector<char>(1 << 18);
};

// Unpacks all files; a number is prepended if a name occurs twice. Returns their paths in the folder, sorted.
std::vector<fs::path> unpack(const std::string& path, const fs::path& folder, const LoadOptions& options,
                             std::vector<std::string>& warnings) {
    check_gzip(path);
    const ArchiveReader in(path, false);
    Unpacking unpacking(path, options);
    std::vector<fs::path> files;
    while (archive_entry* entry = in.next()) {
        const std::string name = entry_name(entry);
        const fs::path inside = member_path(name);
        const auto type = archive_entry_filetype(entry);
        const bool link = type == AE_IFLNK || archive_entry_hardlink(entry) != nullptr;
        if (link && !inside.empty()) warnings.push_back(fmt::format("{}: the link {} was left out.", path, tidy(name)));
        if (link || type != AE_IFREG || inside.empty()) continue;
        if (archive_entry_is_encrypted(entry) != 0) fail("{}: its file {} is encrypted", path, tidy(name));
        if (files.size() == kMostFiles) fail("{}: it contains more than {} files", path, kMostFiles);
        std::error_code error;
        fs::path to = folder / inside;
        if (fs::exists(to, error))
            to.replace_filename(fmt::format("{:05}_{}", files.size() + 1, to.filename().string()));
        unpacking.copy(in, to);
        files.push_back(to);
    }
    std::ranges::sort(files);
    return files;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

// Calls work, whose messages name temporary files, with these names replaced by what the user knows.
template <typename Work>
Volume with_names(const std::vector<std::pair<std::string, std::string>>& names, const Work& work) {
    const auto as_seen = [&](std::string text) {
        for (const auto& [temporary, known] : names)
            text = replaced(std::move(text), temporary, known);
        return text;
    };
    try {
        Volume volume = work();
        for (auto* texts : {&volume.notes, &volume.warnings})
            std::ranges::transform(*texts, texts->begin(), as_seen);
        return volume;
    } catch (const Error& error) {
        fail("{}", as_seen(error.what()));
    }
}

std::string member_list(const std::string& path, const fs::path& folder, const std::vector<fs::path>& members) {
    std::string text;
    for (std::size_t i = 0; i < members.size() && i < 12; ++i)
        text += fmt::format("{}{}:{}", i == 0 ? "" : ", ", path, fs::relative(members[i], folder).string());
    if (members.size() > 12) text += fmt::format(" and {} more", members.size() - 12);
    return text;
}

// The files and folders that are volumes. Slices of one folder, or all DICOM files, are one volume: their folder.
std::vector<fs::path> volumes_among(const std::vector<fs::path>& files, const fs::path& folder,
                                    const ArchiveLoader& loader) {
    std::vector<fs::path> volumes, joined;
    std::map<fs::path, std::vector<fs::path>> slices;
    fs::path dicom;
    for (const fs::path& file : files) {
        const MemberKind kind = loader.kind(file.string());
        if (kind == MemberKind::Volume) volumes.push_back(file);
        if (kind == MemberKind::Parts) joined.push_back(file);
        if (kind == MemberKind::Image) slices[file.parent_path()].push_back(file);
        if (kind == MemberKind::Dicom)
            dicom = dicom.empty() || dicom == file.parent_path() ? file.parent_path() : folder;
    }
    // The parts of a file that puts several together are no volumes of their own.
    const auto is_part = [](const fs::path& file) { return file.extension() == ".vti" || file.extension() == ".vtr"; };
    if (!joined.empty()) std::erase_if(volumes, is_part);
    volumes.insert(volumes.end(), joined.begin(), joined.end());
    if (!dicom.empty()) volumes.push_back(dicom);
    // Pictures beside a volume show it to people.
    const bool alone = volumes.empty();
    for (const auto& [place, images] : slices) {
        const bool tiff = std::ranges::any_of(
            images, [](const fs::path& file) { return file.extension().string().starts_with(".tif"); });
        if (alone || tiff) volumes.push_back(images.size() == 1 ? images.front() : place);
    }
    return volumes;
}

}  // namespace

bool is_archive(const std::string& path, std::string_view head) {
    if (head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06")) return true;
    if (head.size() > 262 && head.substr(257, 5) == "ustar") return true;
    if (!is_compressed(head)) return false;
    try {
        const ArchiveReader in(path, true);
        return in.next() != nullptr && archive_format(in.in.get()) != ARCHIVE_FORMAT_RAW;
    } catch (const Error&) {
        return false;
    }
}

bool is_compressed(std::string_view head) {
    static constexpr std::array<std::string_view, 6> kSignatures{"\x1f\x8b",
                                                                 "BZh",
                                                                 "\xfd"
                                                                 "7zXZ",
                                                                 "\x28\xb5\x2f\xfd",
                                                                 "\x04\x22\x4d\x18",
                                                                 "\x1f\x9d"};
    return std::ranges::any_of(kSignatures, [&](std::string_view start) { return head.starts_with(start); });
}

Volume load_archive(const std::string& path, const LoadOptions& options, const ArchiveLoader& loader) {
    const TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    LoadOptions rest = options;
    rest.inner.clear();
    return with_names({{folder.string() + "/", path + ":"}, {folder.string(), path}}, [&] {
        std::vector<std::string> warnings;
        const auto files = unpack(path, folder, options, warnings);
        if (files.empty()) fail("{}: an archive without files", path);
        fs::path chosen;
        if (!options.inner.empty()) {
            const auto [name, inner] = split_inner((folder / member_path(options.inner)).string());
            std::error_code error;
            if (!fs::exists(name, error))
                fail("{}:{}: no such file in the archive; it holds {}", path, options.inner,
                     member_list(path, folder, files));
            chosen = name;
            rest.inner = inner;
        } else if (files.size() == 1) {
            chosen = files.front();
        } else {
            const auto volumes = volumes_among(files, folder, loader);
            if (volumes.empty())
                fail("{}: an archive of {} files without a volume: {}", path, files.size(),
                     member_list(path, folder, files));
            if (volumes.size() > 1)
                fail("{}: an archive of {} volumes; choose one: {}", path, volumes.size(),
                     member_list(path, folder, volumes));
            // cppcheck-suppress containerOutOfBounds; fail() does not return
            chosen = volumes.front();
        }
        Volume volume = loader.load(chosen.string(), files, rest);
        volume.warnings.insert(volume.warnings.end(), warnings.begin(), warnings.end());
        return volume;
    });
}

Volume load_compressed(const std::string& path, const LoadOptions& options, const ArchiveLoader& loader) {
    const TemporaryFolder temporary;
    fs::path name = fs::path(path).filename();
    for (const char* ending : {".gz", ".bz2", ".xz", ".zst", ".lz4", ".Z", ".GZ"})
        if (name.extension() == ending) name = name.stem();
    const fs::path file = temporary.path() / name;
    return with_names({{file.string(), path}, {temporary.path().string(), path}}, [&] {
        check_gzip(path);
        const ArchiveReader in(path, true);
        if (in.next() == nullptr) fail("{}: a compressed file without content", path);
        Unpacking(path, options).copy(in, file);
        return loader.load(file.string(), {file}, options);
    });
}

}  // namespace edgesplat::detail
