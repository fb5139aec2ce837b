// Reads legacy VTK files ("# vtk DataFile Version"): image data, and rectilinear grids with even coordinates. The data
// are in big-endian order or text. The whole file is walked before anything is allocated, as only the lengths of all
// arrays before one tell where it begins.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/volume/io/mapped_file.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/io/vtk_grid.h"

namespace edgesplat::detail {
namespace {

std::string vtk_lower(std::string_view text) {
    std::string lower;
    for (const char c : text)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

// Names are written with %20 for a blank.
std::string vtk_decoded(std::string_view name) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto digit = [&](std::size_t at) {
            return at < name.size() && std::isxdigit(static_cast<unsigned char>(name[at])) != 0;
        };
        if (name[i] == '%' && digit(i + 1) && digit(i + 2)) {
            text += static_cast<char>(std::stoi(std::string(name.substr(i + 1, 2)), nullptr, 16));
            i += 2;
        } else {
            text += name[i];
        }
    }
    return text;
}

class VtkLegacyFile {
  public:
    struct Stored {
        VtkArray array;
        std::size_t tuples = 0;
        std::size_t begin = 0, end = 0;  // of the samples in the file
        bool color_text = false;         // numbers 0..1 that stand for bytes
    };

    VtkLegacyFile(const std::string& path, std::string_view text, std::size_t long_bytes)
        : path_(path), text_(text), long_bytes_(long_bytes) {
        read_head();
        while (true) {
            const std::string word = keyword();
            if (word.empty()) break;
            read_section(word);
        }
        if (!has_dims_) fail("{}: truncated: no DIMENSIONS", path_);
    }

    VtkGrid grid;
    std::vector<Stored> arrays;
    bool rectilinear() const { return rectilinear_; }
    bool binary() const { return binary_; }
    /// The samples of an array: in the file (binary) or converted to `kept` (text).
    const std::byte* samples(const Stored& stored, std::vector<std::byte>& kept) const {
        const auto text = text_.substr(stored.begin, stored.end - stored.begin);
        if (binary_) return reinterpret_cast<const std::byte*>(text.data());
        auto rest = text;
        if (stored.color_text) return colors(stored, rest, kept);
        kept = vtk_text_samples(path_, "array " + stored.array.name, *stored.array.type,
                                stored.tuples * stored.array.components, rest);
        return kept.data();
    }
    /// Colours are bytes in binary files and shares of 255 in text.
    const std::byte* colors(const Stored& stored, std::string_view text, std::vector<std::byte>& kept) const {
        const std::size_t count = stored.tuples * stored.array.components;
        const auto shares = vtk_text_samples(path_, "array " + stored.array.name, SampleType::Float64, count, text);
        kept.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            double share = 0;
            std::memcpy(&share, shares.data() + i * sizeof share, sizeof share);
            if (!(share >= 0 && share <= 1))
                fail("{}: COLOR_SCALARS {} with {}: expected 0 to 1", path_, stored.array.name, share);
            kept[i] = static_cast<std::byte>(std::lround(255 * share));
        }
        return kept.data();
    }
    bool swapped() const { return binary_ && std::endian::native == std::endian::little; }
    const Stored& coordinates(int axis) const { return coordinates_[static_cast<std::size_t>(axis)]; }

  private:
    std::string_view word() {
        auto rest = text_.substr(at_);
        const auto found = next_vtk_word(rest);
        at_ = text_.size() - rest.size();
        return found;
    }
    std::string keyword() {
        const auto found = word();
        if (found.size() > 256) unexpected(found);
        return vtk_lower(found);
    }
    std::string rest_of_line() {
        const auto end = std::min(text_.find('\n', at_), text_.size());
        const auto line = text_.substr(at_, std::min<std::size_t>(end - at_, 4096));
        at_ = std::min(end + 1, text_.size());
        return trimmed(std::string(line));
    }
    [[noreturn]] void unexpected(std::string_view found) const {
        std::string shown;
        for (const char c : found.substr(0, 30))
            shown += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
        if (found.empty()) fail("{}: truncated after byte {}", path_, at_);
        fail("{}: '{}' before byte {}: no keyword of a VTK file; a header that contradicts the data before it?", path_,
             shown, at_);
    }
    std::size_t count(std::string_view field) {
        const auto text = word();
        std::int64_t value = 0;
        if (!vtk_number(text, value) || value < 0)
            fail("{}: {} '{}': expected a count", path_, field, tidy(text.substr(0, 40)));
        return static_cast<std::size_t>(value);
    }
    double number(std::string_view field) {
        const auto text = word();
        double value = 0;
        if (!vtk_number(text, value)) fail("{}: {} '{}': expected a number", path_, field, tidy(text.substr(0, 40)));
        return value;
    }

