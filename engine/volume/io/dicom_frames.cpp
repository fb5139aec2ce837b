// Pictures of a DICOM file: their places, scales and what tells them apart. Functional groups of a frame come first,
// then the shared ones, then the attributes of the whole file.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

constexpr DicomTag kDicomSharedGroups = 0x52009229, kDicomFrameGroups = 0x52009230;

struct DicomAttribute {
    DicomTag group;  ///< functional group, 0: none
    DicomTag tag;
    std::string_view vr;  ///< "": text
    std::string_view name;
};

// In the order in which they are preferred to tell frames apart.
constexpr std::array kDicomAttributes{
    DicomAttribute{0x00209111, 0x00209128, "UL", "temporal position index (0020,9128)"},
    DicomAttribute{0x00209310, 0x0020930d, "FD", "time offset of the temporal position (0020,930d)"},
    DicomAttribute{0, 0x00200100, "IS", "temporal position (0020,0100)"},
    DicomAttribute{0x00189118, 0x00209241, "FD", "cardiac phase in percent (0020,9241)"},
    DicomAttribute{0x00189118, 0x00209153, "FD", "cardiac trigger delay (0020,9153)"},
    DicomAttribute{0, 0x00181060, "DS", "trigger time (0018,1060)"},
    DicomAttribute{0x00209253, 0x00209245, "FD", "respiratory phase in percent (0020,9245)"},
    DicomAttribute{0x00209253, 0x00209255, "FD", "respiratory trigger delay (0020,9255)"},
    DicomAttribute{0x00189114, 0x00189082, "FD", "echo time (0018,9082)"},
    DicomAttribute{0, 0x00180081, "DS", "echo time (0018,0081)"},
    DicomAttribute{0, 0x00180086, "IS", "echo number (0018,0086)"},
    DicomAttribute{0x00189117, 0x00189087, "FD", "b-value (0018,9087)"},
    DicomAttribute{0, 0x0019100c, "IS", "b-value (0019,100c)"},
    DicomAttribute{0, 0x00431039, "IS", "b-value (0043,1039)"},
    DicomAttribute{0, 0x20011003, "FL", "b-value (2001,1003)"},
    DicomAttribute{0x00189117, 0x00189089, "FD", "gradient direction (0018,9089)"},
    DicomAttribute{0x00189117, 0x00189075, "", "diffusion directionality (0018,9075)"},
    DicomAttribute{0x00189197, 0x00189090, "FD", "velocity encoding direction (0018,9090)"},
    DicomAttribute{0x00189197, 0x00189217, "FD", "maximum of the velocity encoding (0018,9217)"},
    DicomAttribute{0x00189251, 0x00189257, "", "arterial spin labelling (0018,9257)"},
    DicomAttribute{0x00189115, 0x00189079, "FD", "inversion time (0018,9079)"},
    DicomAttribute{0, 0x00180082, "DS", "inversion time (0018,0082)"},
    DicomAttribute{0x00189112, 0x00181314, "DS", "flip angle (0018,1314)"},
    DicomAttribute{0x00189112, 0x00180080, "DS", "repetition time (0018,0080)"},
    DicomAttribute{0x00189325, 0x00180060, "DS", "tube voltage (0018,0060)"},
    DicomAttribute{0x00189341, 0x00189342, "", "contrast agent administered (0018,9342)"},
    DicomAttribute{0x00189341, 0x00189343, "", "contrast agent detected (0018,9343)"},
    DicomAttribute{0x00189341, 0x00189344, "", "contrast phase (0018,9344)"},
    DicomAttribute{0x00189807, 0x00189808, "", "data type (0018,9808)"},
    DicomAttribute{0x00189226, 0x00089208, "", "complex image component (0008,9208)"},
    DicomAttribute{0x00189226, 0x00089007, "", "frame type (0008,9007)"},
    DicomAttribute{0x00189329, 0x00089007, "", "frame type (0008,9007)"},
    DicomAttribute{0x00189751, 0x00089007, "", "frame type (0008,9007)"},
    DicomAttribute{0, 0x00080008, "", "image type (0008,0008)"},
    DicomAttribute{0x00189314, 0x00181210, "", "convolution kernel (0018,1210)"},
    DicomAttribute{0, 0x00540010, "US", "energy window (0054,0010)"},
    DicomAttribute{0, 0x00540060, "US", "gated interval (0054,0060)"},
    DicomAttribute{0, 0x00540070, "US", "time slot (0054,0070)"},
    DicomAttribute{0, 0x00540020, "US", "detector (0054,0020)"},
    DicomAttribute{0, 0x00540030, "US", "phase (0054,0030)"},
    DicomAttribute{0x00209111, 0x00209056, "", "stack (0020,9056)"},
    DicomAttribute{0x00209111, 0x00209157, "UL", "first dimension index (0020,9157)"},
    DicomAttribute{0x00209111, 0x00209157, "UL", "second dimension index (0020,9157)"},
    DicomAttribute{0x00209111, 0x00209157, "UL", "third dimension index (0020,9157)"},
    DicomAttribute{0x00209111, 0x00209157, "UL", "fourth dimension index (0020,9157)"},
    DicomAttribute{0x00209111, 0x00209156, "US", "frame acquisition number (0020,9156)"},
    DicomAttribute{0, 0x00200012, "IS", "acquisition number (0020,0012)"},
    // Loose: they also differ from slice to slice.
    DicomAttribute{0x00209111, 0x00189151, "", "frame reference date and time (0018,9151)"},
    DicomAttribute{0, 0x00541300, "DS", "frame reference time (0054,1300)"},
    DicomAttribute{0x00209111, 0x00189074, "", "frame acquisition date and time (0018,9074)"},
    DicomAttribute{0, 0x0008002a, "", "acquisition date and time (0008,002a)"},
    DicomAttribute{0, 0x00080032, "", "acquisition time (0008,0032)"},
    DicomAttribute{0, 0x00080033, "", "content time (0008,0033)"},
    DicomAttribute{0, 0x00200013, "IS", "instance number (0020,0013)"},
};
constexpr int kFirstLooseAttribute = 47;
static_assert(kDicomAttributes[kFirstLooseAttribute].tag == 0x00189151);

