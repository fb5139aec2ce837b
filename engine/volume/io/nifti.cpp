// Reads NIfTI-1/2 and Analyze through ITK. ITK gets a temporary copy with an edited header, to work around three bugs:
//  - ITK does not detect missing voxels at the end of a file. The copy counts the bytes.
//  - Its NIfTI library silently replaces NaN and infinity by 0. Floats are passed as integers of the same size and
//    converted back here; then slope and intercept are applied.
//  - ITK writes beyond its buffers if a header has a vector intent and a slope (heap corruption, ITK 5.2.1), and reads
//    4-D files whole. Only the chosen 3-D block of data with more than three axes is copied.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

// Byte offsets of the fields, named as in nifti1.h and nifti2.h.
struct Layout {
    std::size_t header_size, dim, dim_size, intent_code, intent_size, datatype, vox_offset, scl_slope, scl_inter,
        pixdim, qform_code, quatern_b, srow_x;
    bool wide;  // 64-bit offset, scale and places, 32-bit codes (NIfTI-2)
};
constexpr Layout kNifti1{348, 40, 2, 68, 2, 70, 108, 112, 116, 76, 252, 256, 280, false};
constexpr Layout kNifti2{540, 16, 8, 504, 4, 12, 168, 176, 184, 104, 344, 352, 400, true};

struct Header {
    std::vector<unsigned char> bytes;
    const Layout* layout = nullptr;
    bool swapped = false;
    bool analyze = false;
    bool single_file = false;
    std::array<long long, 8> dim{};
    int datatype = 0;
    double slope = 1, intercept = 0;
    std::size_t offset = 0;

    template <typename T>
    T get(std::size_t at) const {
        std::array<unsigned char, sizeof(T)> raw{};
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), raw.begin());
        if (swapped) std::reverse(raw.begin(), raw.end());
        T value;
        std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }
    template <typename T>
    void set(std::size_t at, T value) {
        std::array<unsigned char, sizeof(T)> raw{};
        std::memcpy(raw.data(), &value, sizeof(T));
        if (swapped) std::reverse(raw.begin(), raw.end());
        std::copy(raw.begin(), raw.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
    }
};

// Reads through zlib, which also reads uncompressed files.
class Stream {
  public:
    Stream(const std::string& name, const std::string& file) : name_(name), file_(gzopen(file.c_str(), "rb")) {
        if (file_ == nullptr) fail("{}: {} cannot be opened", name, file);
        gzbuffer(file_, 1 << 18);
    }
    ~Stream() { gzclose(file_); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    std::size_t read(void* target, std::size_t count) {
        const int got = gzread(file_, target, static_cast<unsigned>(count));
        if (got < 0) {
            int code = 0;
            const char* text = gzerror(file_, &code);
            fail("{}: damaged gzip data: {}", name_, text);
        }
        return static_cast<std::size_t>(got);
    }
    void skip_to(std::size_t offset) {
        if (gzseek(file_, static_cast<z_off_t>(offset), SEEK_SET) < 0)
            fail("{}: truncated: no data at byte {}", name_, offset);
    }

    // Reads the rest of a gzip file to verify its final checksum.
    void check_end() {
        std::vector<char> rest(1 << 18);
        if (gzdirect(file_) != 0) return;
        while (read(rest.data(), rest.size()) > 0) {
        }
        int code = Z_OK;
        (void)gzerror(file_, &code);
        if (code == Z_BUF_ERROR) fail("{}: truncated: its gzip data are incomplete", name_);
    }

  private:
    std::string name_;
    gzFile file_;
};

// Checks the position fields: ITK's linear algebra aborts the program if a number is not finite as a float.
void check_place(const std::string& path, const Header& header) {
    const Layout& at = *header.layout;
    const auto check = [&](const char* field, std::size_t first, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const double value =
                at.wide ? header.get<double>(first + 8 * i) : static_cast<double>(header.get<float>(first + 4 * i));
            if (!(std::abs(value) < 1e15))
                fail("{}: {} in its header: {}, expected a length in mm", path, field, value);
        }
    };
    const auto code = [&](std::size_t which) {
        return at.wide ? header.get<std::int32_t>(at.qform_code + 4 * which)
                       : header.get<std::int16_t>(at.qform_code + 2 * which);
    };
    check("pixdim", at.pixdim, 4);
    if (header.analyze) return;
    if (code(0) != 0) check("quatern and qoffset", at.quatern_b, 6);
    if (code(1) != 0) check("srow", at.srow_x, 12);
}

