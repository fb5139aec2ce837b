// Helpers that the readers of all formats share. Internal to engine/volume, not installed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/files/sample_type_internal.h"
#include "engine/volume/load_volume.h"

namespace edgesplat::detail {

/// Finds the type with a name such as "uint8"; returns false if there is none.
bool sample_type_named(std::string_view name, SampleType& type);
/// target[i] = source[first + i * stride] for i < count, in host byte order.
void convert_samples(SampleType type, const void* source, std::size_t first, std::size_t stride, std::size_t count,
                     float* target);

/// Fails if the volume, or all data that must be read for it, exceeds the limits of load_volume.h. `dims` as in the
/// file, any number of axes; `bytes` per voxel with all components. Returns the total bytes.
std::size_t checked_bytes(const std::string& path, const std::vector<std::size_t>& dims, std::size_t bytes);
/// Fails if `bytes` exceed the memory limit for reading (load_volume.h); `what` names the data in the message.
void check_memory(const std::string& path, std::string_view what, std::size_t bytes);
/// Maximum ratio of voxel bytes to stored bytes: uncompressed (the text "1 " may be a double), deflate at its best, and
/// a bound for image compression.
inline constexpr std::size_t kPlainRatio = 8, kBestDeflateRatio = 1040, kBestPictureRatio = std::size_t{1} << 16;
/// Fails if `needed` > `ratio` * `stored` + 4 kB: the file is too small for its voxels.
void check_stored_size(const std::string& path, std::size_t needed, std::size_t stored,
                       std::size_t ratio = kBestDeflateRatio);

/// Fails with "truncated" if the file's structure continues beyond its end. Files with unknown structure pass.
void check_netcdf_is_whole(const std::string& path);

/// The component and frame to read. Fails with the option to use if the file has several and none is chosen. `names`:
/// of the components, for that message.
std::size_t chosen_component(const std::string& path, const LoadOptions& options, std::size_t count,
                             const std::vector<std::string>& names = {});
std::size_t chosen_frame(const std::string& path, const LoadOptions& options, std::size_t count);

/// The text without white space at both ends.
std::string trimmed(const std::string& text);

void report(const LoadOptions& options, double fraction, std::string_view what);
/// Scales the axes to options.spacing, if given.
void apply_spacing(Volume& volume, const LoadOptions& options);
/// Adds notes about values of a finished volume that differ from the file.
void add_value_notes(Volume& volume);
/// Shortens a library's message to one line, without object addresses and source lines.
std::string tidy(std::string_view message);

/// Creates a folder in the system's temporary folder and removes it with its content.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Captures what the process writes to stdout and stderr while it exists. The image libraries print some errors that
/// they report in no other way. One at a time; process-wide.
class OutputCapture {
  public:
    OutputCapture();
    ~OutputCapture();
    OutputCapture(const OutputCapture&) = delete;
    OutputCapture& operator=(const OutputCapture&) = delete;
    /// Everything captured so far.
    std::string text();