/// The numbers of a vector of a nuclear medicine file, one a frame.
bool is_frame_vector(DicomTag tag) {
    return tag == 0x00540010 || tag == 0x00540060 || tag == 0x00540070 || tag == 0x00540020 || tag == 0x00540030;
}

/// A frame's attributes.
struct DicomGroups {
    const DicomItem& file;
    const DicomItem* shared = nullptr;
    const DicomItem* own = nullptr;

    /// The data set that has an attribute: an item of a functional group, or the file; nullptr if none has.
    const DicomItem* with(DicomTag group, DicomTag tag) const {
        for (const DicomItem* groups : {own, shared}) {
            if (groups == nullptr || group == 0) continue;
            const auto& items = groups->items(group);
            if (!items.empty() && items.front().find(tag) != nullptr) return &items.front();
        }
        return file.find(tag) != nullptr ? &file : nullptr;
    }
};

std::string numbers_as_text(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers)
        text += fmt::format("{}{}", text.empty() ? "" : "\\", number + 0.0);
    return text;
}

/// The unit of the last decimal of each number in a text like "1.25\-3\4.5e1".
glm::dvec3 written_units(const std::string& text) {
    glm::dvec3 units(0);
    std::size_t at = 0;
    for (int axis = 0; axis < 3 && at <= text.size(); ++axis) {
        const std::size_t end = std::min(text.find('\\', at), text.size());
        const std::string part = text.substr(at, end - at);
        const std::size_t exponent_at = std::min(part.find_first_of("eE"), part.size());
        const std::size_t point = part.find('.');
        const double decimals =
            point == std::string::npos || point > exponent_at ? 0 : static_cast<double>(exponent_at - point - 1);
        const double exponent = exponent_at < part.size() ? std::strtod(part.c_str() + exponent_at + 1, nullptr) : 0;
        units[axis] = std::pow(10.0, exponent - decimals);
        at = end + 1;
    }
    return units;
}

/// Reads the frames of one file.
struct DicomImageReader {
    const DicomFile& file;
    const DicomItem& data;
    DicomImage& image;

    [[noreturn]] void refuse(std::string_view field, const std::string& text, std::string_view wanted) const {
        fail("{}: {} is '{}', expected {}", file.path(), field, text, wanted);
    }

    std::vector<double> finite_numbers(const DicomItem& item, DicomTag tag, std::string_view vr, std::size_t count,
                                       std::string_view field) const {
        auto numbers = item.numbers(tag, vr);
        if (numbers.empty()) return numbers;
        if (numbers.size() != count || !std::ranges::all_of(numbers, [](double n) { return std::isfinite(n); }))
            refuse(field, item.text(tag), fmt::format("{} finite number{}", count, count == 1 ? "" : "s"));
        return numbers;
    }

