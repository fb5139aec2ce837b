// Reads MetaImage files through ITK, after checking the header: MetaIO accepts contradictory headers silently.
// Compressed voxels are unpacked here: MetaIO stops at CompressedDataSize, which is too small in some files (VTK's
// frogtissue.mhd), and leaves the remaining voxels uninitialised.
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <fstream>
#include <sstream>

#include "engine/volume/pack_source_internal.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

// Data files after "LIST", without trailing blank lines.
struct ListedFiles {
    std::size_t count = 0;
    std::size_t first_bad = std::string::npos, bad_length = 0;  // first line that is blank or too long

    void add(std::size_t line, std::size_t length) {
        if (length > 0) count = line + 1;
        if (first_bad != std::string::npos || (length > 0 && length <= 1000)) return;
        first_bad = line;
        bad_length = length;
    }
};

// Checks a list or pattern of data files. MetaIO copies each word into 80 bytes, counts words by blanks, and copies a
// line of a list into 1024 bytes. It passes the pattern to printf unchecked, and silently reads fewer files than there
// are slices.
void check_several(const std::string& path, const std::string& value, const ListedFiles& listed, std::size_t slices) {
    std::istringstream fits(value);
    for (std::string word; fits >> word;)
        if (word.size() > 79)
            fail("{}: ElementDataFile: a word of {} characters, expected at most 79", path, word.size());
    if (value.find("  ") != std::string::npos)
        fail("{}: ElementDataFile '{}': expected single blanks between its words", path, value);
    std::size_t files = listed.count;
    if (listed.first_bad < std::min(files, slices))
        fail("{}: ElementDataFile: line {} of the list has {} characters, expected 1 to 1000", path,
             listed.first_bad + 1, listed.bad_length);
    if (value.rfind("LIST", 0) != 0) {
        std::istringstream words(value);
        std::string pattern;
        long long first = 0, last = 0, step = 0;
        // MetaIO treats a missing or invalid step as 0 and divides by it.
        const bool numbers = static_cast<bool>(words >> pattern >> first >> last >> step);
        const auto percent = pattern.find('%');
        auto end = percent + 1;
        while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end])) != 0)
            ++end;
        if (end >= pattern.size() || end - percent > 4 || (pattern[end] != 'd' && pattern[end] != 'u') ||
            pattern.find('%', end) != std::string::npos || !numbers || !(words >> std::ws).eof() || step < 1 ||
            last < first || last - first > 1'000'000)
            fail("{}: ElementDataFile '{}': expected a name with one number like %03d, then first, last and step", path,
                 value);
        files = static_cast<std::size_t>((last - first) / step + 1);
    }
    if (files != slices) fail("{}: {} data files for {} slices", path, files, slices);
}

struct MetaHeader {
    std::vector<std::string> lines;  // all lines except compression and data file
    std::vector<std::size_t> dims;
    std::size_t axes = 0, spacings = 0, channels = 1;
    bool compressed = false, in_patient = false;
    std::string data_file;
    ListedFiles listed;
    std::size_t data_offset = 0;  // offset of data in the header's own file
    bool big_endian = false;
    bool plain = true;  // true: voxels are stored contiguously and unmodified
};

// MetaIO copies keys and values into fixed buffers without checking their length.
void check_line(const std::string& path, int number, const std::string& line) {
    const auto equals = line.find('=');
    const bool blank = line.find_first_not_of(" \t\r") == std::string::npos;
    const bool text = std::ranges::all_of(
        line, [](char c) { return static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\r'; });
    if (!text || (!blank && (equals > 80 || line.size() - equals > 4000)))
        fail("{}: not a MetaImage header: line {} is no 'key = value' of at most 80 and 4000 characters", path, number);
}

MetaHeader meta_header(const std::string& path) {
    MetaHeader header;
    std::ifstream file(path, std::ios::binary);
    int number = 0;
    for (std::string line; std::getline(file, line) && line.size() < 65536 && header.lines.size() < 10000;) {
        check_line(path, ++number, line);
        const auto equals = line.find('=');
        const auto key = trimmed(line.substr(0, equals));
        const auto value = equals == std::string::npos ? "" : trimmed(line.substr(equals + 1));
        std::istringstream words(value);
        if (key == "ElementDataFile") {
            header.data_file = value;
            header.data_offset = file.good() ? static_cast<std::size_t>(file.tellg()) : 0;
            if (value.rfind("LIST", 0) == 0)
                for (std::size_t i = 0; std::getline(file, line); ++i)
                    header.listed.add(i, trimmed(line).size());
            return header;
        }
        if (key == "NDims") words >> header.axes;
        if (key == "ElementNumberOfChannels") words >> header.channels;
        if (key == "DimSize")
            for (std::size_t n = 0; words >> n;)
                header.dims.push_back(n);
        if (key == "ElementSpacing")
            for (std::string word; words >> word;)
                ++header.spacings;
        if (key == "AnatomicalOrientation") header.in_patient = value.find_first_of("LRlr") != std::string::npos;
        const bool yes = !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
        if (key == "BinaryDataByteOrderMSB" || key == "ElementByteOrderMSB") header.big_endian = yes;
        if ((key == "BinaryData" && !yes) || (key == "HeaderSize" && value != "0") ||
            key.starts_with("ElementToIntensity"))
            header.plain = false;
        if (key == "CompressedData") header.compressed = yes;
        if (key != "CompressedData" && key != "CompressedDataSize") header.lines.push_back(line);
    }
    fail("{}: not a MetaImage header: it has no line 'ElementDataFile = ...'", path);
}

// Unpacks zlib or gzip data, at most `limit` bytes.
void inflate_file(const std::string& path, const fs::path& source, std::size_t offset, std::size_t limit,
                  const fs::path& target, const LoadOptions& options) {
    std::ifstream in(source, std::ios::binary);
    std::ofstream out(target, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(offset));
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 32) != Z_OK) fail("{}: zlib cannot be started", path);
    const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&stream, &inflateEnd);
    std::vector<char> packed(1 << 16), unpacked(1 << 18);
    const auto size = static_cast<double>(fs::file_size(source));
    std::size_t taken = 0, total = 0;
    int status = Z_OK;
    while (status == Z_OK && total < limit) {
        in.read(packed.data(), static_cast<std::streamsize>(packed.size()));
        stream.avail_in = static_cast<unsigned>(in.gcount());
        if (stream.avail_in == 0) break;
        taken += stream.avail_in;
        stream.next_in = reinterpret_cast<Bytef*>(packed.data());
        do {
            stream.avail_out = static_cast<unsigned>(unpacked.size());
            stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
            status = inflate(&stream, Z_NO_FLUSH);
            if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
                fail("{}: damaged compressed data: {}", path, stream.msg == nullptr ? "unknown" : stream.msg);
            const auto count = unpacked.size() - stream.avail_out;
            out.write(unpacked.data(), static_cast<std::streamsize>(count));
            total += count;
        } while (stream.avail_out == 0 && status == Z_OK && total < limit);
        if (status == Z_BUF_ERROR) status = Z_OK;
        report(options, std::min(0.5, 0.5 * static_cast<double>(taken) / size), "unpacking voxels");
    }
    if (status == Z_OK && total < limit)
        fail("{}: truncated: its compressed data stop after {} bytes of voxels", path, total);
    if (!out.flush()) fail("{}: cannot write a temporary file of {} bytes", path, total);
}