  private:
    int file_ = -1, saved_out_ = -1, saved_err_ = -1;
};

Volume load_nrrd(const std::string& path, const LoadOptions& options);
/// The signature of NIfTI-1 or NIfTI-2, in a plain or gzip file. Analyze has none.
bool is_nifti(const std::string& path);
/// NIfTI-1, NIfTI-2, Analyze: also a pair .hdr and .img, by either name.
Volume load_nifti(const std::string& path, const LoadOptions& options);
/// FreeSurfer's .mgh and .mgz.
bool is_mgh(const std::string& path);
Volume load_mgh(const std::string& path, const LoadOptions& options);
/// MRC and CCP4 maps. Files of before the year 2000 have no signature.
bool is_mrc(const std::string& path);
Volume load_mrc(const std::string& path, const LoadOptions& options);
/// NumPy's .npy: samples without geometry.
bool is_npy(const std::string& path);
Volume load_npy(const std::string& path, const LoadOptions& options);
/// One array of a .npz: the one that options.inner names, or the only one.
Volume load_npz(const std::string& path, const LoadOptions& options);
Volume load_meta(const std::string& path, const LoadOptions& options);
Volume load_vtk_legacy(const std::string& path, const LoadOptions& options);
/// VTK's XML files of image data and of rectilinear grids with even coordinates; also their parallel forms.
Volume load_vtk_xml(const std::string& path, const LoadOptions& options);
/// Whether the file is a header of Voreen or Inviwo, or one of TU Wien's .dat files. `head`: its first bytes.
bool is_volume_dat(const std::string& path, std::string_view head);
Volume load_volume_dat(const std::string& path, const LoadOptions& options);
/// Whether the HDF5 file is a packed volume.
bool is_packed(const std::string& path);
/// Any other HDF5 file; `options.inner` names the array.
Volume load_hdf5(const std::string& path, const LoadOptions& options);
/// netCDF, classic or of version 4, without MINC; `options.inner` names the variable.
Volume load_netcdf(const std::string& path, const LoadOptions& options);
/// Whether an HDF5 file was written by netCDF.
bool is_netcdf4(const std::string& path);
/// MINC1 (netCDF) or MINC2 (HDF5).
bool is_minc(const std::string& path);
Volume load_minc(const std::string& path, const LoadOptions& options);
Volume load_gipl(const std::string& path, const LoadOptions& options);
/// "64x64x64:uint8:little[:sx,sy,sz[:skip]]": dims, type, byte order, spacing in mm, bytes before the first voxel.
Volume load_raw(const std::string& path, const LoadOptions& options);

/// Resamples slices at ascending `heights` (at least two, the first at 0) to `count` >= 2 evenly spaced slices from the
/// first to the last height.
std::vector<float> resampled_slices(const std::vector<float>& slices, const std::vector<double>& heights,
                                    std::size_t count);

/// Whether a file without DICOM preamble begins with DICOM elements: group 2 or 8, in order.
bool begins_with_dicom_elements(const std::string& path);
bool is_dicom(const std::string& path);
Volume load_dicom(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options);

/// What a file in an archive is: a volume, one that puts other files together, a slice, or something else, such as the
/// data file of a header.
enum class MemberKind { Volume, Parts, Dicom, Image, Other };
/// What reading an archive needs to know of the readers.
struct ArchiveLoader {
    std::function<MemberKind(const std::string& path)> kind;
    /// Reads an unpacked file, or a folder of slices. `files`: all unpacked files.
    std::function<Volume(const std::string& path, const std::vector<std::filesystem::path>& files,
                         const LoadOptions& options)>
        load;
};
/// Fails with what the file is if its content is that of no volume, whatever its name: a web page, a Git LFS pointer.
void refuse_foreign(const std::string& path, std::string_view head);
/// What a file is that no reader reads, and what to do with it; "" if this is unknown.
std::string foreign_kind(const std::string& path, std::string_view head);

/// Whether the file is a zip or tar archive, plain or compressed. `head`: its first bytes.
bool is_archive(const std::string& path, std::string_view head);
/// Whether the bytes begin as those of gzip, bzip2, xz, zstd, lz4 or compress.
bool is_compressed(std::string_view head);
/// Reads an archive of one volume, or the volume in it that options.inner names.
Volume load_archive(const std::string& path, const LoadOptions& options, const ArchiveLoader& loader);
/// Reads a compressed file.
Volume load_compressed(const std::string& path, const LoadOptions& options, const ArchiveLoader& loader);

/// The format of a file by signature or name, as messages call it; "images" by name alone; empty: unknown.
std::string format_of_file(const std::string& path);

bool is_image_file(const std::string& path);
/// Reads slices in this order; one file may contain a stack. `name` is the user's path.
Volume load_images(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options);
/// Sorts the files of a folder by the last number in their names; fails if a number is missing. Adds to `notes`.
std::vector<std::string> ordered_slices(const std::string& name, std::vector<std::string> files,
                                        std::vector<std::string>& notes);

}  // namespace edgesplat::detail