    /// Spacing of pixels: in the order rows, columns.
    void read_spacing(const DicomGroups& groups, DicomFrame& frame) const {
        struct Field {
            DicomTag tag;
            std::string_view name, note;
        };
        static constexpr std::array kFields{
            Field{0x00280030, "PixelSpacing (0028,0030)", ""},
            Field{0x00181164, "ImagerPixelSpacing (0018,1164)",
                  "The spacing of pixels is that at the detector (0018,1164), not in the patient."},
            Field{0x00182010, "NominalScannedPixelSpacing (0018,2010)", ""},
        };
        bool found = false;
        for (const Field& field : kFields) {
            const DicomItem* item = groups.with(field.tag == 0x00280030 ? 0x00289110 : 0, field.tag);
            if (item == nullptr || found) continue;
            const auto numbers = finite_numbers(*item, field.tag, "DS", 2, field.name);
            if (numbers.empty()) continue;
            if (!(numbers[0] > 0) || !(numbers[1] > 0))
                refuse(field.name, item->text(field.tag), "two lengths in mm above 0");
            frame.plane.spacing = {numbers[1], numbers[0]};
            if (!field.note.empty()) note(std::string(field.note));
            found = true;
        }
        if (!found) {
            image.spaced = false;
            const auto ratio = finite_numbers(data, 0x00280034, "IS", 2, "PixelAspectRatio (0028,0034)");
            if (ratio.size() == 2) {
                if (!(ratio[0] > 0) || !(ratio[1] > 0))
                    refuse("PixelAspectRatio (0028,0034)", data.text(0x00280034), "two numbers above 0");
                frame.plane.spacing = {1, ratio[0] / ratio[1]};
            }
        }
        if (const DicomItem* item = groups.with(0x00289110, 0x00180088)) {
            const auto numbers = finite_numbers(*item, 0x00180088, "DS", 1, "SpacingBetweenSlices (0018,0088)");
            frame.declared_spacing = numbers.empty() ? 0 : numbers[0];
            frame.whole_spacing = item->text(0x00180088).find('.') == std::string::npos;
        }
        if (const DicomItem* item = groups.with(0x00289110, 0x00180050)) {
            const auto thickness = item->number(0x00180050);
            if (thickness && *thickness > 0 && std::isfinite(*thickness)) frame.thickness = *thickness;
        }
    }

    void note(std::string text) const {
        if (std::ranges::find(image.notes, text) == image.notes.end()) image.notes.push_back(std::move(text));
    }
    void warn(std::string text) const {
        if (std::ranges::find(image.warnings, text) == image.warnings.end()) image.warnings.push_back(std::move(text));
    }

    static glm::dvec3 three(const std::vector<double>& numbers, std::size_t first) {
        return {numbers[first], numbers[first + 1], numbers[first + 2]};
    }

    /// Position and directions. Nuclear medicine has them per detector.
    void read_place(const DicomGroups& groups, DicomFrame& frame) const {
        const DicomItem* position = groups.with(0x00209113, 0x00200032);
        const DicomItem* orientation = groups.with(0x00209116, 0x00200037);
        DicomTag position_tag = 0x00200032, orientation_tag = 0x00200037;
        std::string_view vr = "DS";
        if (position == nullptr && orientation == nullptr) {
            const auto& detectors = data.items(0x00540022);
            const std::string* number = frame.distinction(attribute_of(0x00540020));
            const double at = number == nullptr ? 1 : std::strtod(number->c_str(), nullptr);
            if (at >= 1 && at <= static_cast<double>(detectors.size())) {
                const DicomItem& detector = detectors[static_cast<std::size_t>(at) - 1];
                if (detector.find(position_tag) != nullptr) position = &detector;
                if (detector.find(orientation_tag) != nullptr) orientation = &detector;
            }
        }
        if (position == nullptr && orientation == nullptr) {
            // Ultrasound volumes have places in the frame of reference of their volume.
            position = groups.with(0x0020930e, position_tag = 0x00209301);
            orientation = groups.with(0x0020930f, orientation_tag = 0x00209302);
            vr = "FD";
            if (position != nullptr) image.in_patient = false;
        }
        if (orientation != nullptr) {
            const std::string_view field = orientation_tag == 0x00200037 ? "ImageOrientationPatient (0020,0037)"
                                                                         : "ImageOrientationVolume (0020,9302)";
            const auto numbers = finite_numbers(*orientation, orientation_tag, vr, 6, field);
            if (numbers.empty()) {
                orientation = nullptr;
            } else {
                glm::dvec3 row = three(numbers, 0), column = three(numbers, 3);
                const double a = glm::length(row), b = glm::length(column);
                // Directions are written with few decimals.
                if (!(std::abs(a - 1) < 0.01) || !(std::abs(b - 1) < 0.01) || !(std::abs(glm::dot(row, column)) < 0.01))
                    refuse(field, numbers_as_text(numbers), "two perpendicular directions of length 1");
                frame.plane.row = row / a;
                frame.plane.column = column / b;
            }
        }
        if (position != nullptr) {
            const auto numbers = finite_numbers(
                *position, position_tag, vr, 3,
                position_tag == 0x00200032 ? "ImagePositionPatient (0020,0032)" : "ImagePositionVolume (0020,9301)");
            if (!numbers.empty()) {
                frame.position = three(numbers, 0);
                if (vr == "DS") {
                    const auto& element = *position->find(position_tag);
                    if (std::string_view(element.vr.data(), 2) != "FD")
                        frame.rounding = written_units(position->text(position_tag));
                }
            }
        }
        if (frame.position && orientation == nullptr)
            warn(
                fmt::format("{}: no ImageOrientationPatient (0020,0037): rows are taken to run to the patient's left "
                            "and columns to the back.",
                            image.name()));
    }

