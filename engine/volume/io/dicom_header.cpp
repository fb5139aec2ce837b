// Reads the elements of a DICOM file: explicit and implicit value representations, both byte orders, deflated, with and
// without preamble. Every length is checked against the end of the file before it is used.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

constexpr std::uint32_t kDicomUndefined = 0xffffffff;
constexpr DicomTag kDicomItem = 0xfffee000, kDicomItemEnd = 0xfffee00d, kDicomSequenceEnd = 0xfffee0dd;
constexpr DicomTag kDicomPixelData = 0x7fe00010;
constexpr int kMostDicomDepth = 32;
/// Each takes some 120 bytes of memory.
constexpr std::size_t kMostDicomElements = std::size_t{1} << 25;

constexpr std::string_view kLongRepresentations = "OB OW OF OD OL OV SQ UT UN UC UR SV UV";
constexpr std::string_view kShortRepresentations = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";

bool is_representation(std::string_view vr) {
    return vr.size() == 2 && vr[0] >= 'A' && vr[0] <= 'Z' && vr[1] >= 'A' && vr[1] <= 'Z' &&
           (kLongRepresentations.find(vr) != std::string_view::npos ||
            kShortRepresentations.find(vr) != std::string_view::npos);
}

/// Sequences that the reader looks into. Without representations, a sequence of known length looks like any value.
bool is_known_sequence(DicomTag tag) {
    static constexpr std::array kTags{0x00041220U, 0x00089215U, 0x00180026U, 0x00186011U, 0x00189076U, 0x00189112U,
                                      0x00189114U, 0x00189115U, 0x00189117U, 0x00189118U, 0x00189226U, 0x00189325U,
                                      0x00189329U, 0x00189751U, 0x00189807U, 0x00209111U, 0x00209113U, 0x00209116U,
                                      0x00209221U, 0x00209222U, 0x00209253U, 0x0020930eU, 0x0020930fU, 0x00283000U,
                                      0x00289110U, 0x00289132U, 0x00289145U, 0x00409096U, 0x004008eaU, 0x00540022U,
                                      0x00620002U, 0x0062000aU, 0x52009229U, 0x52009230U};
    return std::ranges::find(kTags, tag) != kTags.end();
}

std::uint64_t dicom_integer(std::string_view bytes, std::size_t at, std::size_t count, bool big) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8U | static_cast<unsigned char>(bytes[at + (big ? i : count - 1 - i)]);
    return value;
}

/// Reads data sets from bytes.
struct DicomParser {
    const std::string& path;
    std::string_view bytes;
    std::size_t at = 0, end = 0;
    bool big = false, explicit_vr = true;
    std::size_t count = 0;

    [[noreturn]] void truncated() const { fail("{}: truncated: its data continue beyond the end of the file", path); }
    void need(std::uint64_t size) const {
        if (size > bytes.size() - at) truncated();
    }
    std::uint32_t integer(std::size_t size) {
        need(size);
        const auto value = dicom_integer(bytes, at, size, big);
        at += size;
        return static_cast<std::uint32_t>(value);
    }
    DicomTag tag() {
        const std::uint32_t group = integer(2);
        return group << 16U | integer(2);
    }
    std::string_view take(std::uint64_t size) {
        need(size);
        const auto value = bytes.substr(at, size);
        at += size;
        return value;
    }
    /// Length of the value after the tag.
    std::uint32_t length(std::array<char, 2>& vr) {
        vr = {};
        if (!explicit_vr) return integer(4);
        const auto name = take(2);
        vr = {name[0], name[1]};
        if (kLongRepresentations.find(name) == std::string_view::npos) return integer(2);
        take(2);
        return integer(4);
    }
    void check_depth(int depth) const {
        if (depth > kMostDicomDepth) fail("{}: sequences in sequences deeper than {}", path, kMostDicomDepth);
    }

