// The directories of a TIFF file, classic or BigTIFF, in either byte order. Internal to engine/volume/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/files/codec_library_internal.h"
#include "engine/files/sample_type_internal.h"

namespace edgesplat::detail {

/// A field of a directory: where its values lie.
struct TiffField {
    std::uint16_t tag = 0, type = 0;
    std::uint64_t count = 0, at = 0;
};

/// A page as its directory describes it; nothing is checked beyond the fields' own structure.
struct TiffPage {
    std::uint64_t directory = 0;  ///< offset of the directory
    std::uint64_t width = 0, height = 0, depth = 1;
    std::uint64_t rows_per_strip = 0xFFFFFFFF, tile_width = 0, tile_height = 0;  ///< no tiles: 0
    std::uint64_t samples = 1, bits = 1, format = 1, photometric = 1, compression = 1, planar = 1;
    bool says_format = false, says_minimum_is_white = false, is_mixed = false;  ///< is_mixed: samples differ in type
    bool is_reduced = false, is_mask = false, is_geo = false, is_metamorph = false;
    double x_resolution = 0, y_resolution = 0;  ///< pixels per unit; 0: not given
    std::uint64_t resolution_unit = 2;          ///< 1: none, 2: inch, 3: cm
    std::uint64_t orientation = 1;              ///< where the first row and column are
    std::vector<std::string> descriptions;
    std::string no_data, gdal_metadata;  ///< GDAL's fields; empty: not given
    std::optional<TiffField> lsm;
    TiffField offsets, counts;   ///< of the strips or tiles
    std::uint64_t stored = 0;    ///< bytes of all strips or tiles
    std::uint64_t first = 0;     ///< offset of the first one
    bool is_contiguous = false;  ///< they follow each other without gaps
    bool has_missing = false;    ///< some have neither offset nor bytes (sparse files)
};

/// A file's chain of directories. Closed between calls: a sequence may have more files than a process may open.
class TiffFile {
  public:
    /// Reads all directories. `path` names the file in messages and is opened. Throws Error if the structure is broken.
    explicit TiffFile(const std::string& path);

    const std::string& path() const { return path_; }
    const std::vector<TiffPage>& pages() const { return pages_; }
    std::uint64_t size() const { return size_; }
    bool is_swapped() const { return swapped_; }
    /// Bytes of the file. Throws Error beyond its end.
    std::string bytes(std::uint64_t at, std::uint64_t count) const;
    /// A field's values as whole numbers.
    std::vector<std::uint64_t> numbers(const TiffField& field) const;

  private:
    friend class TiffDirectoryReader;
    std::string path_;
    std::vector<TiffPage> pages_;
    std::uint64_t size_ = 0;
    bool swapped_ = false;
};

/// The type of a page's samples; half floats become float32. Throws Error for types that are not read.
SampleType tiff_sample_type(const TiffFile& file, const TiffPage& page);

/// Where the pixels of one slice are: in a page, or uncompressed without a page of their own from an offset on.
struct TiffPlane {
    std::shared_ptr<const TiffFile> file;
    std::size_t page = 0;
    std::optional<std::uint64_t> raw_at;

    const TiffPage& description() const { return file->pages()[page]; }
    /// For messages: "page 3 of FILE".
    std::string name() const;
};

/// Reads slices. Keeps the last file open.
class TiffPixels {
  public:
    /// Reads one sample of every pixel, (height, width) of `tiff_sample_type`, in this machine's byte order. MinIsWhite
    /// is undone for unsigned numbers. Blocks that a sparse file lacks become 0.
    void read(const TiffPlane& plane, std::size_t sample, void* target);

  private:
    std::string open_path_;
    std::unique_ptr<TiffDecoder> decoder_;
    std::string block_;
};

}  // namespace edgesplat::detail
