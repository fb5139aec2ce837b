// What the format families share. Internal to engine/volume; nothing here is installed.
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

/// The type of a name such as "uint8"; false when there is none.
bool sample_type_named(std::string_view name, SampleType& type);
/// target[i] = source[first + i * stride] for i < count, in host byte order.
void convert_samples(SampleType type, const void* source, std::size_t first, std::size_t stride, std::size_t count,
                     float* target);

/// Fails when the volume, or all that must be read to get at it, is beyond the limits of load_volume.h. `dims` as the
/// file says, any number of axes; `bytes` of one voxel with all its components. Returns the bytes of all of it.
std::size_t checked_bytes(const std::string& path, const std::vector<std::size_t>& dims, std::size_t bytes);
/// Fails when `bytes` are more than reading one volume may take (load_volume.h); `what` of the file says so.
void check_memory(const std::string& path, std::string_view what, std::size_t bytes);
/// Of what is not compressed ("1 " may be a double), of deflate at its best, and more than compression of pictures is
/// seen to do.
inline constexpr std::size_t kPlainRatio = 8, kBestDeflateRatio = 1040, kBestPictureRatio = std::size_t{1} << 16;
/// Fails when `needed` bytes cannot come out of `stored` bytes even by that ratio, 4 kB of which are given.
void check_stored_size(const std::string& path, std::size_t needed, std::size_t stored,
                       std::size_t ratio = kBestDeflateRatio);

/// Fail with "truncated" when the structure of the file goes on after its end; files they do not understand pass.
void check_dicom_is_whole(const std::string& path);
/// Whether a file without DICOM's preamble begins as one with it goes on: with elements of group 2 or 8 in order.
bool begins_with_dicom_elements(const std::string& path);
void check_netcdf_is_whole(const std::string& path);

/// Which component and frame to take of those the file has; fails with how to choose where it is not said.
std::size_t chosen_component(const std::string& path, const LoadOptions& options, std::size_t count);
std::size_t chosen_frame(const std::string& path, const LoadOptions& options, std::size_t count);

/// Without white space at the ends.
std::string trimmed(const std::string& text);

void report(const LoadOptions& options, double fraction, std::string_view what);
/// Replaces the lengths of the axes by options.spacing, where given.
void apply_spacing(Volume& volume, const LoadOptions& options);
/// What a finished volume must say of values that are not as in the file.
void add_value_notes(Volume& volume);
/// A long message of a library on one line, without addresses of objects and source lines.
std::string tidy(std::string_view message);

/// A new folder in the system's place for temporary files, removed with all it holds.
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

/// While it lives, what the process writes to stdout and stderr is kept instead: the image libraries print their
/// troubles, some of which they do not report in any other way. One at a time; process-wide.
class OutputCapture {
  public:
    OutputCapture();
    ~OutputCapture();
    OutputCapture(const OutputCapture&) = delete;
    OutputCapture& operator=(const OutputCapture&) = delete;
    /// Everything so far.
    std::string text();

  private:
    int file_ = -1, saved_out_ = -1, saved_err_ = -1;
};

enum class ItkFormat { Nrrd, Meta, Nifti, Vtk, Minc, Gipl };
/// How a file is handed to ITK and what is said of it.
struct ItkRequest {
    ItkFormat format = ItkFormat::Nrrd;
    std::string path;                              ///< what the user gave: the name in messages
    std::string read_path;                         ///< what ITK opens; empty: `path`
    std::string stored_type;                       ///< empty: as ITK says
    std::size_t stored_bytes = 0;                  ///< size of the data on disk; 0: not to be checked
    std::size_t stored_ratio = kBestDeflateRatio;  ///< see check_stored_size
    /// Called with the bytes and samples that will be read, before they are; may throw.
    std::function<void(std::size_t bytes, std::size_t samples)> check_data;
    bool bits_are_floats = false;     ///< integers are the bit patterns of floats (see load_nifti.cpp)
    double slope = 1, intercept = 0;  ///< applied to those floats
};
Volume load_through_itk(const ItkRequest& request, const LoadOptions& options);
/// What the header says, without voxels: the type of a sample, or nothing where it is not one scalar volume.
std::optional<SampleType> describe_through_itk(const ItkRequest& request, Volume& description);

Volume load_nrrd(const std::string& path, const LoadOptions& options);
Volume load_nifti(const std::string& path, const LoadOptions& options);
Volume load_meta(const std::string& path, const LoadOptions& options);
Volume load_vti(const std::string& path, const LoadOptions& options);
/// "64x64x64:uint8:little[:sx,sy,sz[:skip]]": dims, type, byte order, spacing in mm, bytes before the first voxel.
Volume load_raw(const std::string& path, const LoadOptions& options);

/// Slices at ascending `heights` of at least two, the first at 0, as `count` >= 2 evenly spaced from the first to the
/// last.
std::vector<float> resampled_slices(const std::vector<float>& slices, const std::vector<double>& heights,
                                    std::size_t count);

bool is_dicom(const std::string& path);
Volume load_dicom(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options);

/// A zip archive of one file or of a folder's, with `load` for what comes out of it.
Volume load_archive(const std::string& path, const LoadOptions& options,
                    const std::function<Volume(const std::string&, const LoadOptions&)>& load);

bool is_image_file(const std::string& path);
/// Slices in this order; one file may hold a stack. `name` is what the user gave.
Volume load_images(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options);
/// Files of a folder sorted by the last number in their names; fails where a number is missing. Adds to `notes`.
std::vector<std::string> ordered_slices(const std::string& name, std::vector<std::string> files,
                                        std::vector<std::string>& notes);

}  // namespace edgesplat::detail