    /// Elements up to `stop`, or to the end-of-item tag.
    void elements(std::size_t stop, int depth, DicomItem& item) {
        check_depth(depth);
        bool ascending = true;
        while (at < stop) {
            // After the pixels, some files are filled up.
            if (depth == 0 && stop - at < 8 && !item.elements.empty() && item.elements.back().tag >= kDicomPixelData)
                break;
            DicomElement element;
            element.tag = tag();
            element.big = big;
            if (element.tag == kDicomItemEnd || element.tag == kDicomSequenceEnd) {
                (void)integer(4);
                if (depth > 0) break;
                continue;
            }
            if (element.tag == 0 && depth == 0 && bytes.find_first_not_of('\0', at) == std::string_view::npos) {
                at = stop;
                break;
            }
            const std::uint32_t size = length(element.vr);
            if (++count > kMostDicomElements)
                fail("{}: its header has more than {} elements", path, kMostDicomElements);
            const bool is_sequence = std::string_view(element.vr.data(), 2) == "SQ";
            // Of unknown representation: its content is without representations.
            const bool is_unknown = std::string_view(element.vr.data(), 2) == "UN";
            if (size == kDicomUndefined) {
                if (element.tag == kDicomPixelData)
                    fragments(element);
                else
                    sequence(bytes.size(), true, is_unknown, depth, element);
            } else {
                need(size);
                if ((is_sequence || ((is_unknown || !explicit_vr) && is_known_sequence(element.tag)))) {
                    sequence(at + size, false, is_unknown, depth, element);
                } else {
                    element.value = take(size);
                }
            }
            ascending = ascending && (item.elements.empty() || item.elements.back().tag < element.tag);
            item.elements.push_back(std::move(element));
        }
        if (!ascending) std::ranges::stable_sort(item.elements, {}, &DicomElement::tag);
    }

    void sequence(std::size_t stop, bool delimited, bool without_representations, int depth, DicomElement& element) {
        const bool was_explicit = explicit_vr, was_big = big;
        if (without_representations) explicit_vr = big = false;
        while (at < stop) {
            const auto here = tag();
            const std::uint32_t size = integer(4);
            if (here == kDicomSequenceEnd) {
                if (delimited) delimited = false;
                break;
            }
            if (here != kDicomItem)
                fail("{}: the sequence ({:04x},{:04x}) has ({:04x},{:04x}) where an item was expected", path,
                     element.tag >> 16U, element.tag & 0xffffU, here >> 16U, here & 0xffffU);
            if (++count > kMostDicomElements)
                fail("{}: its header has more than {} elements", path, kMostDicomElements);
            if (size != kDicomUndefined) need(size);
            DicomItem item;
            elements(size == kDicomUndefined ? bytes.size() : at + size, depth + 1, item);
            element.items.push_back(std::move(item));
        }
        if (delimited) truncated();
        explicit_vr = was_explicit;
        big = was_big;
    }

    void fragments(DicomElement& element) {
        element.fragmented = true;
        while (true) {
            const auto here = tag();
            const std::uint32_t size = integer(4);
            if (here == kDicomSequenceEnd) return;
            if (here != kDicomItem || size == kDicomUndefined)
                fail("{}: its compressed pixels (7fe0,0010) contain ({:04x},{:04x}) where an item was expected", path,
                     here >> 16U, here & 0xffffU);
            element.fragments.push_back(take(size));
        }
    }
};

/// Some files are written in the other way than they say.
bool has_representation(std::string_view bytes, std::size_t at) {
    return bytes.size() >= at + 6 && is_representation(bytes.substr(at + 4, 2));
}

