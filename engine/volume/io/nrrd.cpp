// Reads NRRD through ITK. This code adds what ITK's copy of the NRRD library lacks:
//  - it unpacks bzip2 data (ITK is built without bzip2);
//  - it adds the kind "list" to a fourth axis without direction ("none"), which ITK refuses otherwise;
//  - it checks the header's files and skips, so that the message names the field.
// ITK then reads a small detached header that refers to the original data file; voxels are not copied.
#include <bzlib.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <sstream>

#include "engine/volume/pack_source_internal.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxHeader = 1 << 20;

struct NrrdHeader {
    std::string magic;
    std::vector<std::pair<std::string, std::string>> fields;  // key as in the file, value
    std::map<std::string, std::string> values;                // lower-case key without blanks -> value
    std::vector<std::string> listed_files;                    // lines after "data file: LIST"
    int line_count = 0;                                       // lines before the data, including the blank one
    std::size_t data_offset = 0;

    bool has(const std::string& key) const { return values.count(key) > 0; }
    std::string value(const std::string& key) const {
        const auto found = values.find(key);
        return found == values.end() ? "" : found->second;
    }
    bool detached() const { return has("datafile"); }
};

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) {
        // "(1, 0, 0)" is one word despite its blanks
        while (word.front() == '(' && word.back() != ')') {
            std::string more;
            if (!(stream >> more)) break;
            word += more;
        }
        words.push_back(word);
    }
    return words;
}

NrrdHeader nrrd_header(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    NrrdHeader header;
    std::string line;
    std::getline(file, line);
    header.magic = trimmed(line);
    header.line_count = 1;
    bool in_list = false;
    while (static_cast<std::size_t>(file.tellg()) < kMaxHeader && std::getline(file, line)) {
        ++header.line_count;
        line = trimmed(line);
        if (line.empty()) break;
        if (in_list) {
            header.listed_files.push_back(line);
            continue;
        }
        const auto colon = line.find(": ");
        if (line.front() == '#' || colon == std::string::npos || line.find(":=") < colon) continue;
        std::string key;
        for (const char c : line.substr(0, colon))
            if (c != ' ') key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const auto value = trimmed(line.substr(colon + 2));
        header.fields.emplace_back(line.substr(0, colon), value);
        header.values[key] = value;
        in_list = key == "datafile" && value.rfind("LIST", 0) == 0;
    }
    header.data_offset = file.good() ? static_cast<std::size_t>(file.tellg()) : 0;
    return header;
}

long long number(const std::string& path, const std::string& what, const std::string& text) {
    std::size_t used = 0;
    long long value = 0;
    try {
        value = std::stoll(text, &used);
    } catch (const std::exception&) {
        used = std::string::npos;
    }
    if (used != text.size()) fail("{}: NRRD field '{}': '{}' is not a whole number", path, what, text);
    return value;
}

// All data files, in order; the header itself if the data are attached.
std::vector<fs::path> data_files(const std::string& path, const NrrdHeader& header) {
    if (!header.detached()) return {path};
    const auto folder = fs::path(path).parent_path();
    const auto value = header.value("datafile");
    std::vector<fs::path> files;
    const auto words = words_of(value);
    if (value.rfind("LIST", 0) == 0) {
        if (header.listed_files.empty()) fail("{}: NRRD field 'data file': LIST without any file", path);
        for (const auto& name : header.listed_files)
            files.push_back(folder / name);
    } else if (words.size() >= 4 && value.find('%') != std::string::npos) {
        const long long first = number(path, "data file", words[1]), last = number(path, "data file", words[2]),
                        step = number(path, "data file", words[3]);
        // Bounded so that their differences do not overflow.
        constexpr long long kMost = 1'000'000'000;
        const auto sane = [](long long n) { return n >= -kMost && n <= kMost; };
        if (!sane(first) || !sane(last) || !sane(step) || step == 0 || (last - first) / step < 0 ||
            (last - first) / step > 1'000'000)
            fail("{}: NRRD field 'data file': {} to {} in steps of {} is not a valid range of files", path, first, last,
                 step);
        for (long long i = first; step > 0 ? i <= last : i >= last; i += step) {
            std::vector<char> name(words[0].size() + 64);
            std::snprintf(name.data(), name.size(), fmt::format("{}", words[0]).c_str(), static_cast<int>(i));
            files.push_back(folder / name.data());
        }
    } else {
        files.push_back(folder / value);
    }
    for (const auto& file : files) {
        std::error_code error;
        if (!fs::is_regular_file(file, error))
            fail("{}: its data file {} {}", path, file.string(), error ? error.message() : "is not a file");
    }
    return files;
}

