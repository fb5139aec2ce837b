// Reads a volume box by box, to pack volumes larger than memory. Internal to engine/volume.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/volume/io/readers.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::detail {

class PackSource {
  public:
    virtual ~PackSource() = default;
    PackSource() = default;
    PackSource(const PackSource&) = delete;
    PackSource& operator=(const PackSource&) = delete;

    /// Everything except the samples and values derived from them.
    Volume description;
    /// Whether samples are read from elsewhere than memory.
    virtual bool streamed() const { return true; }
    /// Reads a box inside the volume, x fastest; non-finite samples are not replaced.
    virtual void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const = 0;
};

/// Position and type of a file's samples, stored contiguously, x fastest.
struct FileLayout {
    std::string file;        ///< the data file; may differ from the named file
    std::size_t offset = 0;  ///< bytes before the first sample
    SampleType type = SampleType::UInt8;
    bool swapped = false;  ///< stored in the other byte order than this machine's
    /// A sample is slope * stored + intercept.
    double slope = 1, intercept = 0;
};

/// Layout of a file that --raw describes; fills `description`.
FileLayout raw_layout(const std::string& path, const LoadOptions& options, Volume& description);
/// Layout of a file with a header that stores one uncompressed volume contiguously; nullopt for all other files,
/// including invalid ones.
std::optional<FileLayout> nrrd_layout(const std::string& path, Volume& description);
std::optional<FileLayout> meta_layout(const std::string& path, Volume& description);

/// Fails if the file ends before the last sample.
std::unique_ptr<PackSource> file_source(const FileLayout& layout, const Volume& description);
/// `volume` must outlive the source.
std::unique_ptr<PackSource> memory_source(const Volume& volume);
/// Reads builtin scenes and uncompressed files box by box; loads all others through load_volume.
std::unique_ptr<PackSource> open_source(const std::string& path, const LoadOptions& options);

}  // namespace edgesplat::detail