std::string inflate_dicom(const std::string& path, std::string_view deflated) {
    std::string out;
    for (const int window : {-MAX_WBITS, MAX_WBITS}) {  // as the standard says, and with zlib's header
        out.clear();
        z_stream stream{};
        if (inflateInit2(&stream, window) != Z_OK) fail("{}: cannot inflate its data", path);
        stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(deflated.data()));  // zlib only reads it
        stream.avail_in = static_cast<uInt>(std::min<std::size_t>(deflated.size(), std::numeric_limits<uInt>::max()));
        int result = Z_OK;
        while (result == Z_OK) {
            const std::size_t before = out.size(), room = std::max<std::size_t>(1 << 16, before);
            check_memory(path, "its data inflated", before + room);
            out.resize(before + room);
            stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
            stream.avail_out = static_cast<uInt>(std::min<std::size_t>(room, std::numeric_limits<uInt>::max()));
            const auto offered = stream.avail_out;
            result = inflate(&stream, Z_NO_FLUSH);
            out.resize(before + offered - stream.avail_out);
        }
        inflateEnd(&stream);
        if (result == Z_STREAM_END) return out;
    }
    fail("{}: truncated or damaged: its deflated data cannot be inflated", path);
}

}  // namespace

const DicomElement* DicomItem::find(DicomTag tag) const {
    const auto at = std::ranges::lower_bound(elements, tag, {}, &DicomElement::tag);
    return at != elements.end() && at->tag == tag ? &*at : nullptr;
}

const std::vector<DicomItem>& DicomItem::items(DicomTag tag) const {
    static const std::vector<DicomItem> none;
    const DicomElement* element = find(tag);
    return element == nullptr ? none : element->items;
}

std::string DicomItem::text(DicomTag tag) const {
    const DicomElement* element = find(tag);
    if (element == nullptr) return "";
    std::string text(element->value.substr(0, 4096));
    const auto blank = [](char c) { return c == ' ' || c == '\0' || c == '\t' || c == '\r' || c == '\n'; };
    while (!text.empty() && blank(text.back()))
        text.pop_back();
    while (!text.empty() && blank(text.front()))
        text.erase(0, 1);
    return text;
}

std::vector<double> DicomItem::numbers(DicomTag tag, std::string_view otherwise) const {
    std::vector<double> out;
    const DicomElement* element = find(tag);
    if (element == nullptr) return out;
    std::string_view vr(element->vr.data(), 2);
    static constexpr std::string_view kKnown = "DS IS US SS UL SL FL FD OW OF OD";
    if (vr[0] == '\0' || vr == "UN" || kKnown.find(vr) == std::string_view::npos) vr = otherwise;
    const std::string_view value = element->value;
    if (vr == "DS" || vr == "IS") {
        if (value.find_first_not_of(std::string_view(" \0", 2)) == std::string_view::npos) return out;
        for (std::size_t at = 0; at <= value.size();) {
            const std::size_t next = std::min(value.find('\\', at), value.size());
            std::string_view part = value.substr(at, next - at);
            const auto skipped = part.find_first_not_of(std::string_view(" +\0", 3));
            part.remove_prefix(skipped == std::string_view::npos ? part.size() : skipped);
            while (!part.empty() && (part.back() == ' ' || part.back() == '\0'))
                part.remove_suffix(1);
            double number = 0;
            const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
            const bool good = error == std::errc() && end == part.data() + part.size();
            out.push_back(good ? number : std::numeric_limits<double>::quiet_NaN());
            at = next + 1;
        }
        return out;
    }
    const bool wide = vr == "UL" || vr == "SL" || vr == "FL" || vr == "OF";
    const std::size_t size = vr == "FD" || vr == "OD" ? 8 : wide ? 4 : 2;
    for (std::size_t at = 0; at + size <= value.size(); at += size) {
        const std::uint64_t bits = dicom_integer(value, at, size, element->big);
        if (size == 8)
            out.push_back(std::bit_cast<double>(bits));
        else if (vr == "FL" || vr == "OF")
            out.push_back(static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits))));
        else if (vr == "SL")
            out.push_back(static_cast<double>(static_cast<std::int32_t>(bits)));
        else if (vr == "SS")
            out.push_back(static_cast<double>(static_cast<std::int16_t>(bits)));
        else
            out.push_back(static_cast<double>(bits));
    }
    return out;
}

std::optional<double> DicomItem::number(DicomTag tag, std::string_view otherwise) const {
    const auto all = numbers(tag, otherwise);
    return all.empty() ? std::nullopt : std::optional(all.front());
}

