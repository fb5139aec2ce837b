// Reads NumPy's .npy and .npz. Neither has a geometry.
#include <archive.h>
#include <archive_entry.h>

#include <charconv>
#include <cmath>
#include <fstream>

#include "engine/volume/io/arrays.h"
#include "engine/volume/io/binary_file.h"
#include "engine/volume/io/half.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNpyMaxHeader = std::size_t{1} << 16;
constexpr std::string_view kNpyMagic = "\x93NUMPY";

struct NpyHeader {
    std::string descr;  // e.g. "<f4"
    bool fortran_order = false;
    std::vector<std::size_t> shape;
    std::size_t data_offset = 0;

    std::string shape_text() const { return fmt::format("({})", fmt::join(shape, ", ")); }
};

// Parses the header's Python literal: a dict with the keys descr, fortran_order and shape, each once.
class NpyParser {
  public:
    NpyParser(const std::string& path, std::string_view text) : path_(path), text_(text) {}

    NpyHeader parse() {
        NpyHeader header;
        expect('{');
        int seen = 0;
        while (!accept('}')) {
            const std::string key = string();
            expect(':');
            if (key == "descr") {
                if (!at_string()) fail("{}: its samples are records (a structured dtype), expected numbers", path_);
                header.descr = string();
                seen |= 1;
            } else if (key == "fortran_order") {
                const std::string value = word();
                if (value != "True" && value != "False") wrong("True or False");
                header.fortran_order = value == "True";
                seen |= 2;
            } else if (key == "shape") {
                header.shape = shape();
                seen |= 4;
            } else {
                fail("{}: NumPy header: key '{}', expected descr, fortran_order and shape", path_, tidy(key));
            }
            if (!accept(',')) {
                expect('}');
                break;
            }
        }
        skip();
        if (at_ < text_.size()) wrong("the end of the header");
        if (seen != 7) fail("{}: NumPy header: descr, fortran_order or shape is missing", path_);
        return header;
    }

  private:
    [[noreturn]] void wrong(std::string_view expected) const {
        fail("{}: NumPy header: expected {} at '{}'", path_, expected, tidy(text_.substr(at_, 20)));
    }
    void skip() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t'))
            ++at_;
    }
    bool accept(char c) {
        skip();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    void expect(char c) {
        if (!accept(c)) wrong(fmt::format("'{}'", c));
    }
    bool at_string() {
        skip();
        return at_ < text_.size() && (text_[at_] == '\'' || text_[at_] == '"');
    }
    std::string string() {
        if (!at_string()) wrong("a string");
        const auto end = text_.find(text_[at_], at_ + 1);
        if (end == std::string_view::npos) wrong("a closed string");
        std::string value(text_.substr(at_ + 1, end - at_ - 1));
        if (value.find('\\') != std::string::npos) wrong("a string without escapes");
        at_ = end + 1;
        return value;
    }
    std::string word() {
        skip();
        const std::size_t begin = at_;
        while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_])) != 0)
            ++at_;
        return std::string(text_.substr(begin, at_ - begin));
    }
    std::vector<std::size_t> shape() {
        std::vector<std::size_t> sides;
        expect('(');
        while (!accept(')')) {
            skip();
            std::size_t side = 0;
            const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), side);
            if (error != std::errc()) wrong("a length of the shape");
            at_ = static_cast<std::size_t>(end - text_.data());
            accept('L');  // long integers of Python 2
            sides.push_back(side);
            if (sides.size() > 32) wrong("at most 32 axes");
            if (!accept(',')) {
                expect(')');
                break;
            }
        }
        return sides;
    }

    const std::string& path_;
    std::string_view text_;
    std::size_t at_ = 0;
};