    static int attribute_of(DicomTag tag) {
        return static_cast<int>(std::ranges::find(kDicomAttributes, tag, &DicomAttribute::tag) -
                                kDicomAttributes.begin());
    }

    void read_distinctions(const DicomGroups& groups, DicomFrame& frame) const {
        std::size_t dimension = 0;
        for (std::size_t i = 0; i < kDicomAttributes.size(); ++i) {
            const DicomAttribute& attribute = kDicomAttributes[i];
            std::string value;
            if (is_frame_vector(attribute.tag)) {
                const auto numbers = data.numbers(attribute.tag, attribute.vr);
                if (numbers.size() == image.layout.frames) value = fmt::format("{}", numbers[frame.index]);
            } else if (attribute.tag == 0x00189089) {
                // In a sequence of its own.
                const DicomItem* item = groups.with(0x00189117, 0x00189076);
                if (item != nullptr && !item->items(0x00189076).empty())
                    item = &item->items(0x00189076).front();
                else
                    item = groups.with(0x00189117, attribute.tag);
                if (item != nullptr) value = numbers_as_text(item->numbers(attribute.tag, attribute.vr));
            } else if (const DicomItem* item = groups.with(attribute.group, attribute.tag)) {
                auto numbers =
                    attribute.vr.empty() ? std::vector<double>{} : item->numbers(attribute.tag, attribute.vr);
                if (attribute.tag == 0x00431039 && !numbers.empty())
                    numbers = {std::fmod(numbers[0], 1e6)};  // GE adds 1e9 to some
                if (attribute.tag == 0x00209157) {
                    const std::size_t own = dimension++;
                    numbers = own < numbers.size() ? std::vector{numbers[own]} : std::vector<double>{};
                }
                value = attribute.vr.empty() ? item->text(attribute.tag) : numbers_as_text(numbers);
            }
            if (!value.empty()) frame.distinctions.push_back({static_cast<int>(i), std::move(value)});
        }
    }

    /// What says how stored samples become values, and their unit.
    static void read_unit(const DicomGroups& groups, DicomFrame& frame) {
        for (const DicomTag tag : {0x00281053U, 0x00281052U})
            if (const DicomItem* item = groups.with(0x00289145, tag))
                frame.says_scale = frame.says_scale || !item->text(tag).empty();
        frame.says_scale = frame.says_scale || !groups.file.items(0x00283000).empty();
        if (const DicomItem* item = groups.with(0x00289145, 0x00281054)) frame.unit = item->text(0x00281054);
        if (frame.unit.empty()) frame.unit = groups.file.text(0x00541001);
    }