    void read_head() {
        const std::string first = vtk_lower(rest_of_line());
        constexpr std::string_view kMagic = "# vtk datafile version";
        double version = 0;
        if (!first.starts_with(kMagic) || !vtk_number(trimmed(first.substr(kMagic.size())), version) || version < 1 ||
            version >= 6)
            fail("{}: '{}': expected # vtk DataFile Version 1.0 to 5.1", path_, first.substr(0, 60));
        rest_of_line();  // the title
        const std::string format = keyword();
        if (format != "ascii" && format != "binary")
            fail("{}: '{}' after the title: expected ASCII or BINARY", path_, tidy(format.substr(0, 40)));
        binary_ = format == "binary";
        const std::string dataset = keyword(), type = dataset == "dataset" ? keyword() : dataset;
        rectilinear_ = type == "rectilinear_grid";
        if (type != "structured_points" && !rectilinear_)
            fail(
                "{}: a VTK file with {}, not image data (DATASET STRUCTURED_POINTS or RECTILINEAR_GRID); resample it "
                "to an image, e.g. with ParaView's filter Resample To Image",
                path_, type.empty() ? "nothing in it" : tidy(type));
        grid.source = rectilinear_ ? "coordinates" : "none: 1 mm assumed";
    }

    void read_section(const std::string& word) {
        if (word == "metadata") return skip_metadata();
        if (word == "field") return read_field();
        if (word == "point_data" || word == "cell_data") return begin_data(word);
        if (in_data_) return read_attribute(word);
        if (word == "dimensions" || word == "extent") return read_dims(word);
        if (!rectilinear_ && (word == "spacing" || word == "aspect_ratio" || word == "origin")) {
            for (int axis = 0; axis < 3; ++axis)
                (word == "origin" ? grid.origin : grid.spacing)[axis] = number(word == "origin" ? "ORIGIN" : "SPACING");
            if (word != "origin") grid.source = word == "spacing" ? "ORIGIN, SPACING" : "ORIGIN, ASPECT_RATIO";
            return;
        }
        if (rectilinear_ && word.size() == 13 && word.ends_with("_coordinates") && word[0] >= 'x' && word[0] <= 'z') {
            const std::size_t tuples = count(word);
            const std::string type = keyword();
            arrays.clear();
            take(word, type, 1, tuples);
            coordinates_[static_cast<std::size_t>(word[0] - 'x')] = arrays.back();
            arrays.clear();
            return;
        }
        unexpected(word);
    }

