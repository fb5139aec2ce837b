// Reads MetaImage files. Place, units and the scale of values come from the header as MetaIO defines its keys; world
// axes are the patient's (left, back, up), as ITK, Slicer and VTK use the format, if AnatomicalOrientation agrees.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "engine/volume/io/samples.h"
#include "engine/volume/io/stored_data.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMetaLine = 65536, kMaxMetaLines = 100'000;

struct MetaHeader {
    std::string path;
    std::map<std::string, std::string> values;  // by key in lower case
    std::vector<std::string> listed_files;      // lines after "ElementDataFile = LIST"
    std::size_t bytes = 0;                      // offset of data in the header's own file
    bool continues = false;                     // keys follow after ElementDataFile, which MetaIO ignores

    bool has(const std::string& key) const { return values.count(key) > 0; }
    std::string value(const std::string& key) const {
        const auto found = values.find(key);
        return found == values.end() ? "" : found->second;
    }
    [[noreturn]] void refuse(std::string_view key, const std::string& reason) const {
        fail("{}: MetaImage key {}: {}", path, key, reason);
    }
    std::vector<double> numbers(const std::string& key) const {
        std::istringstream words(value(key));
        std::vector<double> out;
        for (std::string word; words >> word;) {
            const std::string_view digits = word.starts_with('+') ? std::string_view(word).substr(1) : word;
            double number = 0;
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
            if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(number))
                refuse(key, fmt::format("'{}' is not a number", word));
            out.push_back(number);
        }
        return out;
    }
    double number(const std::string& key, double otherwise) const {
        if (!has(key)) return otherwise;
        const auto found = numbers(key);
        if (found.size() != 1) refuse(key, fmt::format("{} numbers, expected 1", found.size()));
        return found[0];
    }
    long long whole(const std::string& key, long long otherwise) const {
        const double found = number(key, static_cast<double>(otherwise));
        if (found != std::round(found) || std::abs(found) > 1e15)
            refuse(key, fmt::format("'{}' is not a whole number", value(key)));
        return static_cast<long long>(found);
    }
    bool yes(const std::string& key) const {
        const char first = has(key) && !value(key).empty() ? value(key)[0] : 'F';
        return first == 'T' || first == 't' || first == '1' || first == 'Y' || first == 'y';
    }
};

