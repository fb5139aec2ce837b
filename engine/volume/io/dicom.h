// DICOM: parts that the reader's sources share. Internal to engine/volume/io.
//   dicom_header.cpp        a file's elements, sequences included
//   dicom_kinds.cpp         what a file is, by its SOP class
//   dicom_frames.cpp        pictures of a file: place, scale and what tells them apart
//   dicom_series.cpp        series and stacks of a set of files, and the choice among them
//   dicom_stack.cpp         frames at places: duplicates, phases, order, gaps
//   dicom_pixels.cpp        stored samples; GDCM decodes compressed ones
//   dicom_segmentation.cpp  segmentation objects
//   dicom.cpp               from files to a volume
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/files/codec_library_internal.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

/// Group in the upper, element in the lower 16 bits.
using DicomTag = std::uint32_t;

struct DicomItem;

/// An element: its value's bytes as in the file, or its items.
struct DicomElement {
    DicomTag tag = 0;
    std::array<char, 2> vr{};  ///< value representation; zeros if the file does not say it
    bool big = false;          ///< big-endian
    bool fragmented = false;   ///< compressed pixels: `fragments` in place of `value`
    std::string_view value;
    std::vector<DicomItem> items;
    std::vector<std::string_view> fragments;
};

/// A data set: of a file, or an item of a sequence.
struct DicomItem {
    std::vector<DicomElement> elements;  ///< ascending by tag

    const DicomElement* find(DicomTag tag) const;
    /// The items of a sequence; empty if there is none.
    const std::vector<DicomItem>& items(DicomTag tag) const;
    /// The text without blanks and zeros at both ends; "" if there is none.
    std::string text(DicomTag tag) const;
    /// The numbers of an element, written as its value representation says, or as `otherwise` if the file does not say
    /// it ("DS": decimal text; "US", "SS", "UL", "SL", "FL", "FD"). Text that is no number becomes NaN.
    std::vector<double> numbers(DicomTag tag, std::string_view otherwise = "DS") const;
    /// The first number; nullopt if there is none.
    std::optional<double> number(DicomTag tag, std::string_view otherwise = "DS") const;
};

/// An opened file. Views into it are valid while it exists.
class DicomFile {
  public:
    /// Reads all elements. Throws Error if the file is truncated or no DICOM file.
    explicit DicomFile(const std::string& path);
    /// The same for bytes in memory, which must outlive it; `path` is for messages.
    DicomFile(const std::string& path, std::string_view bytes);
    ~DicomFile();
    DicomFile(const DicomFile&) = delete;
    DicomFile& operator=(const DicomFile&) = delete;

    const std::string& path() const { return path_; }
    const DicomItem& data() const { return data_; }
    const std::string& transfer_syntax() const { return syntax_; }
    std::size_t size() const { return bytes_.size(); }

  private:
    void read();

    std::string path_, syntax_;
    std::string_view bytes_;
    void* mapped_ = nullptr;
    std::string inflated_;
    DicomItem data_;
};

/// "an RT structure set (contours)"; empty if files of this class are pictures.
std::string dicom_kind_without_pictures(const DicomItem& data);
bool is_dicom_directory(const DicomItem& data);
bool is_dicom_segmentation(const DicomItem& data);
/// Files that a DICOMDIR lists. Adds a warning for those that are not there.
std::vector<std::string> files_of_dicom_directory(const std::string& path, std::vector<std::string>& warnings);

/// How pixels are stored.
struct DicomLayout : DicomPixelFormat {
    std::size_t frames = 1;
    bool is_float = false;

    std::size_t bits_per_frame() const { return columns * rows * samples * static_cast<std::size_t>(bits_allocated); }
    std::string stored_type() const;
};
/// Reads and checks the layout and that the pixels are complete. Throws Error.
DicomLayout dicom_layout(const DicomFile& file);

/// Stored samples of a file's frames.
class DicomPixels {
  public:
    DicomPixels(const DicomFile& file, const DicomLayout& layout);
    /// One component of a frame, columns * rows samples, as stored: integers from their stored bits, sign extended;
    /// YBR colours as red, green, blue.
    void read(std::size_t frame, std::size_t component, std::vector<double>& samples) const;
    /// The bytes of a frame as in the file, to compare frames.
    std::string frame_bytes(std::size_t frame) const;

  private:
    std::string decoded(std::size_t frame, DicomLayout& layout) const;

    const DicomFile& file_;
    const DicomLayout& layout_;
    const DicomElement* element_;
    std::vector<std::vector<std::string_view>> fragments_;  ///< of each frame
};