    void read_dims(const std::string& word) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto first = word == "extent" ? number("EXTENT") : 0;
            const auto last = word == "extent" ? number("EXTENT") : static_cast<double>(count("DIMENSIONS")) - 1;
            constexpr double kMost = 2147483648.0;
            if (!(std::abs(first) <= kMost && std::abs(last) <= kMost && last >= first) || first != std::floor(first))
                fail("{}: DIMENSIONS or EXTENT gives {} to {} along {}: expected at least one point", path_, first,
                     last, "xyz"[axis]);
            grid.extent[2 * axis] = static_cast<std::int64_t>(first);
            grid.extent[2 * axis + 1] = static_cast<std::int64_t>(last);
        }
        has_dims_ = true;
    }

    void begin_data(const std::string& word) {
        const bool cells = word == "cell_data";
        const std::size_t given = count(cells ? "CELL_DATA" : "POINT_DATA");
        if (!has_dims_) fail("{}: {} before DIMENSIONS", path_, cells ? "CELL_DATA" : "POINT_DATA");
        in_data_ = true;
        of_cells_ = cells;
        const auto dims = vtk_dims(path_, grid.extent, cells);
        std::size_t samples = 1;
        for (const std::size_t n : dims)
            if (__builtin_mul_overflow(samples, n, &samples)) samples = std::numeric_limits<std::size_t>::max();
        if (given != samples)
            fail("{}: {} {}, but DIMENSIONS have {} {}", path_, cells ? "CELL_DATA" : "POINT_DATA", given, samples,
                 cells ? "cells" : "points");
        tuples_ = samples;
    }

    void skip_metadata() {
        rest_of_line();
        while (at_ < text_.size() && !rest_of_line().empty()) {
        }
    }

    void read_field() {
        word();  // its name
        const std::size_t fields = count("FIELD");
        for (std::size_t i = 0; i < fields; ++i) {
            std::string_view name = word();
            while (vtk_lower(name) == "metadata") {
                skip_metadata();
                name = word();
            }
            if (name.empty()) fail("{}: truncated: FIELD with {} of {} arrays", path_, i, fields);
            const std::size_t components = count("components"), tuples = count("tuples");
            const std::string type = keyword();
            take(vtk_decoded(name), type, components, tuples);
            if (!in_data_) arrays.pop_back();  // facts about the whole data set, such as its time
        }
    }

    void read_attribute(const std::string& word) {
        static constexpr std::array<std::pair<std::string_view, std::size_t>, 8> kKinds{{{"vectors", 3},
                                                                                         {"normals", 3},
                                                                                         {"tensors", 9},
                                                                                         {"tensors6", 6},
                                                                                         {"global_ids", 1},
                                                                                         {"pedigree_ids", 1},
                                                                                         {"edge_flags", 1},
                                                                                         {"scalars", 1}}};
        const auto* kind = std::ranges::find(kKinds, std::string_view(word), [](const auto& k) { return k.first; });
        if (kind == kKinds.end() && word != "color_scalars" && word != "lookup_table" && word != "texture_coordinates")
            unexpected(word);
        const std::string name = vtk_decoded(this->word());
        if (word == "lookup_table") {
            take(name, binary_ ? "unsigned_char" : "float", 4, count("LOOKUP_TABLE"));
            arrays.pop_back();
        } else if (word == "color_scalars") {
            const std::size_t components = count("COLOR_SCALARS");
            take(name, "unsigned_char", components, tuples_);
            arrays.back().array.is_scalars = true;
            arrays.back().color_text = !binary_;
        } else if (word == "texture_coordinates") {
            const std::size_t components = count("TEXTURE_COORDINATES");
            take(name, keyword(), components, tuples_);
        } else if (word == "scalars") {
            read_scalars(name);
        } else {
            take(name, keyword(), kind->second, tuples_);
        }
    }

    void read_scalars(const std::string& name) {
        const std::string type = keyword(), rest = rest_of_line();
        std::int64_t components = 1;
        if (!rest.empty() && (!vtk_number(rest, components) || components < 1))
            fail("{}: SCALARS {} {} '{}': expected a number of components", path_, name, type, tidy(rest));
        // Some programs leave the line with the lookup table out; then samples may follow, whatever their bytes.
        const std::size_t line = at_;
        if (keyword_ahead() == "lookup_table") {
            keyword();
            word();
            rest_of_line();
        } else {
            at_ = line;
        }
        take(name, type, static_cast<std::size_t>(components), tuples_, true);
        arrays.back().array.is_scalars = true;
    }

    std::string keyword_ahead() const {
        auto rest = text_.substr(at_, 64);
        return vtk_lower(next_vtk_word(rest));
    }

    // Appends an array, and goes to the end of its samples. `at_samples`: the line before them is read already.
    void take(const std::string& name, const std::string& type_name, std::size_t components, std::size_t tuples,
              bool at_samples = false) {
        struct Type {
            std::string_view name;
            SampleType type;
        };
        static constexpr std::array kTypes{
            Type{"unsigned_char", SampleType::UInt8}, Type{"char", SampleType::Int8},
            Type{"signed_char", SampleType::Int8},    Type{"unsigned_short", SampleType::UInt16},
            Type{"short", SampleType::Int16},         Type{"unsigned_int", SampleType::UInt32},
            Type{"int", SampleType::Int32},           Type{"vtkidtype", SampleType::Int32},
            Type{"vtktypeint64", SampleType::Int64},  Type{"vtktypeuint64", SampleType::UInt64},
            Type{"long_long", SampleType::Int64},     Type{"unsigned_long_long", SampleType::UInt64},
            Type{"float", SampleType::Float32},       Type{"double", SampleType::Float64}};
        Stored stored;
        stored.array.name = name;
        stored.array.of_cells = of_cells_;
        stored.array.type_name = type_name;
        stored.array.components = components;
        stored.tuples = tuples;
        const auto* known = std::ranges::find(kTypes, std::string_view(type_name), &Type::name);
        if (known != kTypes.end()) stored.array.type = known->type;
        const bool is_unsigned = type_name == "unsigned_long";
        if (type_name == "long" || is_unsigned) {
            if (long_bytes_ == 8) stored.array.type = is_unsigned ? SampleType::UInt64 : SampleType::Int64;
            if (long_bytes_ == 4) stored.array.type = is_unsigned ? SampleType::UInt32 : SampleType::Int32;
        }
        const bool texts = type_name == "string" || type_name == "utf8_string" || type_name == "unicode_string";
        const bool bits = type_name == "bit";
        if (!stored.array.type && !texts && !bits)
            fail(
                "{}: array {} of type '{}': expected bit, char, short, int, long, vtktypeint64, float, double or one "
                "of their unsigned kinds",
                path_, name, tidy(type_name));
        std::size_t samples = 0, bytes = 0;
        if (__builtin_mul_overflow(components, tuples, &samples) ||
            __builtin_mul_overflow(samples, bits || texts ? 1 : size_of(*stored.array.type), &bytes))
            fail("{}: array {}: {} components of {} samples, but the file has {} bytes", path_, name, components,
                 tuples, text_.size());
        if (components == 0) fail("{}: array {} with 0 components: expected at least 1", path_, name);
        if ((binary_ || texts) && !at_samples) rest_of_line();
        stored.begin = at_;
        if (texts) {
            skip_texts(name, samples);
        } else if (binary_) {
            if (bits) bytes = (bytes + 7) / 8;
            if (bytes > text_.size() - at_)
                fail("{}: truncated: array {} with {} of {} bytes", path_, name, text_.size() - at_, bytes);
            at_ += bytes;
        } else {
            for (std::size_t i = 0; i < samples; ++i)
                if (word().empty()) fail("{}: truncated: array {} with {} of {} values", path_, name, i, samples);
        }
        stored.end = at_;
        arrays.push_back(std::move(stored));
    }

    // Texts: a line each, or a length of 1 to 8 bytes whose first two bits say how long it is.
    void skip_texts(const std::string& name, std::size_t texts) {
        for (std::size_t i = 0; i < texts; ++i) {
            if (at_ >= text_.size()) fail("{}: truncated: array {} with {} of {} texts", path_, name, i, texts);
            if (!binary_) {
                rest_of_line();
                continue;
            }
            const auto first = static_cast<unsigned char>(text_[at_]);
            const std::size_t width = std::size_t{1} << (3 - (first >> 6));
            std::size_t length = first & 63U;
            if (width > text_.size() - at_) fail("{}: truncated: array {}", path_, name);
            for (std::size_t byte = 1; byte < width; ++byte)
                length = length << 8 | static_cast<unsigned char>(text_[at_ + byte]);
            at_ += width;
            if (length > text_.size() - at_)
                fail("{}: truncated: array {} with a text of {} bytes", path_, name, length);
            at_ += length;
        }
    }

    const std::string& path_;
    std::string_view text_;
    std::size_t at_ = 0, long_bytes_ = 8;
    bool binary_ = false, rectilinear_ = false, has_dims_ = false;
    bool in_data_ = false, of_cells_ = false;
    std::size_t tuples_ = 0;
    std::array<Stored, 3> coordinates_;
};