MetaHeader meta_header(const std::string& path, const std::string& file) {
    MetaHeader header;
    header.path = path;
    std::ifstream in(file, std::ios::binary);
    const auto buffer = std::make_unique_for_overwrite<char[]>(kMaxMetaLine);
    for (std::size_t number = 1; number <= kMaxMetaLines && in.getline(buffer.get(), kMaxMetaLine); ++number) {
        const std::string line(buffer.get(), static_cast<std::size_t>(in.gcount()) - (in.eof() ? 0 : 1));
        const auto equals = line.find_first_of("=:");
        const bool text = std::ranges::all_of(
            line, [](char c) { return static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\r'; });
        const bool blank = trimmed(line).empty();
        if (!text || (!blank && (equals == std::string::npos || equals > 80)))
            fail("{}: not a MetaImage header: line {} is no 'key = value'", path, number);
        if (blank) continue;
        std::string key = trimmed(line.substr(0, equals));
        std::ranges::transform(key, key.begin(), [](unsigned char c) { return std::tolower(c); });
        const std::string value = trimmed(line.substr(equals + 1));
        const auto [entry, is_new] = header.values.emplace(key, value);
        if (!is_new && entry->second != value && key != "comment")
            header.refuse(key, "it occurs twice, with different values");
        if (key != "elementdatafile") continue;
        header.bytes = in.eof() ? 0 : static_cast<std::size_t>(in.tellg());
        const bool list = value.starts_with("LIST");
        const bool local = value == "LOCAL" || value == "Local" || value == "local";
        for (; !local && number <= kMaxMetaLines && in.getline(buffer.get(), kMaxMetaLine); ++number) {
            const std::string more = trimmed(buffer.get());
            if (more.empty()) continue;
            if (list) header.listed_files.push_back(more);
            if (more.find('=') != std::string::npos) header.continues = true;
        }
        return header;
    }
    fail("{}: not a MetaImage header: it has no line 'ElementDataFile = ...'", path);
}

SampleType meta_type(const MetaHeader& header) {
    std::string name = header.value("elementtype");
    if (name.ends_with("_ARRAY")) name.resize(name.size() - 6);
    using T = SampleType;
    // MetaIO's long has 4 bytes on every machine.
    static const std::map<std::string, SampleType> types = {
        {"MET_CHAR", T::Int8},         {"MET_UCHAR", T::UInt8},   {"MET_SHORT", T::Int16},
        {"MET_USHORT", T::UInt16},     {"MET_INT", T::Int32},     {"MET_UINT", T::UInt32},
        {"MET_LONG", T::Int32},        {"MET_ULONG", T::UInt32},  {"MET_LONG_LONG", T::Int64},
        {"MET_ULONG_LONG", T::UInt64}, {"MET_FLOAT", T::Float32}, {"MET_DOUBLE", T::Float64}};
    const auto found = types.find(name);
    if (found == types.end())
        header.refuse("ElementType",
                      fmt::format("'{}', expected MET_UCHAR, MET_SHORT, MET_FLOAT or another type of number",
                                  header.value("elementtype")));
    return found->second;
}

struct MetaFile {
    Volume volume;  // everything except samples
    StoredData data;
    StoredSelection selection;
    std::vector<std::size_t> dims;  // with channels last
};

/// The first of several spellings that the header has; empty: none. Fails if two of them differ.
std::string meta_key(const MetaHeader& header, std::initializer_list<const char*> keys) {
    std::string found;
    for (const char* key : keys) {
        if (!header.has(key)) continue;
        if (!found.empty() && header.numbers(found) != header.numbers(key))
            header.refuse(key, fmt::format("it contradicts {}", found));
        if (found.empty()) found = key;
    }
    return found;
}

void take_meta_data(const MetaHeader& header, const std::string& file, MetaFile& out) {
    StoredData& data = out.data;
    data.path = header.path;
    data.type = meta_type(header);
    const auto bits = header.whole("elementnbits", static_cast<long long>(8 * size_of(data.type)));
    if (bits != static_cast<long long>(8 * size_of(data.type)))
        header.refuse("ElementNBits", fmt::format("{} contradicts {}", bits, header.value("elementtype")));
    const bool binary = !header.has("binarydata") || header.yes("binarydata");
    const bool compressed = header.yes("compresseddata");
    if (compressed && !binary) header.refuse("CompressedData", "text cannot be compressed");
    data.encoding = !binary ? StoredEncoding::Text : compressed ? StoredEncoding::Deflate : StoredEncoding::Raw;
    const bool both = header.has("binarydatabyteordermsb") && header.has("elementbyteordermsb");
    if (both && header.yes("binarydatabyteordermsb") != header.yes("elementbyteordermsb") && size_of(data.type) > 1)
        header.refuse("ElementByteOrderMSB", "it contradicts BinaryDataByteOrderMSB");
    const bool big = header.yes("binarydatabyteordermsb") || header.yes("elementbyteordermsb");
    data.swapped = big != (std::endian::native == std::endian::big);
    if (!both && !header.has("binarydatabyteordermsb") && !header.has("elementbyteordermsb") && binary &&
        size_of(data.type) > 1)
        out.volume.notes.emplace_back("The header has no byte order: little endian is assumed.");
    data.slope = header.number("elementtointensityfunctionslope", 1);
    data.intercept = header.number("elementtointensityfunctionoffset", 0);
    if (data.slope == 0) header.refuse("ElementToIntensityFunctionSlope", "0, expected another number");

    const std::string value = header.value("elementdatafile");
    const bool local = value == "LOCAL" || value == "Local" || value == "local";
    const auto folder = fs::path(header.path).parent_path();
    if (header.continues && !local && !value.starts_with("LIST"))
        out.volume.warnings.emplace_back("Keys after ElementDataFile have no effect: it must be the last one.");
    const auto skip = header.whole("headersize", 0);
    if (skip < -1) header.refuse("HeaderSize", fmt::format("{}, expected -1 or a count of bytes", skip));
    if (skip == -1 && !binary) header.refuse("HeaderSize", "-1 is defined for binary data only");
    // MetaIO ignores -1 for compressed data; a size counts from the beginning of the file.
    data.at_end = skip == -1 && !compressed;
    if (skip > 0) data.offset = static_cast<std::size_t>(skip);
    if (!local) data.header = file;
    if (local) {
        if (header.bytes == 0) fail("{}: truncated: no data follow the header", header.path);
        if (skip > 0 && data.offset < header.bytes)
            header.refuse("HeaderSize", fmt::format("{} points into the header of {} bytes", skip, header.bytes));
        data.offset = std::max(data.offset, header.bytes);
        data.files = {file};
        return;
    }
    const std::size_t axes = out.dims.size();
    const auto slices_of = [&](long long per_file) {
        std::size_t slices = 1;
        for (auto axis = static_cast<std::size_t>(std::max(per_file, 1LL)); axis < axes; ++axis)
            slices *= out.dims[axis];
        return slices;
    };
    // "LIST 2" and a fifth word of a pattern give the axes that each file has; without it, all except the last.
    auto per_file = static_cast<long long>(axes) - 1;
    std::vector<std::string> names;
    if (value.starts_with("LIST")) {
        names = header.listed_files;
        const std::string rest = trimmed(value.substr(4));
        if (!rest.empty() && std::isdigit(static_cast<unsigned char>(rest[0])) != 0) per_file = rest[0] - '0';
    } else if (value.find('%') != std::string::npos) {
        std::istringstream words(value);
        std::string pattern;
        long long first = 0, last = 0, step = 1;
        words >> pattern >> first >> last;
        const bool good = static_cast<bool>(words);
        if (!(words >> step)) step = 1;
        if (!good)
            header.refuse("ElementDataFile", fmt::format("'{}', expected a name with one number like %03d, then "
                                                         "first, last and step",
                                                         value));
        names = names_of_pattern(header.path, "MetaImage key ElementDataFile", pattern, first, last, step);
    } else {
        data.files = {folder / value};
        return;
    }
    // MetaIO reads the needed number of names; blank lines and comments are no names.
    if (names.size() != slices_of(per_file))
        fail("{}: {} data files for {} slices", header.path, names.size(), slices_of(per_file));
    for (const auto& name : names)
        data.files.push_back(folder / name);
}

/// Whether the letters of AnatomicalOrientation, such as RAI, name sides from which the axes come: each on an axis of
/// the patient of its own, less than 90 degrees from the direction.
bool letters_match(std::string letters, const glm::dmat3& axes) {
    std::ranges::transform(letters, letters.begin(), [](unsigned char c) { return std::toupper(c); });
    static constexpr std::string_view from_low = "RAI", from_high = "LPS";
    std::array<bool, 3> named{};
    for (int i = 0; i < 3; ++i) {
        const char letter = letters[static_cast<std::size_t>(i)];
        const auto low = from_low.find(letter), high = from_high.find(letter);
        const std::size_t axis = std::min(low, high);
        const double component = axes[i][static_cast<int>(axis)];
        if (named[axis] || !(low < high ? component > 0 : component < 0)) return false;
        named[axis] = true;
    }
    return true;
}

void take_meta_place(const MetaHeader& header, const std::vector<std::size_t>& dims, Volume& volume) {
    const std::size_t count = dims.size(), in_space = std::min<std::size_t>(count, 3);
    volume.geometry.dims = glm::ivec3(1);
    for (std::size_t i = 0; i < in_space; ++i)
        volume.geometry.dims[static_cast<int>(i)] = static_cast<int>(dims[i]);

    glm::dvec3 spacing(1.0), origin(0.0);
    std::string key = header.has("elementspacing") ? "elementspacing" : header.has("elementsize") ? "elementsize" : "";
    if (!key.empty()) {
        const auto numbers = header.numbers(key);
        if (numbers.size() < in_space)
            header.refuse(key, fmt::format("{} numbers, expected {}", numbers.size(), count));
        if (numbers.size() != count)
            volume.notes.push_back(fmt::format("The header says NDims = {} but gives {} spacings; NDims was used.",
                                               count, numbers.size()));
        for (std::size_t i = 0; i < in_space; ++i) {
            if (!(numbers[i] > 0)) header.refuse(key, fmt::format("{}, expected a length above 0", numbers[i]));
            spacing[static_cast<int>(i)] = numbers[i];
        }
    } else {
        volume.notes.emplace_back("The header has no spacing: 1 mm is assumed.");
    }
    const std::string place = meta_key(header, {"offset", "position", "origin"});
    if (!place.empty()) {
        const auto numbers = header.numbers(place);
        if (numbers.size() < in_space)
            header.refuse(place, fmt::format("{} numbers, expected {}", numbers.size(), count));
        for (std::size_t i = 0; i < in_space; ++i)
            origin[static_cast<int>(i)] = numbers[i];
    }
    // Row i is the direction of axis i.
    glm::dmat3 directions(1.0);
    const std::string matrix = meta_key(header, {"transformmatrix", "rotation", "orientation"});
    if (!matrix.empty()) {
        const auto numbers = header.numbers(matrix);
        if (numbers.size() != count * count)
            header.refuse(matrix, fmt::format("{} numbers, expected {}", numbers.size(), count * count));
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j) {
                const double number = numbers[i * count + j];
                if (i < 3 && j < 3)
                    directions[static_cast<int>(i)][static_cast<int>(j)] = number;
                else if (i != j && number != 0)
                    header.refuse(matrix, fmt::format("axis {} runs through space and time", std::min(i, j)));
            }
    }
    const auto center = header.has("centerofrotation") ? header.numbers("centerofrotation") : std::vector<double>();
    if (std::ranges::any_of(center, [](double c) { return c != 0; }) && directions != glm::dmat3(1.0))
        volume.notes.emplace_back("CenterOfRotation was not used: Offset is the place of the first voxel.");

    double millimetres = 1;
    if (const std::string unit = header.value("distanceunits"); !unit.empty() && unit != "?") {
        const auto known = millimetres_in(unit);
        if (known) volume.length_unit = unit;
        millimetres = known.value_or(1);
        if (!known) volume.warnings.push_back(fmt::format("The unit '{}' is no known length: mm are assumed.", unit));
    }
    glm::dmat3 axes(0.0);
    for (int i = 0; i < 3; ++i)
        axes[i] = directions[i] * spacing[i] * millimetres;
    if (count == 2) {
        const glm::dvec3 normal = glm::cross(axes[0], axes[1]);
        axes[2] = glm::length(normal) > 0 ? glm::normalize(normal) : glm::dvec3(0, 0, 1);
        volume.notes.emplace_back("The file holds a 2-D image: it is read as a volume of one slice, 1 mm thick.");
    }
    const char* source = key == "elementspacing" ? matrix.empty() ? "ElementSpacing" : "TransformMatrix"
                         : key == "elementsize"  ? "ElementSize"
                                                 : "none: 1 mm assumed";
    set_place(volume, axes, origin * millimetres, 1, source);

    const std::string letters = header.value("anatomicalorientation");
    const bool named = letters.size() == 3 && letters.find_first_not_of("RLAPSIrlapsi") == std::string::npos;
    if (!named) return;
    // Many programs write RAI, the letters of LPS axes, whatever the directions are.
    volume.in_patient = letters_match(letters, glm::dmat3(1.0)) || letters_match(letters, axes);
    if (!volume.in_patient)
        volume.warnings.push_back(fmt::format(
            "AnatomicalOrientation = {} contradicts the directions of the axes, which were used; left and right of the "
            "patient are not certain.",
            letters));
}

MetaFile meta_file(const std::string& path, const std::string& file, const LoadOptions& options) {
    const auto header = meta_header(path, file);
    MetaFile out;
    out.volume.name = path;
    if (header.has("objecttype") && header.value("objecttype") != "Image")
        header.refuse("ObjectType", fmt::format("'{}', expected Image", header.value("objecttype")));
    if (!header.has("ndims"))
        header.refuse("NDims",
                      header.has("dimsize") ? "missing" : "missing before ElementDataFile, which must be the last key");
    const auto axes = header.whole("ndims", 0);
    if (axes < 2 || axes > 4)
        fail("{}: NDims = {}, expected 2 to 4{}", path, header.value("ndims"),
             axes == 1 ? ": its data have 1 axis" : "");
    const auto sizes = header.numbers("dimsize");
    if (static_cast<long long>(sizes.size()) != axes)
        fail("{}: NDims = {} and DimSize with {} numbers, expected as many", path, axes, sizes.size());
    for (const double size : sizes) {
        if (size != std::round(size) || size < 1 || size > static_cast<double>(kMaxPackedVoxelsPerAxis))
            header.refuse("DimSize", fmt::format("{}: expected 1 to {} along each axis, and at most 2^40 in all", size,
                                                 kMaxPackedVoxelsPerAxis));
        out.dims.push_back(static_cast<std::size_t>(size));
    }
    const auto channels = header.whole("elementnumberofchannels", 1);
    if (channels < 1 || channels > 65535)
        header.refuse("ElementNumberOfChannels", fmt::format("{}, expected 1 to 65535", channels));
    take_meta_data(header, file, out);
    out.volume.stored_type = name_of(out.data.type);
    take_meta_place(header, out.dims, out.volume);

    auto& step = out.selection.step;
    step[0] = static_cast<std::size_t>(channels);
    for (std::size_t i = 1; i < 3; ++i)
        step[i] = step[i - 1] * out.dims[i - 1];
    out.data.samples = static_cast<std::size_t>(channels);
    for (const std::size_t n : out.dims)
        if (__builtin_mul_overflow(out.data.samples, n, &out.data.samples) || out.data.samples > kMaxPackedVoxels)
            header.refuse("DimSize", fmt::format("'{}': at most 2^40 samples can be read", header.value("dimsize")));
    // VTK writes numbers of 8 bytes as MET_LONG.
    const auto& file_name = out.data.files.front();
    std::error_code error;
    if (header.value("elementtype").ends_with("LONG") && !header.value("elementtype").ends_with("_LONG_LONG") &&
        out.data.encoding == StoredEncoding::Raw && out.data.files.size() == 1 && !out.data.at_end &&
        fs::file_size(file_name, error) == out.data.offset + 8 * out.data.samples) {
        out.data.type = out.data.type == SampleType::Int32 ? SampleType::Int64 : SampleType::UInt64;
        out.volume.stored_type = name_of(out.data.type);
        out.volume.notes.push_back(fmt::format("{} has 4 bytes, but the file holds 8 for each: they were read as {}.",
                                               header.value("elementtype"), out.volume.stored_type));
    }
    if (out.dims.size() == 4)
        out.selection.first = chosen_frame(path, options, out.dims[3]) * step[2] * out.dims[2];
    else
        (void)chosen_frame(path, options, 1);
    out.selection.first += chosen_component(path, options, static_cast<std::size_t>(channels));
    out.dims.push_back(static_cast<std::size_t>(channels));
    if (out.dims.size() == 3) out.dims.insert(out.dims.begin() + 2, 1);
    return out;
}

}  // namespace

std::optional<FileLayout> meta_layout(const std::string& path, Volume& description) {
    MetaFile file = meta_file(path, path, {});
    auto layout = layout_of_stored(file.data, file.selection, file.volume);
    if (layout) description = std::move(file.volume);
    return layout;
}

Volume load_meta(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    std::optional<TemporaryFolder> folder;
    MetaFile read = meta_file(path, without_gzip(path, folder), options);
    checked_bytes(path, read.dims, size_of(read.data.type));
    read_stored(read.data, read.selection, read.volume, options);
    return std::move(read.volume);
}

}  // namespace edgesplat::detail