// The pattern is passed to printf: it must contain one integer conversion and nothing else that printf interprets.
void check_pattern(const std::string& path, const std::string& value) {
    const auto pattern = words_of(value).empty() ? std::string() : words_of(value)[0];
    const auto percent = pattern.find('%');
    if (percent == std::string::npos || value.rfind("LIST", 0) == 0) return;
    auto end = percent + 1;
    while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end])) != 0)
        ++end;
    const bool good = end < pattern.size() && end - percent < 4 && (pattern[end] == 'd' || pattern[end] == 'u') &&
                      pattern.find('%', end) == std::string::npos;
    if (!good) fail("{}: NRRD field 'data file': '{}' must hold one number like %03d", path, pattern);
}

void unpack_bzip2(const std::string& path, const fs::path& source, std::size_t offset, long long line_skip,
                  std::size_t wanted, const fs::path& target) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(source.c_str(), "rb"), &std::fclose);
    std::ofstream out(target, std::ios::binary);
    if (!in || !out) fail("{}: cannot open {} or a temporary file", path, source.string());
    std::fseek(in.get(), static_cast<long>(offset), SEEK_SET);
    for (int c = 0; line_skip > 0 && (c = std::fgetc(in.get())) != EOF;)
        if (c == '\n') --line_skip;
    int status = BZ_OK;
    BZFILE* packed = BZ2_bzReadOpen(&status, in.get(), 0, 0, nullptr, 0);
    std::vector<char> buffer(1 << 16);
    std::size_t total = 0;
    while (status == BZ_OK && total < wanted) {
        const int count = BZ2_bzRead(&status, packed, buffer.data(), static_cast<int>(buffer.size()));
        if (status != BZ_OK && status != BZ_STREAM_END) break;
        out.write(buffer.data(), count);
        total += static_cast<std::size_t>(count);
    }
    int ignored = BZ_OK;
    BZ2_bzReadClose(&ignored, packed);
    if (total < wanted) fail("{}: its bzip2 data give {} of {} bytes: truncated or damaged", path, total, wanted);
    if (!out.flush()) fail("{}: cannot write a temporary file of {} bytes", path, total);
}

std::size_t bytes_of_type(const std::string& type) {
    const auto holds = [&](const char* part) { return type.find(part) != std::string::npos; };
    if (holds("char") || holds("int8")) return 1;
    if (holds("short") || holds("int16")) return 2;
    if (holds("longlong") || holds("long long") || holds("int64") || holds("double")) return 8;
    return 4;
}

// The kinds that make ITK read `list_axis` as components; an existing list kind is kept.
std::string kinds_with_list(const NrrdHeader& header, std::size_t axes, std::size_t list_axis) {
    auto kinds = words_of(header.value("kinds"));
    kinds.resize(axes, "domain");
    kinds[list_axis] = "list";
    std::string text;
    for (const auto& kind : kinds)
        text += (text.empty() ? "" : " ") + (kind == "???" ? "domain" : kind);
    return text;
}

}  // namespace

std::optional<FileLayout> nrrd_layout(const std::string& path, Volume& description) {
    const auto header = nrrd_header(path);
    const auto sizes = words_of(header.value("sizes"));
    const bool of_one_file = header.listed_files.empty() && header.value("datafile").find('%') == std::string::npos;
    const bool plain = header.value("encoding") == "raw" && sizes.size() == 3 && of_one_file &&
                       header.value("spacedirections").find("none") == std::string::npos &&
                       (!header.has("lineskip") || header.value("lineskip") == "0");
    // load_nrrd asks the user whether a first axis of 2 to 4 is colour or space.
    if (!plain || (sizes[0].size() == 1 && sizes[0][0] <= '4')) return std::nullopt;
    const auto type = describe_through_itk({.format = ItkFormat::Nrrd, .path = path}, description);
    if (!type) return std::nullopt;
    FileLayout layout{data_files(path, header)[0].string(), header.detached() ? 0 : header.data_offset, *type, false};
    const long long byte_skip = header.has("byteskip") ? number(path, "byte skip", header.value("byteskip")) : 0;
    const std::size_t needed = description.geometry.voxel_count() * size_of(*type), stored = fs::file_size(layout.file);
    if (byte_skip < -1 || needed > stored) return std::nullopt;
    layout.offset = byte_skip < 0 ? stored - needed : layout.offset + static_cast<std::size_t>(byte_skip);
    layout.swapped =
        header.has("endian") && (header.value("endian") == "little") != (std::endian::native == std::endian::little);
    return layout;
}