// `head`: the file's first bytes, up to kNpyMaxHeader.
NpyHeader npy_header(const std::string& path, std::string_view head) {
    if (!head.starts_with(kNpyMagic)) fail("{}: not a NumPy array: it does not begin with \\x93NUMPY", path);
    const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(head[at])); };
    if (head.size() < 12) fail("{}: truncated: {} bytes of a NumPy header", path, head.size());
    const std::size_t version = byte(6);
    if (version < 1 || version > 3) fail("{}: NumPy format version {}, expected 1, 2 or 3", path, version);
    const std::size_t begin = version == 1 ? 10 : 12;
    std::size_t length = byte(8) | byte(9) << 8;
    if (version > 1) length |= byte(10) << 16 | byte(11) << 24;
    if (length > kNpyMaxHeader - begin)
        fail("{}: NumPy header of {} bytes, expected at most {}", path, length, kNpyMaxHeader - begin);
    if (begin + length > head.size())
        fail("{}: truncated: {} of {} bytes of a NumPy header", path, head.size() - begin, length);
    NpyHeader header = NpyParser(path, head.substr(begin, length)).parse();
    header.data_offset = begin + length;
    return header;
}

struct NpyType {
    std::string_view code;  // without byte order
    std::string_view name;
    SampleType sample;
    std::size_t components = 1;
};
constexpr std::array kNpyTypes{
    NpyType{"b1", "bool", SampleType::UInt8},           NpyType{"i1", "int8", SampleType::Int8},
    NpyType{"u1", "uint8", SampleType::UInt8},          NpyType{"i2", "int16", SampleType::Int16},
    NpyType{"u2", "uint16", SampleType::UInt16},        NpyType{"i4", "int32", SampleType::Int32},
    NpyType{"u4", "uint32", SampleType::UInt32},        NpyType{"i8", "int64", SampleType::Int64},
    NpyType{"u8", "uint64", SampleType::UInt64},        NpyType{"f2", "float16", SampleType::UInt16},  // unpacked here
    NpyType{"f4", "float32", SampleType::Float32},      NpyType{"f8", "float64", SampleType::Float64},
    NpyType{"c8", "complex64", SampleType::Float32, 2}, NpyType{"c16", "complex128", SampleType::Float64, 2}};

const NpyType& npy_type(const std::string& path, const std::string& descr) {
    if (!descr.empty() && std::string_view("<>|=").find(descr[0]) != std::string_view::npos)
        for (const NpyType& type : kNpyTypes)
            if (descr.substr(1) == type.code && (descr[0] != '|' || type.code.ends_with('1'))) return type;
    std::string_view reason = "expected numbers: b1, i1 to i8, u1 to u8, f2, f4, f8, c8 or c16";
    if (descr.find('O') != std::string::npos) reason = "Python objects, which only Python can read";
    fail("{}: samples of type '{}': {}", path, tidy(descr), reason);
}

// An axis of the array: its length, and how far apart its entries are in the file.
struct NpyAxis {
    std::size_t size = 1, stride = 1;
};

// Which part of an array is the volume.
struct NpyChoice {
    std::array<NpyAxis, 3> axes;  // z, y, x
    std::size_t first = 0;        // the first sample
};

// Drops axes before z,y,x (time, --frame) and after (components, --component).
NpyChoice chosen_part(const std::string& path, const LoadOptions& options, const NpyHeader& header,
                      std::size_t type_components, Volume& volume) {
    std::vector<NpyAxis> axes;
    for (const std::size_t side : header.shape)
        axes.push_back({side, 1});
    std::size_t stride = type_components;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        NpyAxis& axis = axes[header.fortran_order ? i : axes.size() - 1 - i];
        axis.stride = stride;
        stride *= axis.size;
    }
    NpyChoice choice;
    LoadOptions rest = options;
    const std::string shape = header.shape_text();
    const bool is_complex = type_components > 1;
    if (is_complex) {
        choice.first = chosen_component(path, options, type_components);
        rest.component.reset();
    }
    const bool has_time = axes.size() > 3 && rest.frame, has_components = axes.size() > 3 && rest.component;
    if (has_components) {
        choice.first += axes.back().stride * chosen_component(path, rest, axes.back().size);
        axes.pop_back();
        rest.component.reset();
    }
    if (has_time && axes.size() > 3) {
        choice.first += axes.front().stride * chosen_frame(path, rest, axes.front().size);
        axes.erase(axes.begin());
        rest.frame.reset();
    }
    while (axes.size() > 3 && axes.front().size == 1)
        axes.erase(axes.begin());
    while (axes.size() > 3 && axes.back().size == 1)
        axes.pop_back();
    if (axes.size() > 5 || (axes.size() > 4 && (has_time || has_components)))
        fail("{}: shape {}: {} axes, expected z, y, x, with time before and components after", path, shape,
             header.shape.size());
    if (axes.size() == 5)
        fail("{}: shape {}: choose with --frame 0..{} (first axis) and --component 0..{} (last axis)", path, shape,
             axes.front().size - 1, axes.back().size - 1);
    if (axes.size() == 4)
        fail(
            "{}: shape {}: choose one volume with --frame 0..{} if the first axis is time or channels, or with "
            "--component 0..{} if the last axis is components",
            path, shape, axes.front().size - 1, axes.back().size - 1);
    (void)chosen_component(path, rest, 1);
    (void)chosen_frame(path, rest, 1);
    if (axes.size() < 2)
        fail("{}: shape {}: {} {}; a volume needs 3 (z, y, x), or 2 for a single slice", path, shape, axes.size(),
             axes.size() == 1 ? "axis" : "axes");
    if (axes.size() == 2) {
        axes.insert(axes.begin(), NpyAxis{});
        volume.notes.emplace_back("The array is 2-D: it is read as a volume of one slice, 1 mm thick.");
    } else if (const auto warning = colour_warning({axes[0].size, axes[1].size, axes[2].size}, shape);
               !has_components && !warning.empty()) {
        volume.warnings.push_back(warning);
    }
    std::copy_n(axes.begin(), 3, choice.axes.begin());
    return choice;
}

