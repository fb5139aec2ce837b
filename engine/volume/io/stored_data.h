// Samples in the encodings of NRRD, MetaImage, GIPL and raw files, in one file or in several. Internal to
// engine/volume.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/volume/pack_source_internal.h"

namespace edgesplat::detail {

/// Deflate: a zlib or gzip stream. Text: numbers between white space or commas. Hex: two digits a byte.
enum class StoredEncoding { Raw, Deflate, Bzip2, Text, Hex };

/// Place and encoding of stored samples.
struct StoredData {
    std::string path;                          ///< the user's path, used in messages
    std::vector<std::filesystem::path> files;  ///< data files in order; each holds an equal share of the samples
    std::filesystem::path header;              ///< the file of a detached header; empty: the header has the data
    StoredEncoding encoding = StoredEncoding::Raw;
    SampleType type = SampleType::UInt8;
    bool swapped = false;       ///< in the other byte order than this machine's
    std::size_t offset = 0;     ///< bytes before the data in each file, e.g. of a header
    std::size_t line_skip = 0;  ///< then lines to skip, before unpacking
    std::size_t byte_skip = 0;  ///< then bytes to skip, after unpacking
    bool at_end = false;        ///< instead of byte_skip: the data are the last bytes
    double slope = 1, intercept = 0;
    bool may_continue = false;  ///< bytes after the last sample need no mention
    std::size_t samples = 0;    ///< samples in all files

    std::size_t bytes() const { return samples * size_of(type); }
};

/// Which samples are voxels of the volume: voxel (x, y, z) is sample first + x * step[0] + y * step[1] + z * step[2].
struct StoredSelection {
    std::size_t first = 0;
    std::array<std::size_t, 3> step{};
};

/// Fails if a data file is missing, is the detached header itself, or is too small for its share.
void check_stored(const StoredData& data);

/// Fills `volume.values`; `volume.geometry.dims` must be set and limits on memory checked. Fails like check_stored, or
/// if the data are truncated, damaged or not numbers. Adds a warning, or a
/// note for a few bytes, if data follow the last sample.
void read_stored(const StoredData& data, const StoredSelection& selection, Volume& volume, const LoadOptions& options);

/// The layout for reading box by box, after check_stored; nullopt if the samples are encoded, in several files or not
/// contiguous.
std::optional<FileLayout> layout_of_stored(const StoredData& data, const StoredSelection& selection,
                                           const Volume& description);

/// Unpacks a file that begins as gzip into a new `folder` and returns the unpacked file; returns `path` for other
/// files. Fails if the result exceeds the memory limit or deflate's best ratio.
std::string without_gzip(const std::string& path, std::optional<TemporaryFolder>& folder);

/// Names of data files from a pattern with one number such as "slice%03d.raw". Fails, naming `what`, if it contains
/// anything else that printf interprets, or if first, last and step are no range of at most 1,000,000 files.
std::vector<std::string> names_of_pattern(const std::string& path, std::string_view what, const std::string& pattern,
                                          long long first, long long last, long long step);

}  // namespace edgesplat::detail