    /// Slope and intercept, or the modality LUT, and the samples without data.
    DicomScale read_scale(const DicomGroups& groups) const {
        DicomScale scale;
        if (const auto dose = data.number(0x3004000e)) {
            if (!std::isfinite(*dose) || !(*dose > 0))
                refuse("DoseGridScaling (3004,000e)", data.text(0x3004000e), "a number above 0");
            scale.slope = *dose;
            return scale;
        }
        if (image.layout.samples > 1) return scale;
        const DicomItem* slope = groups.with(0x00289145, 0x00281053);
        const DicomItem* intercept = groups.with(0x00289145, 0x00281052);
        if (slope != nullptr) {
            const auto numbers = finite_numbers(*slope, 0x00281053, "DS", 1, "RescaleSlope (0028,1053)");
            if (!numbers.empty()) scale.slope = numbers[0];
            if (scale.slope == 0) refuse("RescaleSlope (0028,1053)", slope->text(0x00281053), "a number other than 0");
        }
        if (intercept != nullptr) {
            const auto numbers = finite_numbers(*intercept, 0x00281052, "DS", 1, "RescaleIntercept (0028,1052)");
            if (!numbers.empty()) scale.intercept = numbers[0];
        }
        if (const auto& luts = data.items(0x00283000); !luts.empty() && slope == nullptr && intercept == nullptr)
            read_table(luts.front(), scale);
        read_padding(scale);
        return scale;
    }

    void read_table(const DicomItem& lut, DicomScale& scale) const {
        const auto descriptor = lut.numbers(0x00283002, "US");
        if (descriptor.size() != 3) refuse("the descriptor (0028,3002) of its modality LUT", "", "3 numbers");
        const auto count = static_cast<std::size_t>(descriptor[0] == 0 ? 65536 : descriptor[0]);
        auto table = std::make_shared<std::vector<double>>();
        const DicomElement* element = lut.find(0x00283006);
        const std::size_t stored = element == nullptr ? 0 : element->value.size();
        const bool bytes = descriptor[2] <= 8 && stored < 2 * count;
        if (bytes && stored >= count)
            for (std::size_t i = 0; i < count; ++i)
                table->push_back(static_cast<unsigned char>(element->value[i]));
        else
            *table = lut.numbers(0x00283006, "US");
        if (table->size() < count)
            fail("{}: its modality LUT (0028,3006) has {} entries where its descriptor says {}", file.path(),
                 table->size(), count);
        table->resize(count);
        scale.table = std::move(table);
        scale.table_first = image.layout.is_signed && descriptor[1] > 32767 ? descriptor[1] - 65536 : descriptor[1];
        note("Values come from the modality LUT (0028,3000).");
    }

    /// A stored sample as the pixels' own type reads it.
    double as_stored(double value) const {
        const auto& layout = image.layout;
        if (layout.is_float) return value;
        const auto bits = static_cast<unsigned>(std::min(layout.bits_stored, 32));
        const auto mask = (std::uint64_t{1} << bits) - 1;
        const auto raw = static_cast<std::uint64_t>(static_cast<std::int64_t>(value)) & mask;
        const bool negative = layout.is_signed && (raw >> (bits - 1) & 1U) != 0;
        return static_cast<double>(raw) - (negative ? static_cast<double>(mask) + 1 : 0);
    }

    void read_padding(DicomScale& scale) const {
        const bool is_float = image.layout.is_float;
        const auto vr = image.layout.is_signed ? "SS" : "US";
        const auto value = is_float ? data.number(image.layout.bits_allocated == 64 ? 0x00280123 : 0x00280122,
                                                  image.layout.bits_allocated == 64 ? "FD" : "FL")
                                    : data.number(0x00280120, vr);
        if (!value || (!is_float && !(std::abs(*value) < 4294967296.0))) return;
        const auto limit = is_float ? data.number(image.layout.bits_allocated == 64 ? 0x00280125 : 0x00280124,
                                                  image.layout.bits_allocated == 64 ? "FD" : "FL")
                                    : data.number(0x00280121, vr);
        // A value that the pixels cannot have declares nothing.
        const auto fits = [&](double n) {
            const double all = std::ldexp(1.0, image.layout.bits_stored);
            return is_float || (n >= -all / 2 && n < std::max(all, 65536.0));
        };
        if (!fits(*value)) return;
        const double a = as_stored(*value), b = limit && fits(*limit) ? as_stored(*limit) : a;
        scale.padding = glm::dvec2(std::min(a, b), std::max(a, b));
    }