Volume load_nrrd(const std::string& path, const LoadOptions& options) {
    const auto header = nrrd_header(path);
    const long long byte_skip = header.has("byteskip") ? number(path, "byte skip", header.value("byteskip")) : 0;
    const long long line_skip = header.has("lineskip") ? number(path, "line skip", header.value("lineskip")) : 0;
    if (byte_skip < -1) fail("{}: NRRD field 'byte skip': {} is neither -1 nor a count of bytes", path, byte_skip);
    if (line_skip < 0) fail("{}: NRRD field 'line skip': {} is not a count of lines", path, line_skip);
    std::vector<std::size_t> sizes;
    for (const auto& word : words_of(header.value("sizes"))) {
        const auto size = number(path, "sizes", word);
        if (size < 1) fail("{}: NRRD field 'sizes': {} must be at least 1", path, size);
        sizes.push_back(static_cast<std::size_t>(size));
    }
    if (sizes.size() > 4) fail("{}: NRRD data with {} axes: at most 4 can be read", path, sizes.size());
    const std::size_t item = bytes_of_type(header.value("type"));
    if (!sizes.empty()) checked_bytes(path, sizes, item);  // replaces ITK's message of ten lines
    check_pattern(path, header.value("datafile"));
    const auto files = data_files(path, header);
    std::size_t stored = 0;
    for (const auto& file : files)
        stored += fs::file_size(file);
    const auto encoding = header.value("encoding");
    const bool bzip2 = encoding == "bzip2" || encoding == "bz2";

    ItkRequest request{.format = ItkFormat::Nrrd, .path = path, .stored_bytes = bzip2 ? 0 : stored};
    if (encoding != "gzip" && encoding != "gz") request.stored_ratio = kPlainRatio;
    LoadOptions rest = options;
    std::string kinds;
    std::vector<std::string> notes;
    const auto directions = words_of(header.value("spacedirections"));
    if (!directions.empty() && directions.size() != sizes.size())
        fail("{}: NRRD field 'space directions': {} of them for {} axes", path, directions.size(), sizes.size());
    const auto none = std::find(directions.begin(), directions.end(), "none");
    const auto list = words_of(header.value("kinds"));
    const bool colour_sized = sizes.size() == 3 && sizes[0] >= 2 && sizes[0] <= 4;
    const bool says_nothing = !header.has("kinds") && !header.has("spacings") && !header.has("spacedirections");
    if (colour_sized && says_nothing && sizes[1] > 8 && sizes[2] > 8) {
        // Ambiguous: a volume of three planes, or a colour picture.
        if (!options.component)
            fail(
                "{}: its header does not say whether the first axis of {} is colour or space: choose a colour with "
                "--component 0..{}, or add 'kinds: domain domain domain' to the header",
                path, sizes[0], sizes[0] - 1);
        kinds = kinds_with_list(header, 3, 0);
    } else if (sizes.size() == 4 && none != directions.end()) {
        const auto axis = static_cast<std::size_t>(none - directions.begin());
        const bool time = axis >= list.size() || list[axis] == "time" || list[axis] == "domain" || list[axis] == "???";
        kinds = kinds_with_list(header, 4, axis);
        // For ITK the axis is components; for the user it is time unless the header says otherwise.
        if (time) {
            rest.component = static_cast<int>(chosen_frame(path, options, sizes[axis]));
            rest.frame.reset();
        }
    }

    std::optional<TemporaryFolder> folder;
    if (bzip2 || !kinds.empty()) {
        folder.emplace();
        const std::size_t total = checked_bytes(path, sizes, item);
        std::string data = header.value("datafile");
        long long lines = line_skip;
        if (bzip2) {
            if (files.size() != 1) fail("{}: bzip2 data in several files cannot be read", path);
            report(options, 0.02, "unpacking bzip2");
            const auto target = folder->path() / "data.raw";
            const auto skip = static_cast<std::size_t>(std::max(byte_skip, 0LL));
            unpack_bzip2(path, files[0], header.detached() ? 0 : header.data_offset, line_skip, total + skip, target);
            data = target.string();
            lines = 0;
        } else if (files.size() == 1) {
            data = fs::absolute(files[0]).string();
            if (!header.detached()) lines += header.line_count;
        } else {
            data = "LIST";
        }
        const auto patched = folder->path() / "header.nhdr";
        std::ofstream out(patched);
        out << "NRRD0005\n";
        for (const auto& [key, value] : header.fields) {
            std::string plain;
            for (const char c : key)
                if (c != ' ') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            if (plain == "datafile" || plain == "lineskip" || (plain == "kinds" && !kinds.empty())) continue;
            out << key << ": " << (plain == "encoding" && bzip2 ? "raw" : value) << '\n';
        }
        if (!kinds.empty()) out << "kinds: " << kinds << '\n';
        if (lines > 0) out << "line skip: " << lines << '\n';
        out << "data file: " << data << '\n';
        if (data == "LIST")
            for (const auto& file : files)
                out << fs::absolute(file).string() << '\n';
        request.read_path = patched.string();
    }

    const auto data_name = files[0].string();
    const bool nifti = data_name.ends_with(".nii") || data_name.ends_with(".nii.gz");
    if (header.detached() && nifti && byte_skip == 0 && line_skip == 0)
        notes.push_back(
            "Its data file is a NIfTI file and the header has no 'byte skip', so the NIfTI header is read as "
            "voxels, as the NRRD header says; 'byte skip: -1' would skip it.");
    auto volume = load_through_itk(request, rest);
    volume.notes.insert(volume.notes.end(), notes.begin(), notes.end());
    return volume;
}

}  // namespace edgesplat::detail
