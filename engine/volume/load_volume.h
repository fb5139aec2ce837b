// Loads volumes from files: one function for all formats; every failure is an Error.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Maximum number of voxels. More do not fit into 32-bit indices on the device or the memory of most hosts.
inline constexpr std::size_t kMaxVoxels = std::size_t{1} << 31;
/// Maximum number of voxels per axis.
inline constexpr std::size_t kMaxVoxelsPerAxis = 65535;

// Memory limit: the machine's memory, or the environment variable EDGESPLAT_READ_MEMORY in MiB. It covers the samples
// as stored, with all frames and components, plus 4 bytes a voxel. A file that needs more is refused before any
// allocation. A header is refused, too, if its voxels cannot come from the file: they need at most the stored bytes, or
// 1040 times as many for deflate (its best ratio).

/// Choices that a file may leave open. Every member has a value that means "not given".
struct LoadOptions {
    std::optional<int> component;  ///< component of a vector or colour voxel, from 0
    std::optional<int> frame;      ///< frame of 4-D data, from 0 (5-D and above: all further axes combined)
    std::optional<int> level;      ///< level of an OME-Zarr image, 0: the finest; not given: the finest that fits
    std::string series;            ///< series of a DICOM folder, image of a file, with several: number (from 0) or UID
    /// The part of the path after the colon: a name inside the file ("data.vti:density" gives "density"). `load_volume`
    /// sets it; callers leave it empty.
    std::string inner;
    std::string raw;                ///< layout of a raw file: "64x64x64:uint8:little[:sx,sy,sz[:skip]]", see `load_raw`
    bool resample = false;          ///< interpolates unevenly spaced DICOM slices at even positions
    std::optional<double> no_data;  ///< samples with this value contain no data
    std::optional<glm::dvec3> spacing;  ///< mm, replaces the file's spacing along i, j, k; directions are kept
    /// Progress callback with a fraction in [0, 1] and the current step. Called on the loading thread only.
    std::function<void(double fraction, std::string_view what)> progress;
};

/// A path and the name of something inside that file; `inner` is empty if there is none.
struct InnerPath {
    std::string file, inner;
};
/// Splits "scan.zip:head/ct.nrrd" into the file and the name inside. A path that exists is not split. Otherwise the
/// file is the longest part before a colon that exists; a path without such a part is not split either.
InnerPath split_inner(const std::string& path);

/// Reads a volume and finishes it (see `finish_volume`). `path` is one of
///  - a file: NRRD, MetaImage, NIfTI-1/2, Analyze, DICOM, MINC, MGH, MRC and CCP4 maps, NumPy, VTK image data (legacy
///    and XML), HDF5, netCDF, GIPL, Voreen and Inviwo .dat, a TIFF stack (plain, ImageJ, OME, LSM), VolPack .den with
///    --raw, or any file with `options.raw`;
///  - a packed volume (packed_volume.h), whose samples stay in the file and which has its own limits;
///  - an OME-Zarr image or Zarr array: a folder or a zip archive;
///  - an archive (zip, tar, compressed tar) of one such file, or of the files of a folder, or a compressed file;
///  - "FILE:NAME", something inside a file (see `split_inner`): an array, or a file in an archive;
///  - a folder: one DICOM series, or the images in it as slices, sorted by the numbers in their names;
///  - a pattern of slices with one printf number or with * and ?, e.g. "slice_%03d.tif";
///  - "builtin:NAME" (see `analytic_volumes.h`).
/// The format is detected by its signature, or by the extension if it has none.
/// Throws Error naming the file and the reason: missing or unreadable file, truncated data, a header that contradicts
/// the data or itself, more voxels than `kMaxVoxels`, unevenly spaced slices, vector or 4-D data without a chosen
/// component or frame.
Volume load_volume(const std::string& path, const LoadOptions& options = {});

}  // namespace edgesplat