    void note_values() const {
        if (image.modality == "RTDOSE" || data.find(0x3004000e) != nullptr) {
            const std::string unit = data.text(0x30040002);
            if (data.find(0x3004000e) == nullptr)
                warn(fmt::format("{}: no DoseGridScaling (3004,000e): the values are stored numbers, not a dose.",
                                 image.name()));
            else
                note(fmt::format("Values are a dose in {}: stored numbers times DoseGridScaling (3004,000e).",
                                 unit == "GY"   ? "Gy"
                                 : unit.empty() ? "a unit that the file does not say"
                                                : unit));
        }
        if (image.modality == "PT" && !data.text(0x00541001).empty())
            note(
                fmt::format("Values are in {} (0054,1001), after each slice's slope and intercept; no SUV is computed.",
                            data.text(0x00541001)));
        if (image.layout.photometric == "MONOCHROME1")
            note("MONOCHROME1: the file shows large values dark; the values are kept.");
        if (image.layout.photometric == "PALETTE COLOR") note("Palette colours: the values are indices of colours.");
        if (image.layout.photometric.starts_with("YBR"))
            note(fmt::format("{}: components are red, green and blue.", image.layout.photometric));
        const DicomItem* mapping = nullptr;
        for (const DicomTag groups : {kDicomSharedGroups, kDicomFrameGroups})
            if (const auto& items = data.items(groups); !items.empty() && !items.front().items(0x00409096).empty())
                mapping = &items.front().items(0x00409096).front();
        if (const auto& items = data.items(0x00409096); !items.empty()) mapping = &items.front();
        if (mapping != nullptr) {
            const auto& units = mapping->items(0x004008ea);
            note(fmt::format(
                "A mapping to real world values (0040,9096) is not applied: slope {}, intercept {}, unit {}.",
                mapping->number(0x00409225, "FD").value_or(1), mapping->number(0x00409224, "FD").value_or(0),
                units.empty() ? "none" : units.front().text(0x00080100)));
        }
    }

    // -----------------------------------------------------------------------------------------------------------------
    // Frames whose places are not written one by one.

    void offset_frames(const std::vector<double>& heights, std::string_view place) const {
        const auto normal = image.frames.front().plane.normal();
        const auto origin = *image.frames.front().position;
        for (std::size_t i = 0; i < image.frames.size(); ++i)
            image.frames[i].position = origin + normal * heights[i];
        image.place = place;
    }

    /// Grid Frame Offset Vector: from the first plane if it begins with 0, else z in the patient.
    void place_dose() const {
        constexpr std::string_view kField = "GridFrameOffsetVector (3004,000c)";
        auto offsets = data.numbers(0x3004000c);
        if (offsets.size() != image.frames.size())
            fail("{}: {} has {} numbers for {} frames", file.path(), kField, offsets.size(), image.frames.size());
        if (!std::ranges::all_of(offsets, [](double n) { return std::isfinite(n); }))
            refuse(kField, data.text(0x3004000c), "finite numbers");
        const glm::dvec3 origin = *image.frames.front().position, normal = image.frames.front().plane.normal();
        if (offsets[0] != 0) {
            if (!(std::abs(offsets[0] - origin.z) < 0.01) || !(std::abs(normal.z) > 0.9999))
                fail(
                    "{}: {} begins with {}, expected 0, or the z of ImagePositionPatient (0020,0032), {}, for axial "
                    "planes",
                    file.path(), kField, offsets[0], origin.z);
            for (double& offset : offsets)
                offset = (offset - origin.z) / normal.z;
        }
        offset_frames(offsets, "GridFrameOffsetVector");
        for (DicomFrame& frame : image.frames)
            frame.rounding = glm::dvec3(0);
    }

    /// Frames of a file with one position: slices one after another, unless time passes from frame to frame.
    void place_by_spacing() const {
        auto& frames = image.frames;
        const auto pointers = data.find(0x00280009);
        std::vector<DicomTag> steps;
        if (pointers != nullptr) {
            const auto halves = data.numbers(0x00280009, "US");  // AT: pairs of group and element
            for (std::size_t i = 0; i + 1 < halves.size(); i += 2)
                steps.push_back(static_cast<DicomTag>(halves[i]) << 16U | static_cast<DicomTag>(halves[i + 1]));
        }
        const auto steps_by = [&](DicomTag tag) { return std::ranges::find(steps, tag) != steps.end(); };
        const double spacing = frames.front().declared_spacing;
        if (steps_by(0x3004000c) || data.find(0x3004000c) != nullptr) return place_dose();
        const auto heights = data.numbers(0x00182005);
        if (steps_by(0x00182005) && heights.size() == frames.size()) {
            std::vector<double> offsets;
            for (const double height : heights)
                offsets.push_back(height - heights[0]);
            if (std::ranges::all_of(offsets, [](double n) { return std::isfinite(n); }))
                return offset_frames(offsets, "position (0020,0032) and slice location vector (0018,2005)");
        }
        const auto slices = data.numbers(0x00540080, "US");
        const bool reconstructed = data.text(0x00080008).find("RECON") != std::string::npos;
        const bool nuclear = steps_by(0x00540080) && slices.size() == frames.size() && reconstructed;
        const bool film =
            steps_by(0x00181063) || steps_by(0x00181065) || (!steps.empty() && steps_by(0x00540080) && !nuclear);
        if (film || spacing == 0) {
            for (DicomFrame& frame : frames)
                frame.position.reset();
            return;
        }
        std::vector<double> offsets;
        for (std::size_t i = 0; i < frames.size(); ++i)
            offsets.push_back(spacing * (nuclear ? slices[i] - 1 : static_cast<double>(i)));
        offset_frames(offsets, "position (0020,0032) of the first frame and spacing tag (0018,0088)");
        for (DicomFrame& frame : frames)
            frame.rounding = glm::dvec3(0);
    }