Header parse(const std::string& path, const std::string& header_file) {
    Header header;
    header.bytes.resize(kNifti2.header_size);
    Stream stream(path, header_file);
    header.bytes.resize(stream.read(header.bytes.data(), header.bytes.size()));
    if (header.bytes.size() < kNifti1.header_size)
        fail("{}: {} bytes are too few for a NIfTI or Analyze header (348)", path, header.bytes.size());
    for (const bool swapped : {false, true}) {
        header.swapped = swapped;
        const auto size = header.get<std::int32_t>(0);
        if (size == 348) header.layout = &kNifti1;
        if (size == 540 && header.bytes.size() == kNifti2.header_size) header.layout = &kNifti2;
        if (header.layout != nullptr) break;
    }
    if (header.layout == nullptr)
        fail("{}: not a NIfTI or Analyze file: its header begins with neither 348 nor 540", path);
    const Layout& at = *header.layout;
    header.bytes.resize(at.header_size);
    const char* magic = reinterpret_cast<const char*>(header.bytes.data()) + (at.wide ? 4 : 344);
    header.single_file = magic[0] == 'n' && magic[1] == '+';
    header.analyze = !(magic[0] == 'n' && (magic[1] == '+' || magic[1] == 'i'));
    for (std::size_t axis = 0; axis < 8; ++axis)
        header.dim[axis] =
            at.wide ? header.get<std::int64_t>(at.dim + axis * 8) : header.get<std::int16_t>(at.dim + axis * 2);
    header.datatype = header.get<std::int16_t>(at.datatype);
    if (!header.analyze) {
        header.slope =
            at.wide ? header.get<double>(at.scl_slope) : static_cast<double>(header.get<float>(at.scl_slope));
        header.intercept =
            at.wide ? header.get<double>(at.scl_inter) : static_cast<double>(header.get<float>(at.scl_inter));
    }
    const double offset = at.wide ? static_cast<double>(header.get<std::int64_t>(at.vox_offset))
                                  : static_cast<double>(header.get<float>(at.vox_offset));
    if (!(offset >= 0 && offset < 1e15)) fail("{}: vox_offset {} in its header is not a valid offset", path, offset);
    header.offset = static_cast<std::size_t>(offset);
    if (header.dim[0] < 1 || header.dim[0] > 7)
        fail("{}: its header says {} axes, expected 1 to 7", path, header.dim[0]);
    for (std::size_t axis = 1; axis < 8; ++axis) {
        if (static_cast<long long>(axis) > header.dim[0]) header.dim[axis] = 1;
        if (axis > 3 && header.dim[axis] == 0) header.dim[axis] = 1;  // some Analyze writers leave them 0
        if (axis > 3 && header.dim[axis] > 65535)
            fail("{}: its header says dim[{}] = {}", path, axis, header.dim[axis]);
        if (header.dim[axis] < 1) fail("{}: its header says dim[{}] = {}", path, axis, header.dim[axis]);
    }
    check_place(path, header);
    return header;
}

