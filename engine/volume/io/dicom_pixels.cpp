// Stored samples of a DICOM file. Native and run-length coded pixels are unpacked here; GDCM decodes the other
// compressed transfer syntaxes, frame by frame, from the fragments alone: it sees no header.
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

constexpr DicomTag kPixels = 0x7fe00010, kFloatPixels = 0x7fe00008, kDoublePixels = 0x7fe00009;
constexpr std::string_view kRunLength = "1.2.840.10008.1.2.5";

enum class DicomCoding { Native, RunLength, Jpeg, JpegLs, Jpeg2000, Unknown };

DicomCoding coding_of(const std::string& syntax) {
    constexpr std::string_view kPrefix = "1.2.840.10008.1.2";
    if (!syntax.starts_with(kPrefix)) return DicomCoding::Unknown;
    const std::string own = syntax.substr(kPrefix.size());
    if (own.empty() || own == ".1" || own == ".2" || own == ".1.99" || own == ".1.98") return DicomCoding::Native;
    if (syntax == kRunLength) return DicomCoding::RunLength;
    for (const char* jpeg : {".4.50", ".4.51", ".4.53", ".4.55", ".4.57", ".4.70"})
        if (own == jpeg) return DicomCoding::Jpeg;
    if (own == ".4.80" || own == ".4.81") return DicomCoding::JpegLs;
    if (own == ".4.90" || own == ".4.91") return DicomCoding::Jpeg2000;
    return DicomCoding::Unknown;
}

std::string coding_name(const std::string& syntax) {
    const auto is = [&](std::string_view part) {
        return syntax.starts_with("1.2.840.10008.1.2.4." + std::string(part));
    };
    if (is("100") || is("101") || is("102") || is("103") || is("104") || is("105") || is("106") || is("107") ||
        is("108"))
        return "a video (MPEG)";
    if (is("201") || is("202") || is("203")) return "High-Throughput JPEG 2000";
    if (is("110") || is("111") || is("112")) return "JPEG XL";
    if (is("92") || is("93")) return "JPEG 2000 of several components";
    return "an unknown transfer syntax";
}

unsigned byte_at(std::string_view bytes, std::size_t at) {
    return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0U;
}
std::size_t big_at(std::string_view bytes, std::size_t at, std::size_t count) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8U | byte_at(bytes, at + i);
    return value;
}

/// What compressed pixels say themselves.
struct CodedSize {
    std::size_t columns = 0, rows = 0, samples = 0, bits = 0;
    unsigned process = 0;  ///< marker of a JPEG frame; 0: JPEG 2000
};

std::optional<CodedSize> coded_size(std::string_view bytes) {
    if (big_at(bytes, 0, 4) == 0xff4fff51)
        return CodedSize{.columns = big_at(bytes, 8, 4) - big_at(bytes, 16, 4),
                         .rows = big_at(bytes, 12, 4) - big_at(bytes, 20, 4),
                         .samples = big_at(bytes, 40, 2),
                         .bits = (byte_at(bytes, 42) & 0x7fU) + 1};
    if (big_at(bytes, 0, 2) != 0xffd8) return std::nullopt;
    std::optional<CodedSize> found;
    bool tables = false;
    for (std::size_t at = 2; at + 4 <= bytes.size();) {
        if (byte_at(bytes, at) != 0xff) return std::nullopt;
        const unsigned marker = byte_at(bytes, at + 1);
        if (marker == 0xff) {
            ++at;
            continue;
        }
        const bool frame =
            (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) || marker == 0xf7;
        if (frame) {
            const std::size_t samples = byte_at(bytes, at + 9);
            if (big_at(bytes, at + 2, 2) != 8 + 3 * samples) return std::nullopt;
            found = CodedSize{.columns = big_at(bytes, at + 7, 2),
                              .rows = big_at(bytes, at + 5, 2),
                              .samples = samples,
                              .bits = byte_at(bytes, at + 4),
                              .process = marker};
        }
        tables = tables || marker == 0xc4;
        // Scans of JPEG-LS need no tables.
        if (marker == 0xda) return found && (tables || found->process == 0xf7) ? found : std::nullopt;
        if (marker == 0xd9) return std::nullopt;
        at += 2 + std::max<std::size_t>(big_at(bytes, at + 2, 2), 2);
    }
    return std::nullopt;
}

