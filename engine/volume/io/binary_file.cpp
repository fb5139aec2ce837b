#include "engine/volume/io/binary_file.h"

#include <zlib.h>

namespace edgesplat::detail {

PlainOrGzip::PlainOrGzip(const std::string& name, const std::string& file)
    : name_(name), file_(gzopen(file.c_str(), "rb")) {
    if (file_ == nullptr) fail("{}: {} cannot be opened", name, file);
    gzbuffer(static_cast<gzFile>(file_), 1 << 18);
}

PlainOrGzip::~PlainOrGzip() {
    gzclose(static_cast<gzFile>(file_));
}

std::size_t PlainOrGzip::read(void* target, std::size_t count) {
    constexpr std::size_t kMost = std::size_t{1} << 30;
    std::size_t done = 0;
    while (done < count) {
        const auto want = static_cast<unsigned>(std::min(kMost, count - done));
        const int got = gzread(static_cast<gzFile>(file_), static_cast<char*>(target) + done, want);
        if (got < 0) {
            int code = 0;
            const char* text = gzerror(static_cast<gzFile>(file_), &code);
            fail("{}: damaged gzip data: {}", name_, text);
        }
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

void PlainOrGzip::skip_to(std::size_t offset) {
    if (gzseek(static_cast<gzFile>(file_), static_cast<z_off_t>(offset), SEEK_SET) < 0)
        fail("{}: truncated: no data at byte {}", name_, offset);
}

std::size_t PlainOrGzip::read_rest() {
    std::vector<char> part(1 << 18);
    std::size_t rest = 0;
    while (const std::size_t got = read(part.data(), part.size()))
        rest += got;
    int code = Z_OK;
    (void)gzerror(static_cast<gzFile>(file_), &code);
    if (code == Z_BUF_ERROR) fail("{}: truncated: its gzip data are incomplete", name_);
    return rest;
}

bool PlainOrGzip::is_gzip() const {
    return gzdirect(static_cast<gzFile>(file_)) == 0;
}

std::string first_unpacked_bytes(const std::string& path, std::size_t count) {
    std::string bytes;
    try {
        PlainOrGzip stream(path, path);
        constexpr std::size_t kPart = std::size_t{1} << 16;
        for (std::size_t done = 0; done < count && done == bytes.size(); done += kPart) {
            bytes.resize(std::min(count, done + kPart));
            bytes.resize(done + stream.read(bytes.data() + done, bytes.size() - done));
        }
    } catch (const Error&) {
        bytes.clear();
    }
    return bytes;
}

std::size_t block_offset(const std::string& path, std::size_t first, std::size_t index, std::size_t bytes) {
    std::size_t offset = 0;
    if (__builtin_mul_overflow(index, bytes, &offset) || __builtin_add_overflow(offset, first, &offset))
        fail("{}: truncated: the chosen frame lies beyond the end of the file", path);
    return offset;
}

std::vector<char> read_block(const StoredBlock& block, const LoadOptions& options, std::vector<std::string>& notes) {
    const std::size_t stored = std::filesystem::file_size(block.file);
    PlainOrGzip stream(block.path, block.file);
    const std::size_t end = block_offset(block.path, block.offset, 1, block.bytes);
    if (!stream.is_gzip() && end > stored)
        fail("{}: truncated: its voxels end at byte {}, the file at byte {}", block.path, end, stored);
    check_stored_size(block.path, end, stored);
    stream.skip_to(block.offset);
    std::vector<char> bytes(block.bytes);
    constexpr std::size_t kPart = std::size_t{1} << 22;
    for (std::size_t done = 0; done < bytes.size();) {
        const std::size_t want = std::min(kPart, bytes.size() - done);
        const std::size_t got = stream.read(bytes.data() + done, want);
        done += got;
        if (got < want) fail("{}: truncated: {} of {} bytes of voxels", block.path, done, block.bytes);
        report(options, 0.6 * static_cast<double>(done) / static_cast<double>(block.bytes), "reading voxels");
    }
    const std::size_t rest = stream.is_gzip() ? stream.read_rest() : stored - end;
    if (rest > block.after)
        notes.push_back(fmt::format("{} bytes after the last voxel were not used.", rest - block.after));
    if (rest < block.after)
        notes.push_back(
            fmt::format("The file is truncated: {} bytes of other frames are missing.", block.after - rest));
    return bytes;
}

}  // namespace edgesplat::detail