    // -----------------------------------------------------------------------------------------------------------------
    // Mosaics of Siemens: the slices of a volume side by side in one picture.

    /// The first number of an element of the CSA header, format 2; empty if it is not there.
    std::vector<double> csa_numbers(std::string_view name) const {
        std::vector<double> out;
        const DicomElement* element = data.find(0x00291010);
        if (element == nullptr) return out;
        const std::string_view csa = element->value;
        const auto integer = [&](std::size_t at) -> std::size_t {
            if (at + 4 > csa.size()) return 0;
            std::uint32_t value = 0;
            for (unsigned i = 0; i < 4; ++i)
                value |= static_cast<std::uint32_t>(static_cast<unsigned char>(csa[at + i])) << (8 * i);
            return value;
        };
        if (!csa.starts_with("SV10")) return out;
        std::size_t at = 16;
        for (std::size_t left = std::min<std::size_t>(integer(8), 1024); left > 0 && at + 84 <= csa.size(); --left) {
            const bool wanted = csa.substr(at, 64).starts_with(name) && csa[at + name.size()] == '\0';
            std::size_t items = std::min<std::size_t>(integer(at + 76), 1024);
            at += 84;
            for (; items > 0 && at + 16 <= csa.size(); --items) {
                const std::size_t size = integer(at + 4);
                at += 16;
                if (size > csa.size() - at) return out;
                if (wanted && size > 0) out.push_back(std::strtod(std::string(csa.substr(at, size)).c_str(), nullptr));
                at += (size + 3) / 4 * 4;
                if (at > csa.size()) return out;
            }
            if (wanted) return out;
        }
        return out;
    }