/// Whether a JPEG frame is of the kind that the transfer syntax says. GDCM ends the program on others.
bool fits_syntax(const CodedSize& size, const std::string& syntax) {
    switch (coding_of(syntax)) {
        case DicomCoding::Jpeg2000:
            return size.process == 0;
        case DicomCoding::JpegLs:
            return size.process == 0xf7;
        case DicomCoding::Jpeg:
            if (syntax.ends_with(".57") || syntax.ends_with(".70")) return size.process == 0xc3;
            if (syntax.ends_with(".53") || syntax.ends_with(".55")) return size.process == 0xc2;
            return size.process == 0xc0 || size.process == 0xc1;
        default:
            return false;
    }
}

/// Whether the code's end is there; filled up with zeros.
bool has_end(std::string_view bytes) {
    std::size_t end = bytes.size();
    while (end > 0 && bytes[end - 1] == '\0')
        --end;
    return end >= 2 && big_at(bytes, end - 2, 2) == 0xffd9;
}

/// Undoes run-length coding (PackBits) of byte planes, most significant first. Result: little-endian, interleaved.
std::string run_length_decoded(const std::string& path, std::string_view bytes, const DicomLayout& layout) {
    const std::size_t width = static_cast<std::size_t>(layout.bits_allocated) / 8;
    const std::size_t planes = layout.samples * width, pixels = layout.columns * layout.rows;
    const auto little = [&](std::size_t at) {
        return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8U | byte_at(bytes, at + 2) << 16U |
               byte_at(bytes, at + 3) << 24U;
    };
    if (bytes.size() < 64 || little(0) != planes || planes > 15)
        fail("{}: its run-length coded pixels have {} planes, expected {}", path, bytes.size() < 64 ? 0 : little(0),
             planes);
    std::string out(pixels * planes, '\0');
    for (std::size_t plane = 0; plane < planes; ++plane) {
        std::size_t at = little(4 + 4 * plane);
        const std::size_t end = plane + 1 < planes ? little(8 + 4 * plane) : bytes.size();
        if (at < 64 || end > bytes.size() || at > end)
            fail("{}: plane {} of its run-length coded pixels lies outside of them", path, plane);
        const std::size_t sample = plane / width, byte = width - 1 - plane % width;
        std::size_t pixel = 0;
        const auto put = [&](char value) {
            if (pixel < pixels) out[(pixel * layout.samples + sample) * width + byte] = value;
            ++pixel;
        };
        while (at < end && pixel < pixels) {
            const auto code = static_cast<signed char>(bytes[at++]);
            if (code >= 0)
                for (int i = 0; i <= code && at < end; ++i)
                    put(bytes[at++]);
            else if (code != -128 && at < end) {
                for (int i = 0; i <= -code; ++i)
                    put(bytes[at]);
                ++at;
            }
        }
        if (pixel < pixels) fail("{}: truncated: its run-length coded pixels end before the last pixel", path);
    }
    return out;
}

/// Decodes one frame with GDCM and updates `layout` to what it delivers. Little-endian.
std::string gdcm_decoded(const std::string& path, const std::string& syntax, std::string_view coded,
                         DicomLayout& layout) {
    // GDCM reads pixels that are damaged in these ways without a check.
    const bool boxed = big_at(coded, 0, 8) == 0x0000000c6a502020;  // JPEG 2000 in a file of its own
    const auto size = coded_size(coded);
    if (!boxed) {
        if (!size || !fits_syntax(*size, syntax))
            fail("{}: damaged: its compressed pixels do not begin as {} does", path, syntax);
        if (size->columns != layout.columns || size->rows != layout.rows || size->samples != layout.samples)
            fail("{}: its compressed pixels are {} x {} with {} components, its header says {} x {} with {}", path,
                 size->columns, size->rows, size->samples, layout.columns, layout.rows, layout.samples);
        if (size->bits > static_cast<std::size_t>(layout.bits_allocated))
            fail("{}: its compressed pixels have {} bits, but BitsAllocated (0028,0100) is {}", path, size->bits,
                 layout.bits_allocated);
        if (!has_end(coded)) fail("{}: truncated: its compressed pixels have no end", path);
    }
    std::string out, reason;
    {
        OutputCapture capture;
        reason = codec_library().decode_dicom(syntax, coded, layout, out);
        layout.photometric = trimmed(layout.photometric);
        if (reason.empty() && layout.bits_per_frame() / 8 != out.size())
            reason = fmt::format("{} bytes where {} were expected", out.size(), layout.bits_per_frame() / 8);
        if (!reason.empty()) reason += " " + capture.text();
    }
    if (!reason.empty()) fail("{}: cannot decode its pixels: {}", path, tidy(reason));
    return out;
}