Volume npy_volume(const std::string& path, const std::string& name, const LoadOptions& options) {
    const NpyHeader header = npy_header(name, first_unpacked_bytes(path, kNpyMaxHeader));
    const NpyType& type = npy_type(name, header.descr);
    const std::size_t item = size_of(type.sample);
    Volume volume;
    volume.name = name;
    volume.stored_type = type.name;
    std::size_t samples = type.components;
    for (const std::size_t side : header.shape)
        if (__builtin_mul_overflow(samples, side, &samples) || samples > std::size_t{1} << 40)
            fail("{}: shape {}: more than 2^40 samples", name, header.shape_text());
    if (samples == 0) fail("{}: shape {}: an axis has no entries", name, header.shape_text());
    const NpyChoice choice = chosen_part(name, options, header, type.components, volume);
    const auto& [z, y, x] = choice.axes;
    checked_bytes(name, {x.size, y.size, z.size, samples / (x.size * y.size * z.size)}, std::max<std::size_t>(item, 4));
    volume.geometry.dims = glm::ivec3(x.size, y.size, z.size);

    auto data = read_block({.path = name, .file = path, .offset = header.data_offset, .bytes = samples * item}, options,
                           volume.notes);
    report(options, 0.7, "converting voxels");
    const bool is_big = header.descr[0] == '>';
    StoredSamples stored{.type = type.sample, .swapped = is_big != (std::endian::native == std::endian::big)};
    if (header.descr[0] == '|' || header.descr[0] == '=') stored.swapped = false;
    // The volume's samples in its own order, x fastest.
    const std::size_t count = volume.geometry.voxel_count();
    std::vector<char> ordered;
    if (choice.first > 0 || x.stride != 1 || y.stride != x.size || z.stride != x.size * y.size) {
        ordered.resize(count * item);
        char* to = ordered.data();
        for (std::size_t k = 0; k < z.size; ++k)
            for (std::size_t j = 0; j < y.size; ++j)
                for (std::size_t i = 0; i < x.size; ++i, to += item)
                    std::memcpy(to, &data[(choice.first + k * z.stride + j * y.stride + i * x.stride) * item], item);
        data = std::move(ordered);
    }
    std::vector<float> halves;
    stored.data = data.data();
    if (type.name == "float16") {
        halves.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<unsigned char, 2> raw{};
            std::memcpy(raw.data(), &data[2 * i], 2);
            if (stored.swapped) std::swap(raw[0], raw[1]);
            halves[i] = float_of_half(std::bit_cast<std::uint16_t>(raw));
        }
        stored = {.type = SampleType::Float32, .data = halves.data()};
    }
    take_samples(stored, volume);
    set_place(volume, glm::dmat3(1), glm::dvec3(0), 1, "none: 1 mm assumed");
    if (!options.spacing)
        volume.notes.emplace_back("NumPy arrays have no geometry: voxels of 1 mm are assumed; give --spacing.");
    return volume;
}