// Programs on Windows wrote 4 bytes for C's long, others 8: the one with which the file makes sense is right.
VtkLegacyFile vtk_legacy_file(const std::string& path, std::string_view text) {
    try {
        return {path, text, 8};
    } catch (const Error&) {
        if (text.find("long") == std::string_view::npos) throw;
        try {
            return {path, text, 4};
        } catch (const Error&) {
        }
        throw;
    }
}

}  // namespace

Volume load_vtk_legacy(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    const MappedFile mapped(path);
    VtkLegacyFile file = vtk_legacy_file(path, mapped.bytes());
    Volume volume;
    std::vector<VtkArray> arrays;
    for (const auto& stored : file.arrays)
        arrays.push_back(stored.array);
    const auto& chosen = file.arrays[chosen_vtk_array(path, options, arrays, volume)];
    if (!chosen.array.type)
        fail("{}: array {} of type {} cannot be read; expected numbers of whole bytes", path, chosen.array.name,
             chosen.array.type_name);
    const auto dims = vtk_dims(path, file.grid.extent, chosen.array.of_cells);
    const std::size_t voxels = checked_bytes(path, dims, chosen.array.components * size_of(*chosen.array.type)) /
                               (chosen.array.components * size_of(*chosen.array.type));
    if (chosen.tuples != voxels)
        fail("{}: array {} has {} values, expected {}", path, chosen.array.name, chosen.tuples, voxels);
    const auto component = chosen_component(path, options, chosen.array.components);
    (void)chosen_frame(path, options, 1);
    std::vector<std::byte> kept;
    if (file.rectilinear()) {
        const auto points = vtk_dims(path, file.grid.extent, false);
        for (int axis = 0; axis < 3; ++axis) {
            const auto& stored = file.coordinates(axis);
            const std::size_t expected = points[static_cast<std::size_t>(axis)];
            if (stored.tuples != expected || !stored.array.type)
                fail("{}: {} {}_COORDINATES, but DIMENSIONS say {}", path, stored.tuples,
                     "XYZ"[static_cast<std::size_t>(axis)], expected);
            const std::byte* samples = file.samples(stored, kept);
            const bool exact = file.binary() && stored.array.type != SampleType::Float32;
            set_vtk_coordinates(path, axis, vtk_doubles(*stored.array.type, samples, expected, file.swapped()),
                                exact ? 1e-12 : 2.4e-7, file.grid, volume);
        }
    } else {
        check_vtk_spacing(path, file.grid, volume);
    }
    set_vtk_place(path, file.grid, chosen.array.of_cells, volume);
    report(options, 0.3, "reading voxels");
    const std::byte* samples = file.samples(chosen, kept);
    take_samples({.type = *chosen.array.type,
                  .data = samples + component * size_of(*chosen.array.type),
                  .stride = chosen.array.components,
                  .swapped = file.swapped()},
                 volume);
    // A number that ends with the file may be the beginning of a longer one.
    if (!file.binary() && chosen.end == mapped.bytes().size())
        volume.warnings.push_back(
            fmt::format("{}: the file ends with its last number, without a new line: truncated?", path));
    for (const auto& mask : file.arrays)
        if (is_vtk_mask(mask.array) && mask.array.of_cells == chosen.array.of_cells && mask.tuples == voxels) {
            const std::byte* values = file.samples(mask, kept);
            for (std::size_t i = 0; i < voxels; ++i)
                if (vtk_mask_hides(mask.array, static_cast<unsigned char>(values[i])))
                    volume.values[i] = std::numeric_limits<float>::quiet_NaN();
        }
    return volume;
}

}  // namespace edgesplat::detail