/// Divides the fragments of compressed pixels among the frames.
std::vector<std::vector<std::string_view>> fragments_of_frames(const DicomFile& file, const DicomElement& pixels,
                                                               std::size_t frames) {
    std::vector<std::vector<std::string_view>> out(frames);
    if (pixels.fragments.size() < 2) fail("{}: its compressed pixels are empty", file.path());
    const std::string_view table = pixels.fragments.front();
    const std::size_t count = pixels.fragments.size() - 1;
    if (count < frames)
        fail("{}: NumberOfFrames (0028,0008) is {}, but its compressed pixels have {} parts", file.path(), frames,
             count);
    std::vector<std::size_t> starts;  // first fragment of each frame
    if (frames == 1) {
        starts = {0};
    } else if (count == frames) {
        for (std::size_t i = 0; i < frames; ++i)
            starts.push_back(i);
    } else {
        // By the table of offsets, which count from the first fragment's item; else by the code's first bytes.
        std::vector<std::size_t> offsets;
        std::size_t at = 0;
        for (std::size_t i = 0; i < count; ++i) {
            offsets.push_back(at);
            at += 8 + pixels.fragments[i + 1].size();
        }
        for (std::size_t i = 0; 4 * i + 4 <= table.size(); ++i) {
            const std::size_t wanted = byte_at(table, 4 * i) | byte_at(table, 4 * i + 1) << 8U |
                                       byte_at(table, 4 * i + 2) << 16U | byte_at(table, 4 * i + 3) << 24U;
            const auto found = std::ranges::lower_bound(offsets, wanted);
            if (found != offsets.end() && *found == wanted)
                starts.push_back(static_cast<std::size_t>(found - offsets.begin()));
        }
        if (starts.size() != frames) {
            starts.clear();
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t head = big_at(pixels.fragments[i + 1], 0, 2);
                if (head == 0xffd8 || head == 0xff4f) starts.push_back(i);
            }
        }
    }
    if (starts.size() != frames || starts.front() != 0 || !std::ranges::is_sorted(starts, std::ranges::less_equal{}))
        fail("{}: NumberOfFrames (0028,0008) is {}, but its compressed pixels have {} parts that do not fit",
             file.path(), frames, count);
    for (std::size_t i = 0; i < frames; ++i) {
        const std::size_t end = i + 1 < frames ? starts[i + 1] : count;
        for (std::size_t part = starts[i]; part < end; ++part)
            out[i].push_back(pixels.fragments[part + 1]);
        if (out[i].empty()) fail("{}: frame {} of its compressed pixels is empty", file.path(), i);
    }
    return out;
}

const DicomElement* pixels_of(const DicomFile& file) {
    for (const DicomTag tag : {kPixels, kFloatPixels, kDoublePixels})
        if (const DicomElement* element = file.data().find(tag)) return element;
    fail("{}: it has no pixels (7fe0,0010)", file.path());
}

/// A whole number from `least` to `most`.
std::size_t dicom_count(const DicomFile& file, DicomTag tag, std::string_view vr, std::string_view name,
                        std::optional<std::size_t> otherwise, std::size_t least, std::size_t most) {
    const auto number = file.data().number(tag, vr);
    if (!number && otherwise) return *otherwise;
    if (!number) fail("{}: it has no {}", file.path(), name);
    if (!(*number >= static_cast<double>(least)) || !(*number <= static_cast<double>(most)) ||
        *number != std::floor(*number))
        fail("{}: {} is {}, expected a whole number from {} to {}", file.path(), name,
             std::isfinite(*number) ? fmt::format("{}", *number) : "'" + file.data().text(tag) + "'", least, most);
    return static_cast<std::size_t>(*number);
}

bool is_subsampled(const DicomLayout& layout) {
    return layout.photometric == "YBR_FULL_422" && layout.samples == 3 && layout.bits_allocated == 8;
}

}  // namespace

std::string DicomLayout::stored_type() const {
    if (is_float) return bits_allocated == 64 ? "float64" : "float32";
    return fmt::format("{}int{}", is_signed ? "" : "u", bits_allocated);
}