bool is_local(const MetaHeader& header) {
    return header.data_file == "LOCAL" || header.data_file == "Local" || header.data_file == "local";
}

bool has_several_files(const MetaHeader& header) {
    return header.data_file.rfind("LIST", 0) == 0 || header.data_file.find('%') != std::string::npos;
}

// Checks that the number of dims matches the axes: otherwise MetaIO reads uninitialised memory. It supports at most ten
// axes.
void check_axes(const std::string& path, const MetaHeader& header) {
    if (header.axes < 1 || header.axes > 10) fail("{}: NDims = {}, expected 1 to 10", path, header.axes);
    if (header.dims.size() != header.axes)
        fail("{}: NDims = {} and DimSize with {} numbers, expected as many", path, header.axes, header.dims.size());
    checked_bytes(path, header.dims, 1);
}

}  // namespace

std::optional<FileLayout> meta_layout(const std::string& path, Volume& description) {
    const auto header = meta_header(path);
    check_axes(path, header);
    const bool plain = header.plain && !header.compressed && !has_several_files(header) && header.dims.size() == 3 &&
                       (header.spacings == 0 || header.spacings == header.axes);
    if (!plain) return std::nullopt;
    const auto type = describe_through_itk({.format = ItkFormat::Meta, .path = path}, description);
    if (!type) return std::nullopt;
    description.in_patient = header.in_patient;
    const auto data = is_local(header) ? fs::path(path) : fs::path(path).parent_path() / header.data_file;
    return FileLayout{data.string(), is_local(header) ? header.data_offset : 0, *type,
                      header.big_endian != (std::endian::native == std::endian::big)};
}

Volume load_meta(const std::string& path, const LoadOptions& options) {
    const auto header = meta_header(path);
    const bool local = is_local(header), several = has_several_files(header);
    const auto data = local ? fs::path(path) : fs::path(path).parent_path() / header.data_file;
    ItkRequest request{.format = ItkFormat::Meta, .path = path};
    check_axes(path, header);
    if (several) {
        // "LIST 3" gives the number of axes per file; without a number each file has all axes except the last.
        std::size_t axes = header.axes - 1, slices = 1;
        if (header.data_file.rfind("LIST", 0) == 0) std::istringstream(header.data_file.substr(4)) >> axes;
        for (std::size_t axis = std::max<std::size_t>(axes, 2); axis < header.axes; ++axis)
            slices *= header.dims[axis];
        check_several(path, header.data_file, header.listed, slices);
    }
    if (!several) {
        std::error_code error;
        if (!fs::is_regular_file(data, error))
            fail("{}: its data file {} {}", path, data.string(), error ? error.message() : "is not a file");
        request.stored_bytes = fs::file_size(data);
        if (!header.compressed) request.stored_ratio = kPlainRatio;
    }
    std::optional<TemporaryFolder> folder;
    if (header.compressed && !several) {
        const auto limit = checked_bytes(path, header.dims, 8 * std::clamp<std::size_t>(header.channels, 1, 64));
        // at least one byte per voxel
        check_stored_size(path, checked_bytes(path, header.dims, 1), request.stored_bytes);
        folder.emplace();
        inflate_file(path, data, local ? header.data_offset : 0, limit, folder->path() / "data.raw", options);
        const auto patched = folder->path() / "header.mhd";
        std::ofstream out(patched);
        for (const auto& line : header.lines)
            out << line << '\n';
        out << "ElementDataFile = data.raw\n";
        if (!out.flush()) fail("{}: cannot write a temporary file", path);
        request.read_path = patched.string();
        request.stored_bytes = fs::file_size(folder->path() / "data.raw");
    }
    auto volume = load_through_itk(request, options);
    volume.in_patient = header.in_patient;
    if (header.axes > 0 && header.spacings > 0 && header.spacings != header.axes)
        volume.notes.push_back(fmt::format("The header says NDims = {} but gives {} spacings; NDims was used.",
                                           header.axes, header.spacings));
    return volume;
}

}  // namespace edgesplat::detail