    void split_mosaic() const {
        auto count = data.number(0x0019100a, "US");
        if (!count) {
            const auto numbers = csa_numbers("NumberOfImagesInMosaic");
            if (!numbers.empty()) count = numbers[0];
        }
        if (!count || !(*count >= 1) || !(*count <= 4096) || *count != std::floor(*count))
            fail(
                "{}: a mosaic of slices in one picture, whose number of slices (0019,100a) is not known; convert it "
                "with dcm2niix",
                file.path());
        const auto slices = static_cast<std::size_t>(*count);
        const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(*count)));
        const auto normal_numbers = csa_numbers("SliceNormalVector");
        DicomFrame first = image.frames.front();
        if (image.frames.size() != 1 || image.columns % across != 0 || image.rows % across != 0 ||
            normal_numbers.size() < 3 || !first.position || !(first.declared_spacing > 0))
            fail(
                "{}: a mosaic of {} slices in one picture, whose place cannot be read (SliceNormalVector in "
                "(0029,1010), SpacingBetweenSlices (0018,0088), {} x {} pixels); convert it with dcm2niix",
                file.path(), slices, image.columns, image.rows);
        const glm::dvec3 wanted = three(normal_numbers, 0), normal = first.plane.normal();
        if (!(std::abs(std::abs(glm::dot(wanted, normal)) - 1) < 1e-2))
            fail(
                "{}: the slice normal of its mosaic (0029,1010) is not perpendicular to ImageOrientationPatient "
                "(0020,0037)",
                file.path());
        const double sign = glm::dot(wanted, normal) > 0 ? 1 : -1;
        const std::size_t columns = image.columns / across, rows = image.rows / across;
        // The position is that of a single picture as large as the mosaic with the same centre.
        const glm::dvec3 origin =
            *first.position +
            first.plane.row * (first.plane.spacing.x * static_cast<double>(image.columns - columns) / 2) +
            first.plane.column * (first.plane.spacing.y * static_cast<double>(image.rows - rows) / 2);
        image.columns = columns;
        image.rows = rows;
        image.frames.clear();
        for (std::size_t i = 0; i < slices; ++i) {
            DicomFrame frame = first;
            frame.corner = glm::uvec2(i % across * columns, i / across * rows);
            frame.position = origin + normal * (sign * first.declared_spacing * static_cast<double>(i));
            frame.rounding = glm::dvec3(0);
            image.frames.push_back(std::move(frame));
        }
        image.place = "mosaic: position (0020,0032), slice normal (0029,1010), spacing tag (0018,0088)";
        note(fmt::format("A mosaic: {} slices of {} x {} pixels in one picture.", slices, columns, rows));
    }

    void read() const {
        image.file = file.path();
        image.series = data.text(0x0020000e);
        image.description = data.text(0x0008103e);
        image.modality = data.text(0x00080060);
        image.instance_uid = data.text(0x00080018);
        image.patient = data.text(0x00100020);
        image.frame_of_reference = data.text(0x00200052);
        const std::string kind = dicom_kind_without_pictures(data);
        if (!kind.empty()) fail("{}: {}, which is no volume", file.path(), kind);
        image.layout = dicom_layout(file);
        image.columns = image.layout.columns;
        image.rows = image.layout.rows;
        const std::string type = data.text(0x00080008);
        image.localizer = type.find("LOCALIZER") != std::string::npos;

        const auto& shared = data.items(kDicomSharedGroups);
        const auto& own = data.items(kDicomFrameGroups);
        const std::size_t count = image.layout.frames;
        if (!own.empty() && own.size() != count)
            fail("{}: NumberOfFrames (0028,0008) is {}, but the functional groups (5200,9230) have {} frames",
                 file.path(), count, own.size());
        const double instance = data.number(0x00200013).value_or(-1);
        bool written = !own.empty();
        for (std::size_t i = 0; i < count; ++i) {
            DicomGroups groups{data, shared.empty() ? nullptr : &shared.front(), own.empty() ? nullptr : &own[i]};
            DicomFrame frame;
            frame.index = i;
            frame.instance = std::isfinite(instance) ? instance : -1;
            read_distinctions(groups, frame);
            read_unit(groups, frame);
            read_spacing(groups, frame);
            read_place(groups, frame);
            frame.scale = i == 0 || !own.empty() ? read_scale(groups) : image.frames.front().scale;
            if (const DicomItem* content = groups.with(0x00209111, 0x00209056))
                frame.plane.stack = content->text(0x00209056);
            if (const DicomItem* identified = groups.with(0x0062000a, 0x0062000b)) {
                const double number = identified->number(0x0062000b, "US").value_or(0);
                frame.segment = number >= 0 && number <= 65535 ? static_cast<int>(number) : 0;
            }
            const bool own_place = written && (!own[i].items(0x00209113).empty() || !own[i].items(0x0020930e).empty());
            written = written && own_place;
            image.frames.push_back(std::move(frame));
        }
        const bool patient = image.in_patient;
        image.place = written ? fmt::format("functional groups ({}) per frame", patient ? "0020,0032" : "0020,9301")
                              : "positions of the slices (0020,0032)";
        const bool placed = image.frames.front().position.has_value();
        if (type.find("MOSAIC") != std::string::npos)
            split_mosaic();
        else if (count > 1 && own.empty() && placed)
            place_by_spacing();
        note_values();
    }
};

}  // namespace

std::string_view dicom_attribute_name(int attribute) {
    return kDicomAttributes.at(static_cast<std::size_t>(attribute)).name;
}
int dicom_attribute_count() {
    return static_cast<int>(kDicomAttributes.size());
}
int dicom_first_loose_attribute() {
    return kFirstLooseAttribute;
}

const std::string* DicomFrame::distinction(int attribute) const {
    const auto at = std::ranges::find(distinctions, attribute, &DicomDistinction::attribute);
    return at == distinctions.end() ? nullptr : &at->value;
}

std::string DicomImage::name() const {
    return std::filesystem::path(file).filename().string();
}

DicomImage read_dicom_image(const DicomFile& file) {
    DicomImage image;
    DicomImageReader{file, file.data(), image}.read();
    return image;
}

}  // namespace edgesplat::detail