DicomLayout dicom_layout(const DicomFile& file) {
    const std::string& path = file.path();
    const DicomElement& pixels = *pixels_of(file);
    const DicomCoding coding = coding_of(file.transfer_syntax());
    if (coding == DicomCoding::Unknown)
        fail("{}: its pixels are compressed as {} ({}), which is not read", path, coding_name(file.transfer_syntax()),
             file.transfer_syntax());
    DicomLayout layout;
    layout.columns = dicom_count(file, 0x00280011, "US", "Columns (0028,0011)", {}, 1, kMaxVoxelsPerAxis);
    layout.rows = dicom_count(file, 0x00280010, "US", "Rows (0028,0010)", {}, 1, kMaxVoxelsPerAxis);
    layout.samples = dicom_count(file, 0x00280002, "US", "SamplesPerPixel (0028,0002)", 1, 1, 4);
    layout.frames = dicom_count(file, 0x00280008, "IS", "NumberOfFrames (0028,0008)", 1, 1, 1 << 24);
    layout.photometric = file.data().text(0x00280004);
    layout.planar = file.data().number(0x00280006, "US").value_or(0) == 1 && layout.samples > 1;
    layout.is_float = pixels.tag != kPixels;
    if (layout.is_float) {
        layout.bits_allocated = layout.bits_stored = pixels.tag == kDoublePixels ? 64 : 32;
    } else {
        const std::size_t allocated = dicom_count(file, 0x00280100, "US", "BitsAllocated (0028,0100)", {}, 1, 64);
        if (allocated != 1 && allocated != 8 && allocated != 16 && allocated != 32)
            fail("{}: BitsAllocated (0028,0100) is {}, expected 1, 8, 16 or 32", path, allocated);
        const std::size_t stored =
            dicom_count(file, 0x00280101, "US", "BitsStored (0028,0101)", allocated, 1, allocated);
        const std::size_t high =
            dicom_count(file, 0x00280102, "US", "HighBit (0028,0102)", stored - 1, stored - 1, allocated - 1);
        layout.bits_allocated = static_cast<int>(allocated);
        layout.bits_stored = static_cast<int>(stored);
        layout.high_bit = static_cast<int>(high);
        layout.is_signed =
            dicom_count(file, 0x00280103, "US", "PixelRepresentation (0028,0103)", std::size_t{0}, 0, 1) == 1;
    }
    if (layout.photometric.starts_with("YBR_PARTIAL"))
        fail("{}: colours as {} (0028,0004) are not read", path, layout.photometric);
    // Some writers say so of colours that are all there.
    if (coding == DicomCoding::Native && is_subsampled(layout) &&
        pixels.value.size() / layout.frames >= layout.bits_per_frame() / 8)
        layout.photometric = "YBR_FULL";
    std::size_t bits = 0;
    const bool halved = coding == DicomCoding::Native && is_subsampled(layout);
    if (__builtin_mul_overflow(layout.bits_per_frame() / (halved ? 3 : 1) * (halved ? 2 : 1), layout.frames, &bits))
        fail("{}: {} x {} x {} pixels are too many", path, layout.columns, layout.rows, layout.frames);
    const std::size_t bytes = bits / 8 + (bits % 8 != 0 ? 1 : 0);
    if (pixels.fragmented) {
        std::size_t stored = 0;
        for (const std::string_view fragment : pixels.fragments)
            stored += fragment.size();
        check_stored_size(path, bytes, stored, kBestPictureRatio);
        (void)fragments_of_frames(file, pixels, layout.frames);
        return layout;
    }
    if (coding != DicomCoding::Native)
        fail("{}: its transfer syntax {} is compressed, but its pixels (7fe0,0010) are not", path,
             file.transfer_syntax());
    const std::size_t stored = pixels.value.size();
    const std::size_t frame = std::max<std::size_t>(bytes / layout.frames, 2);
    if (stored < bytes || stored - bytes >= frame)
        fail(
            "{}: NumberOfFrames (0028,0008) {}, Rows {}, Columns {} and BitsAllocated {} make {} bytes of pixels, but "
            "(7fe0,0010) has {}: {}",
            path, layout.frames, layout.rows, layout.columns, layout.bits_allocated, bytes, stored,
            stored < bytes ? "truncated, or the header is wrong" : "the header is wrong");
    return layout;
}

DicomPixels::DicomPixels(const DicomFile& file, const DicomLayout& layout)
    : file_(file), layout_(layout), element_(pixels_of(file)) {
    if (element_->fragmented) fragments_ = fragments_of_frames(file, *element_, layout.frames);
}

std::string DicomPixels::frame_bytes(std::size_t frame) const {
    std::string out;
    if (element_->fragmented) {
        for (const std::string_view fragment : fragments_.at(frame))
            out += fragment;
        return out;
    }
    const std::size_t size = element_->value.size() / layout_.frames;
    return std::string(element_->value.substr(frame * size, size));
}