/// From stored samples to values.
struct DicomScale {
    double slope = 1, intercept = 0;
    std::shared_ptr<const std::vector<double>> table;  ///< modality LUT, in place of slope and intercept
    double table_first = 0;                            ///< stored sample of its first entry
    std::optional<glm::dvec2> padding;                 ///< stored samples without data, both ends included

    bool plain() const { return slope == 1 && intercept == 0 && !table && !padding; }
    bool operator==(const DicomScale&) const = default;
};

/// An attribute in which frames at one place may differ, and its value: "echo time (0018,0081)", "12.5".
struct DicomDistinction {
    int attribute = 0;  ///< index into dicom_attribute_name
    std::string value;
    bool operator==(const DicomDistinction&) const = default;
};
std::string_view dicom_attribute_name(int attribute);
/// How many attributes there are.
int dicom_attribute_count();
/// The attributes from here on are times and numbers that also differ from slice to slice.
int dicom_first_loose_attribute();

/// Where frames lie, and what a stack of them has in common.
struct DicomPlane {
    glm::dvec3 row{1, 0, 0}, column{0, 1, 0};  ///< unit directions of increasing column and row index
    glm::dvec2 spacing{1, 1};                  ///< mm along row and column
    std::string stack;                         ///< Stack ID

    glm::dvec3 normal() const { return glm::normalize(glm::cross(row, column)); }
};

/// A picture.
struct DicomFrame {
    std::size_t image = 0, index = 0;    ///< file, and frame in it
    glm::uvec2 corner{0};                ///< in a mosaic: its first pixel
    std::optional<glm::dvec3> position;  ///< mm, centre of the first pixel
    glm::dvec3 rounding{0};              ///< mm, units of the last decimals that the position is written with
    DicomPlane plane;
    DicomScale scale;
    bool says_scale = false;      ///< slope, intercept or table are written
    std::string unit;             ///< of values, as the file names it: RescaleType or Units
    double declared_spacing = 0;  ///< Spacing Between Slices, 0: none
    bool whole_spacing = false;   ///< it is written without decimals
    double thickness = 0;         ///< Slice Thickness, 0: none
    double instance = -1;         ///< Instance Number, -1: none
    std::vector<DicomDistinction> distinctions;
    int segment = 0;

    const std::string* distinction(int attribute) const;
};

/// A file's pictures.
struct DicomImage {
    std::string file, series, description, modality, instance_uid;
    std::string patient, frame_of_reference;  ///< empty: not given
    DicomLayout layout;
    std::size_t columns = 0, rows = 0;  ///< of a frame; smaller than the layout's in a mosaic
    std::vector<DicomFrame> frames;
    bool localizer = false;
    bool in_patient = true;
    bool spaced = true;  ///< the file says the spacing of its pixels
    std::string place;   ///< fields that define the frames' positions
    std::vector<std::string> notes, warnings;

    std::string name() const;  ///< the file's name without folder
    bool is_inverse() const { return layout.photometric == "MONOCHROME1"; }
};
/// Reads a file's frames. Throws Error. A file without pictures: an Error that names what it is.
DicomImage read_dicom_image(const DicomFile& file);

/// A set of frames, after the choice of series and stack.
struct DicomStack {
    std::vector<DicomFrame> frames;
    std::string note;  ///< the choice
};
/// Chooses a series and, if its frames differ in size, orientation, spacing or Stack ID, one of its stacks. Leaves out
/// localizers; warnings name them. Throws Error with a list of the choices.
DicomStack choose_dicom_series(const std::string& name, const std::vector<DicomImage>& images,
                               const LoadOptions& options, std::vector<std::string>& warnings);

/// Frames in the order of their positions, and the step between them.
struct DicomOrder {
    std::vector<DicomFrame> frames;
    glm::dvec3 step{0};           ///< from one slice to the next, mm
    std::vector<double> heights;  ///< of each slice along the normal, mm from the first; empty: evenly spaced
    std::size_t count = 0;        ///< slices after resampling
};
/// Leaves out exact duplicates, chooses among frames at the same places (--frame), sorts along the normal and checks
/// the spacing. All frames have positions. Throws Error.
DicomOrder order_dicom_frames(const std::string& name, const std::vector<DicomImage>& images,
                              std::vector<DicomFrame> frames, const LoadOptions& options, Volume& volume);
/// The same for frames without positions: a film, or pictures. Chooses one (--frame), or takes them for slices if
/// `options.spacing` is given.
DicomOrder order_dicom_pictures(const std::string& name, const std::vector<DicomImage>& images,
                                std::vector<DicomFrame> frames, const LoadOptions& options, Volume& volume);

/// Reads a segmentation object.
Volume load_dicom_segmentation(const std::string& name, const DicomFile& file, const LoadOptions& options);

}  // namespace edgesplat::detail