struct NpzArray {
    std::string name;
    std::string shape;  // for a list; empty if it is no array
};

// Calls work(entry's name without .npy, read) for each array; read(target, count) returns the bytes it got. Ends when
// work returns false.
template <typename Work>
void each_array(const std::string& path, const Work& work) {
    const std::unique_ptr<archive, int (*)(archive*)> in(archive_read_new(), &archive_read_free);
    archive_read_support_format_zip(in.get());
    const auto check = [&](la_ssize_t result) {
        if (result >= 0 || result == ARCHIVE_WARN) return result;
        const char* reason = archive_error_string(in.get());
        fail("{}: truncated or damaged .npz archive: {}", path,
             tidy(reason == nullptr ? "no reason is known" : reason));
    };
    check(archive_read_open_filename(in.get(), path.c_str(), 1 << 16));
    for (archive_entry* entry = nullptr; check(archive_read_next_header(in.get(), &entry)) != ARCHIVE_EOF;) {
        const char* full_name = archive_entry_pathname(entry);
        const std::string name = full_name == nullptr ? "" : full_name;
        if (archive_entry_filetype(entry) != AE_IFREG || !name.ends_with(".npy")) continue;
        if (archive_entry_is_encrypted(entry) != 0) fail("{}: its array {} is encrypted", path, name);
        const auto read = [&](char* target, std::size_t count) {
            std::size_t done = 0;
            while (done < count) {
                const auto got = check(archive_read_data(in.get(), target + done, count - done));
                if (got <= 0) break;
                done += static_cast<std::size_t>(got);
            }
            return done;
        };
        if (!work(name.substr(0, name.size() - 4), read)) return;
    }
}

}  // namespace

bool is_npy(const std::string& path) {
    return first_unpacked_bytes(path, kNpyMagic.size()) == kNpyMagic;
}

Volume load_npy(const std::string& path, const LoadOptions& options) {
    return npy_volume(path, path, options);
}

Volume load_npz(const std::string& path, const LoadOptions& options) {
    const std::string& member = options.inner;
    std::vector<NpzArray> arrays;
    each_array(path, [&](const std::string& name, const auto& read) {
        std::string head(kNpyMaxHeader, '\0');
        head.resize(read(head.data(), head.size()));
        std::string shape;
        try {
            const NpyHeader header = npy_header(path, head);
            shape = fmt::format(" {} {}", header.shape_text(), header.descr);
        } catch (const Error&) {
            shape = " (not readable)";
        }
        arrays.push_back({name, shape});
        return arrays.size() < 1000;
    });
    std::vector<std::string> names;
    for (const NpzArray& array : arrays)
        names.push_back(array.name + array.shape);
    const std::string list = tidy(fmt::format("{}", fmt::join(names, ", ")));
    if (arrays.empty()) fail("{}: a .npz archive without arrays", path);
    if (member.empty() && arrays.size() > 1)
        fail("{}: {} arrays: {}; choose one with {}:NAME", path, arrays.size(), list, path);
    const std::string wanted = member.empty() ? arrays[0].name : member;
    if (std::ranges::find(arrays, wanted, &NpzArray::name) == arrays.end())
        fail("{}: no array '{}'; it contains {}", path, wanted, list);

    // The array becomes a file of its own: it may be larger than memory allows, which its header says.
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "array.npy").string();
    const std::string shown = arrays.size() == 1 ? path : path + ":" + wanted;
    const std::size_t stored = fs::file_size(path);
    each_array(path, [&](const std::string& name, const auto& read) {
        if (name != wanted) return true;
        std::ofstream out(file, std::ios::binary);
        std::vector<char> part(1 << 18);
        std::size_t total = 0;
        while (const std::size_t got = read(part.data(), part.size())) {
            total += got;
            check_stored_size(shown, total, stored);
            check_memory(shown, "its array unpacked", total);
            out.write(part.data(), static_cast<std::streamsize>(got));
            report(options, 0.2, "unpacking");
        }
        out.close();
        if (!out) fail("{}: cannot write a temporary file of {} bytes", shown, total);
        return false;
    });
    return npy_volume(file, shown, options);
}

}  // namespace edgesplat::detail