std::string DicomPixels::decoded(std::size_t frame, DicomLayout& layout) const {
    const auto& fragments = fragments_.at(frame);
    const DicomCoding coding = coding_of(file_.transfer_syntax());
    std::string whole;
    for (const std::string_view fragment : fragments)
        whole += fragment;
    if (coding == DicomCoding::RunLength || coding == DicomCoding::Native) {
        layout.planar = layout.planar && coding == DicomCoding::Native;
        if (coding == DicomCoding::RunLength) {
            if (layout.bits_allocated % 8 != 0) fail("{}: run-length coded pixels of 1 bit", file_.path());
            return run_length_decoded(file_.path(), whole, layout);
        }
        if (whole.size() < (layout.bits_per_frame() + 7) / 8)
            fail("{}: truncated: frame {} has {} bytes, expected {}", file_.path(), frame, whole.size(),
                 (layout.bits_per_frame() + 7) / 8);
        return whole;
    }
    // A JFIF file that is called RGB is YBR, as JFIF says.
    if (coding == DicomCoding::Jpeg && layout.photometric == "RGB" && whole.find("JFIF") == 6)
        layout.photometric = "YBR_FULL";
    return gdcm_decoded(file_.path(), file_.transfer_syntax(), whole, layout);
}

void DicomPixels::read(std::size_t frame, std::size_t component, std::vector<double>& samples) const {
    DicomLayout layout = layout_;
    std::string storage;
    std::string_view bytes = element_->value;
    std::size_t first_bit = 0;
    bool big = element_->big;
    const std::size_t pixels = layout.columns * layout.rows;
    const bool halved = !element_->fragmented && is_subsampled(layout);
    if (element_->fragmented) {
        storage = decoded(frame, layout);
        bytes = storage;
        big = false;
    } else {
        first_bit = frame * (halved ? pixels * 16 : layout.bits_per_frame());
    }
    const auto allocated = static_cast<unsigned>(layout.bits_allocated);
    const std::size_t width = allocated / 8;
    // Bytes are in pairs of the words that big-endian files consist of.
    const bool pairs = big && width <= 1 && std::string_view(element_->vr.data(), 2) == "OW";
    const unsigned shift = static_cast<unsigned>(layout.high_bit + 1 - layout.bits_stored);
    const std::uint64_t mask = layout.bits_stored >= 64
                                   ? ~std::uint64_t{0}
                                   : (std::uint64_t{1} << static_cast<unsigned>(layout.bits_stored)) - 1;
    const std::uint64_t sign = (mask >> 1U) + 1;
    const auto sample = [&](std::size_t index) -> double {
        if (width == 0) {
            const std::size_t bit = first_bit + index;
            const std::size_t at = pairs ? (bit / 8) ^ 1U : bit / 8;
            return byte_at(bytes, at) >> (bit % 8) & 1U;
        }
        std::size_t at = first_bit / 8 + index * width;
        if (pairs) at ^= 1U;
        std::uint64_t raw = 0;
        for (std::size_t i = 0; i < width; ++i)
            raw = raw << 8U | byte_at(bytes, at + (big ? i : width - 1 - i));
        if (layout.is_float)
            return width == 8 ? std::bit_cast<double>(raw)
                              : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
        raw = raw >> shift & mask;
        const auto value = static_cast<double>(raw);
        return layout.is_signed && (raw & sign) != 0 ? value - 2 * static_cast<double>(sign) : value;
    };
    samples.resize(pixels);
    const auto place = [&](std::size_t pixel, std::size_t which) {
        // YBR_FULL_422: Y Y Cb Cr for two pixels.
        if (halved) return pixel / 2 * 4 + (which == 0 ? pixel % 2 : which + 1);
        return layout.planar ? which * pixels + pixel : pixel * layout.samples + which;
    };
    const bool colours = layout.samples == 3 && layout.photometric.starts_with("YBR_FULL");
    if (!colours) {
        for (std::size_t i = 0; i < pixels; ++i)
            samples[i] = sample(place(i, component));
        return;
    }
    const double middle = static_cast<double>(sign), most = static_cast<double>(mask);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double y = sample(place(i, 0)), blue = sample(place(i, 1)) - middle, red = sample(place(i, 2)) - middle;
        const double value = component == 0   ? y + 1.402 * red
                             : component == 1 ? y - 0.344136286 * blue - 0.714136286 * red
                                              : y + 1.772 * blue;
        samples[i] = std::clamp(std::round(value), 0.0, most);
    }
}

}  // namespace edgesplat::detail
