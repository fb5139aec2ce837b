// Binary headers and blocks of samples in files that are plain or gzip: shared by the readers of NIfTI, MGH, MRC and
// NumPy. Internal to engine/volume/io.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "engine/volume/io/readers.h"
#include "engine/volume/io/samples.h"

namespace edgesplat::detail {

/// Reads a plain or gzip file from its beginning to its end, unpacked. `name`: the user's path, for messages.
class PlainOrGzip {
  public:
    PlainOrGzip(const std::string& name, const std::string& file);
    ~PlainOrGzip();
    PlainOrGzip(const PlainOrGzip&) = delete;
    PlainOrGzip& operator=(const PlainOrGzip&) = delete;

    /// Reads up to `count` bytes; fewer at the end of the file. Fails if the gzip data are damaged.
    std::size_t read(void* target, std::size_t count);
    void skip_to(std::size_t offset);
    /// Reads to the end, which verifies the checksum of gzip data. Returns the number of bytes.
    std::size_t read_rest();
    bool is_gzip() const;

  private:
    std::string name_;
    void* file_;  // gzFile
};

/// The first bytes of a file, unpacked if it is gzip; fewer if there are no more or the file is damaged.
std::string first_unpacked_bytes(const std::string& path, std::size_t count);

/// A header of fixed layout.
struct BinaryHeader {
    std::string bytes;
    bool swapped = false;  ///< in the other byte order than this machine's

    /// The number at byte `at`, which must lie in the header.
    template <typename T>
    T get(std::size_t at) const {
        std::array<char, sizeof(T)> raw{};
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), raw.begin());
        if (swapped) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }
};

/// Consecutive bytes of a file.
struct StoredBlock {
    std::string path;  ///< the user's path, for messages
    std::string file;  ///< the file that is read
    std::size_t offset = 0, bytes = 0;
    std::size_t after = 0;  ///< bytes after the block that the header explains, e.g. later frames
};

/// first + index * bytes. Fails with "truncated" if that overflows.
std::size_t block_offset(const std::string& path, std::size_t first, std::size_t index, std::size_t bytes);

/// Reads a block. Fails with "truncated" if the file ends before its end, if possible before anything is allocated.
/// Adds a note about bytes that the header does not explain.
std::vector<char> read_block(const StoredBlock& block, const LoadOptions& options, std::vector<std::string>& notes);

}  // namespace edgesplat::detail