// Converts a NIfTI-2 header to NIfTI-1, the only version that ITK's NIfTI library reads. Positions become floats, and
// an axis has at most 32767 voxels.
Header as_nifti1(const std::string& path, const Header& wide) {
    Header header = wide;
    header.layout = &kNifti1;
    header.bytes.assign(kNifti1.header_size, 0);
    header.set<std::int32_t>(0, static_cast<std::int32_t>(kNifti1.header_size));
    for (std::size_t axis = 1; axis <= 3; ++axis)
        if (wide.dim[axis] > std::numeric_limits<std::int16_t>::max())
            fail("{}: its header says dim[{}] = {}; NIfTI-2 is read up to 32767 voxels along an axis", path, axis,
                 wide.dim[axis]);
    const Layout &from = kNifti2, &to = kNifti1;
    const auto floats = [&](std::size_t first, std::size_t target, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            header.set<float>(target + 4 * i, static_cast<float>(wide.get<double>(first + 8 * i)));
    };
    floats(from.pixdim, to.pixdim, 8);
    floats(from.scl_slope, to.scl_slope, 2);
    floats(from.quatern_b, to.quatern_b, 6);
    floats(from.srow_x, to.srow_x, 12);
    for (std::size_t which = 0; which < 2; ++which)
        header.set<std::int16_t>(to.qform_code + 2 * which,
                                 static_cast<std::int16_t>(wide.get<std::int32_t>(from.qform_code + 4 * which)));
    header.set<std::int16_t>(to.datatype, static_cast<std::int16_t>(wide.datatype));
    header.set<std::int16_t>(to.datatype + 2, wide.get<std::int16_t>(from.datatype + 2));            // bitpix
    header.set<unsigned char>(123, static_cast<unsigned char>(wide.get<std::int32_t>(500) & 0xff));  // xyzt_units
    std::memcpy(&header.bytes[344], wide.single_file ? "n+1" : "ni1", 4);
    return header;
}

struct VoxelType {
    int code;
    const char* name;
    std::size_t bytes;
};
constexpr std::array<VoxelType, 12> kVoxelTypes{{{2, "uint8", 1},
                                                 {4, "int16", 2},
                                                 {8, "int32", 4},
                                                 {16, "float32", 4},
                                                 {32, "complex64", 8},
                                                 {64, "float64", 8},
                                                 {128, "rgb24", 3},
                                                 {256, "int8", 1},
                                                 {512, "uint16", 2},
                                                 {768, "uint32", 4},
                                                 {1024, "int64", 8},
                                                 {1280, "uint64", 8}}};

const VoxelType& voxel_type(const std::string& path, int datatype) {
    for (const VoxelType& type : kVoxelTypes)
        if (type.code == datatype) return type;
    fail("{}: voxels of NIfTI type {} cannot be read", path, datatype);
}

// "x.hdr.gz", ".hdr" -> "x.img.gz", ".img": the existing file of the pair.
std::string partner(const std::string& path, const std::string& from, const std::string& to) {
    const auto at = path.rfind(from);
    const std::string stem = path.substr(0, at) + to;
    for (const std::string& name : {stem, stem + ".gz"})
        if (fs::is_regular_file(name)) return name;
    fail("{}: its second file {} (or {}.gz) is missing", path, stem, stem);
}

bool has_extension(const std::string& path, const std::string& extension) {
    return path.ends_with(extension) || path.ends_with(extension + ".gz");
}

}  // namespace