DicomFile::DicomFile(const std::string& path) : path_(path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat about {};
    if (file < 0 || fstat(file, &about) != 0) {
        if (file >= 0) close(file);
        fail("{}: cannot be read: {}", path, std::strerror(errno));
    }
    const auto size = static_cast<std::size_t>(about.st_size);
    mapped_ = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    close(file);
    if (mapped_ == MAP_FAILED) {
        mapped_ = nullptr;
        fail("{}: cannot be read: {}", path, std::strerror(errno));
    }
    const auto unmap = [&](void* at) { munmap(at, size); };
    std::unique_ptr<void, decltype(unmap)> guard(mapped_, unmap);  // the destructor does not run if read() throws
    bytes_ = {static_cast<const char*>(mapped_), size};
    read();
    (void)guard.release();
}

DicomFile::DicomFile(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {
    read();
}

DicomFile::~DicomFile() {
    if (mapped_ != nullptr) munmap(mapped_, bytes_.size());
}

void DicomFile::read() {
    DicomParser parser{path_, bytes_};
    if (bytes_.size() >= 132 && bytes_.substr(128, 4) == "DICM") parser.at = 132;
    // File meta information: explicit, little-endian.
    DicomItem meta;
    parser.explicit_vr = has_representation(bytes_, parser.at);
    while (bytes_.size() - parser.at >= 2 && dicom_integer(bytes_, parser.at, 2, false) == 2) {
        DicomElement element;
        element.tag = parser.tag();
        const std::uint32_t size = parser.length(element.vr);
        if (size == kDicomUndefined) parser.truncated();
        element.value = parser.take(size);
        meta.elements.push_back(std::move(element));
    }
    syntax_ = meta.text(0x00020010);
    constexpr std::string_view kImplicit = "1.2.840.10008.1.2", kBig = "1.2.840.10008.1.2.2",
                               kDeflated = "1.2.840.10008.1.2.1.99";
    if (syntax_ == kDeflated) {
        inflated_ = inflate_dicom(path_, bytes_.substr(parser.at));
        parser.bytes = inflated_;
        parser.at = 0;
    }
    parser.big = syntax_ == kBig;
    parser.explicit_vr = has_representation(parser.bytes, parser.at);
    if (syntax_.empty()) syntax_ = parser.explicit_vr ? "1.2.840.10008.1.2.1" : kImplicit;
    parser.elements(parser.bytes.size(), 0, data_);
    // Only known elements decide about place and value: each must be there once.
    for (std::size_t i = 1; i < data_.elements.size(); ++i)
        if (data_.elements[i].tag == data_.elements[i - 1].tag)
            fail("{}: its header has ({:04x},{:04x}) twice", path_, data_.elements[i].tag >> 16U,
                 data_.elements[i].tag & 0xffffU);
}

bool begins_with_dicom_elements(const std::string& path) {
    // The beginning is enough for four elements.
    std::string head(4096, '\0');
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    const ssize_t got = ::read(file, head.data(), head.size());
    struct stat about {};
    const std::size_t size = fstat(file, &about) == 0 ? static_cast<std::size_t>(about.st_size) : 0;
    close(file);
    if (got < 8) return false;
    head.resize(static_cast<std::size_t>(got));
    DicomParser parser{path, head};
    parser.explicit_vr = has_representation(head, 0);
    DicomTag before = 0;
    try {
        for (int i = 0; i < 4; ++i) {
            const DicomTag tag = parser.tag(), group = tag >> 16U;
            if (tag <= before || (i == 0 && group != 2 && group != 8) || group > 0x7fe0) return false;
            std::array<char, 2> vr{};
            const std::uint32_t count = parser.length(vr);
            if (parser.explicit_vr && !is_representation({vr.data(), 2})) return false;
            if (count == kDicomUndefined) return i > 0;
            if (count > size - parser.at) return false;
            if (count > head.size() - parser.at) return i > 0;
            parser.at += count;
            before = tag;
        }
    } catch (const Error&) {
        return false;
    }
    return true;
}

}  // namespace edgesplat::detail
