// Volumes from files: one function for every format, one Error for every reason it cannot be read.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Voxels a volume may have. More would not fit in 32-bit indices on the device, nor in the memory of most hosts.
inline constexpr std::size_t kMaxVoxels = std::size_t{1} << 31;
/// Voxels an axis may have.
inline constexpr std::size_t kMaxVoxelsPerAxis = 65535;

// Memory: one volume takes no more than the machine has, or than the environment variable EDGESPLAT_READ_MEMORY says in
// MiB: the samples as the file has them with all their frames and components, and 4 bytes a voxel. A file that needs
// more is refused before any of it is allocated, and so is a header that promises more than its file can hold: bytes
// of voxels as many as are stored, or 1040 times as many of deflated ones, the best that deflate can do.

/// What the file leaves open. Every member has a value that means "not given".
struct LoadOptions {
    std::optional<int> component;       ///< which component of a vector or colour voxel, from 0
    std::optional<int> frame;           ///< which frame of 4-D data, from 0 (5-D and above: all further axes in one)
    std::string series;                 ///< DICOM folder with several series: the number (from 0) or UID of one
    std::string raw;                    ///< header-less file: "64x64x64:uint8:little[:sx,sy,sz[:skip]]", see `load_raw`
    bool resample = false;              ///< DICOM slices that are unevenly spaced are interpolated at even places
    std::optional<glm::dvec3> spacing;  ///< mm, replaces the file's spacing along i, j, k; directions are kept
    /// Called now and then with a fraction in [0, 1] and what is being done. Called on the loading thread only.
    std::function<void(double fraction, std::string_view what)> progress;
};

/// Reads a volume and finishes it (see `finish_volume`). `path` is one of
///  - a file: NRRD, MetaImage, NIfTI-1/2, Analyze, DICOM, MINC2, legacy VTK image data, GIPL, VTI (if built with VTK),
///    a TIFF stack, VolPack .den with --raw, or any file with `options.raw`;
///  - a packed volume (packed_volume.h), whose samples stay in the file and whose limits are other ones;
///  - a zip archive of one such file, or of the files of a folder;
///  - a folder: one DICOM series, or the images in it as slices, sorted by the numbers in their names;
///  - a pattern of slices with one printf number or with * and ?, e.g. "slice_%03d.tif": likewise;
///  - "builtin:NAME" (see `analytic_volumes.h`).
/// The format is told by content where it has a signature, by extension otherwise.
/// Throws Error naming the file and the reason: missing or unreadable file, truncated data, a header that contradicts
/// the data or itself, more voxels than `kMaxVoxels`, unevenly spaced slices, vector or 4-D data without a choice.
Volume load_volume(const std::string& path, const LoadOptions& options = {});

/// Whether .vti files can be read by this build (EDGESPLAT_VTK).
bool can_read_vti();

}  // namespace edgesplat