Volume load_nifti(const std::string& path, const LoadOptions& options) {
    std::string header_file = path, data_file = path;
    if (has_extension(path, ".img")) header_file = partner(path, ".img", ".hdr");
    if (has_extension(path, ".hdr")) data_file = partner(path, ".hdr", ".img");
    Header header = parse(path, header_file);
    if (header.layout->wide) header = as_nifti1(path, header);
    if (header.single_file) data_file = header_file;
    const auto& dim = header.dim;
    const auto unsigned_dim = [&](std::size_t axis) { return static_cast<std::size_t>(dim[axis]); };

    // Axis 5 is components; the other axes beyond the third are frames.
    const std::vector<std::size_t> block{unsigned_dim(1), unsigned_dim(2), unsigned_dim(3)};
    // Size from the data type, as the NIfTI library does it; it ignores bitpix.
    const VoxelType& type = voxel_type(path, header.datatype);
    const std::size_t bytes = checked_bytes(path, block, type.bytes);
    const std::size_t stored = fs::file_size(data_file);
    check_stored_size(path, bytes, stored);
    const bool more_axes = std::max({dim[4], dim[5], dim[6], dim[7]}) > 1;
    const bool floats = header.datatype == 16 || header.datatype == 64;
    ItkRequest request{.format = ItkFormat::Nifti,
                       .path = path,
                       .read_path = header_file,
                       .stored_type = type.name,
                       .stored_bytes = stored};

    LoadOptions rest = options;
    std::size_t index = 0;
    if (more_axes) {
        const std::size_t frames = unsigned_dim(4) * unsigned_dim(6) * unsigned_dim(7);
        std::size_t frame = 0;
        if (dim[5] > 1 || frames == 1) {
            index = chosen_component(path, options, unsigned_dim(5));
            rest.component.reset();
        }
        frame = chosen_frame(path, options, frames);
        rest.frame.reset();
        const std::size_t t = frame % unsigned_dim(4), rest_of_frame = frame / unsigned_dim(4);
        index = t + unsigned_dim(4) * (index + unsigned_dim(5) * rest_of_frame);
    }
    // Also prevents an overflow of the product below.
    if (static_cast<double>(index) * static_cast<double>(bytes) > 1040.0 * static_cast<double>(stored) + 4096)
        fail("{}: truncated: the chosen frame lies beyond the end of the file", path);
    const Layout& at = *header.layout;
    const std::size_t data_offset = header.single_file ? at.header_size + 4 : 0;
    for (std::size_t axis = 0; axis < 8; ++axis)
        header.set<std::int16_t>(at.dim + axis * 2, static_cast<std::int16_t>(axis == 0   ? 3
                                                                              : axis <= 3 ? dim[axis]
                                                                                          : 1));
    header.set<float>(at.vox_offset, static_cast<float>(data_offset));
    if (!header.analyze) header.set<std::int16_t>(at.intent_code, 0);
    // The standard defines no scale for colours, and ITK overruns its buffers if one is given.
    if (!header.analyze && (floats || header.datatype == 128)) {
        header.set<float>(at.scl_slope, 0);
        header.set<float>(at.scl_inter, 0);
    }
    if (floats) {
        header.set<std::int16_t>(at.datatype, header.datatype == 16 ? 8 : 1024);
        request.bits_are_floats = true;
        const bool scaled = std::isfinite(header.slope) && header.slope != 0 && std::isfinite(header.intercept);
        request.slope = scaled ? header.slope : 1;
        request.intercept = scaled ? header.intercept : 0;
    }
    const TemporaryFolder folder;
    const auto head_path = folder.path() / (header.single_file ? "block.nii" : "block.hdr");
    std::ofstream head(head_path, std::ios::binary);
    head.write(reinterpret_cast<const char*>(header.bytes.data()), static_cast<std::streamsize>(header.bytes.size()));
    std::ofstream body;
    if (header.single_file)
        head.write("\0\0\0\0", 4);
    else
        body.open(folder.path() / "block.img", std::ios::binary);
    std::ofstream& out = header.single_file ? head : body;
    Stream data(path, data_file);
    data.skip_to(header.offset + index * bytes);
    std::vector<char> buffer(1 << 20);
    for (std::size_t done = 0; done < bytes;) {
        const std::size_t want = std::min(buffer.size(), bytes - done);
        const std::size_t got = data.read(buffer.data(), want);
        if (got == 0)
            fail("{}: truncated: {} of {} bytes of voxels{}", path, done, bytes,
                 more_axes ? " of the chosen frame" : "");
        out.write(buffer.data(), static_cast<std::streamsize>(got));
        done += got;
        report(options, 0.5 * static_cast<double>(done) / static_cast<double>(bytes), "reading voxels");
    }
    data.check_end();
    head.close();
    if (body.is_open()) body.close();
    if (!head || (!header.single_file && !body)) fail("{}: cannot write a temporary file of {} bytes", path, bytes);
    request.read_path = head_path.string();
    request.stored_bytes = 0;
    auto volume = load_through_itk(request, rest);
    if (header.analyze)
        volume.notes.push_back("Analyze files do not define which side is left: the axes are used as stored.");
    return volume;
}

}  // namespace edgesplat::detail
