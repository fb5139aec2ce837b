// Samples of a volume read box by box, for packing volumes larger than memory. Internal to engine/volume.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "engine/volume/load_internal.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::detail {

class PackSource {
  public:
    virtual ~PackSource() = default;
    PackSource() = default;
    PackSource(const PackSource&) = delete;
    PackSource& operator=(const PackSource&) = delete;

    /// Everything but samples and what follows from them.
    Volume description;
    /// Whether samples come from elsewhere than from memory.
    virtual bool streamed() const { return true; }
    /// A box inside the volume, x fastest, as the volume has them: those that are not finite too.
    virtual void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const = 0;
};

/// Where the samples of a file lie, one after the other, x fastest.
struct FileLayout {
    std::string file;        ///< which may not be the one that was named
    std::size_t offset = 0;  ///< bytes before the first
    SampleType type = SampleType::UInt8;
    bool swapped = false;  ///< not in the byte order of this machine
};

/// Where the voxels are that --raw describes; `description` gets what it says of them.
FileLayout raw_layout(const std::string& path, const LoadOptions& options, Volume& description);
/// Likewise for files with a header, where they hold one volume as it is, uncompressed and in one piece; nothing for
/// all others, whatever is wrong with them.
std::optional<FileLayout> nrrd_layout(const std::string& path, Volume& description);
std::optional<FileLayout> meta_layout(const std::string& path, Volume& description);

/// Fails where the file ends before the last sample.
std::unique_ptr<PackSource> file_source(const FileLayout& layout, const Volume& description);
/// `volume` must outlive it.
std::unique_ptr<PackSource> memory_source(const Volume& volume);
/// Builtin scenes and files that hold their samples as they are, uncompressed, are read where they lie; all others
/// through load_volume.
std::unique_ptr<PackSource> open_source(const std::string& path, const LoadOptions& options);

}  // namespace edgesplat::detail
