// Writes small DICOM files: explicit value representations, little-endian.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace volume_test {

/// A data set. Elements are written in the order of their tags.
class DicomData {
  public:
    DicomData& text(std::uint32_t tag, std::string_view vr, std::string value) {
        if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
        return raw(tag, vr, value);
    }
    DicomData& u16(std::uint32_t tag, const std::vector<int>& numbers) { return raw(tag, "US", integers(numbers, 2)); }
    DicomData& u32(std::uint32_t tag, const std::vector<int>& numbers) { return raw(tag, "UL", integers(numbers, 4)); }
    DicomData& f64(std::uint32_t tag, double number) {
        const auto bits = std::bit_cast<std::uint64_t>(number);
        std::string value;
        for (unsigned i = 0; i < 8; ++i)
            value += static_cast<char>(bits >> (8 * i) & 0xffU);
        return raw(tag, "FD", value);
    }
    DicomData& sequence(std::uint32_t tag, const std::vector<DicomData>& items) {
        std::string value;
        for (const DicomData& item : items) {
            const std::string content = item.bytes();
            value += std::string("\xfe\xff\x00\xe0", 4) + integers({static_cast<int>(content.size())}, 4) + content;
        }
        return raw(tag, "SQ", value);
    }
    DicomData& raw(std::uint32_t tag, std::string_view vr, const std::string& value) {
        const bool is_long = vr == "SQ" || vr[0] == 'O' || vr == "UN";
        std::string element = integers({static_cast<int>(tag >> 16U), static_cast<int>(tag & 0xffffU)}, 2);
        element += vr;
        if (is_long) element += std::string(2, '\0');
        element += integers({static_cast<int>(value.size())}, is_long ? 4 : 2) + value;
        elements_[tag] = element;
        return *this;
    }
    DicomData& without(std::uint32_t tag) {
        elements_.erase(tag);
        return *this;
    }
    std::string bytes() const {
        std::string all;
        for (const auto& [tag, element] : elements_)
            all += element;
        return all;
    }
    /// The content of a file with this data set.
    std::string file() const {
        DicomData meta;
        meta.text(0x00020010, "UI", "1.2.840.10008.1.2.1");
        const std::string head = meta.bytes();
        meta.u32(0x00020000, {static_cast<int>(head.size())});
        return std::string(128, '\0') + "DICM" + meta.bytes() + bytes();
    }
    static std::string integers(const std::vector<int>& numbers, int size) {
        std::string value;
        for (const int number : numbers)
            for (int i = 0; i < size; ++i)
                value += static_cast<char>(static_cast<unsigned>(number) >> static_cast<unsigned>(8 * i) & 0xffU);
        return value;
    }

  private:
    std::map<std::uint32_t, std::string> elements_;
};

/// A picture of 16-bit numbers, without place.
inline DicomData dicom_picture(int columns, int rows, const std::vector<int>& pixels) {
    static int instance = 0;
    DicomData data;
    data.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2")
        .text(0x00080018, "UI", fmt::format("1.2.3.{}", ++instance));
    data.text(0x00080060, "CS", "CT").text(0x0020000d, "UI", "1.2.3.4").text(0x0020000e, "UI", "1.2.3.4.1");
    data.text(0x00280004, "CS", "MONOCHROME2");
    data.u16(0x00280002, {1}).u16(0x00280010, {rows}).u16(0x00280011, {columns}).u16(0x00280100, {16});
    data.u16(0x00280101, {16}).u16(0x00280102, {15}).u16(0x00280103, {1});
    data.raw(0x7fe00010, "OW", DicomData::integers(pixels, 2));
    return data;
}

inline std::string dicom_position(double x, double y, double z) {
    return fmt::format("{:.3f}\\{:.3f}\\{:.3f}", x, y, z);
}

}  // namespace volume_test
