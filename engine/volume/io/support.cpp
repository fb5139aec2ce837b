// Limits, choices, sample conversion, temporary files and captured output for all formats.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <regex>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

constexpr std::array<std::string_view, 10> kTypeNames = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                                         "uint32", "int64", "uint64", "float32", "float64"};
constexpr std::array<std::size_t, 10> kTypeSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
/// Maximum bytes of all frames and components of a file that can only be read as a whole.
constexpr std::size_t kMaxBytes = std::size_t{1} << 34;
constexpr const char* kMemoryVariable = "EDGESPLAT_READ_MEMORY";

template <typename T>
void convert(const void* source, std::size_t first, std::size_t stride, std::size_t count, float* target) {
    const T* values = static_cast<const T*>(source) + first;
    if (stride == 1) {
        for (std::size_t i = 0; i < count; ++i)
            target[i] = static_cast<float>(values[i]);
    } else {
        for (std::size_t i = 0; i < count; ++i)
            target[i] = static_cast<float>(values[i * stride]);
    }
}

std::mutex& capture_mutex() {
    static std::mutex mutex;
    return mutex;
}

/// " (0: red, 1: green)" for names that are not all empty.
std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t kMostListed = 16;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
        if (!names[i].empty()) list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", i, names[i]);
    if (names.size() > kMostListed) list += ", ...";
    return list.empty() || list == ", ..." ? "" : " (" + list + ")";
}

std::size_t chosen(const std::string& path, const std::optional<int>& choice, std::size_t count, const char* what,
                   const char* option, const char* kind, const std::vector<std::string>& names = {}) {
    if (!choice) {
        if (count > 1)
            fail("{}: {} data with {} {}s; choose one with --{} 0..{}{}", path, kind, count, what, option, count - 1,
                 listed(names));
        return 0;
    }
    if (*choice < 0 || static_cast<std::size_t>(*choice) >= count)
        fail("{}: --{} {}: the file has {} {}{}, numbered from 0", path, option, *choice, count, what,
             count == 1 ? "" : "s");
    return static_cast<std::size_t>(*choice);
}

}  // namespace

std::string_view name_of(SampleType type) {
    return kTypeNames[static_cast<std::size_t>(type)];
}
std::size_t size_of(SampleType type) {
    return kTypeSizes[static_cast<std::size_t>(type)];
}

bool sample_type_named(std::string_view name, SampleType& type) {
    for (std::size_t i = 0; i < kTypeNames.size(); ++i) {
        if (kTypeNames[i] != name) continue;
        type = static_cast<SampleType>(i);
        return true;
    }
    return false;
}

void convert_samples(SampleType type, const void* source, std::size_t first, std::size_t stride, std::size_t count,
                     float* target) {
    switch (type) {
        case SampleType::Int8:
            return convert<std::int8_t>(source, first, stride, count, target);
        case SampleType::UInt8:
            return convert<std::uint8_t>(source, first, stride, count, target);
        case SampleType::Int16:
            return convert<std::int16_t>(source, first, stride, count, target);
        case SampleType::UInt16:
            return convert<std::uint16_t>(source, first, stride, count, target);
        case SampleType::Int32:
            return convert<std::int32_t>(source, first, stride, count, target);
        case SampleType::UInt32:
            return convert<std::uint32_t>(source, first, stride, count, target);
        case SampleType::Int64:
            return convert<std::int64_t>(source, first, stride, count, target);
        case SampleType::UInt64:
            return convert<std::uint64_t>(source, first, stride, count, target);
        case SampleType::Float32:
            return convert<float>(source, first, stride, count, target);
        case SampleType::Float64:
            return convert<double>(source, first, stride, count, target);
    }
}

std::size_t checked_bytes(const std::string& path, const std::vector<std::size_t>& dims, std::size_t bytes) {
    std::size_t voxels = 1, total = bytes;
    std::string text;
    bool too_many = false, too_long = false, too_big = false;
    for (std::size_t axis = 0; axis < dims.size(); ++axis) {
        const std::size_t n = dims[axis];
        text += (axis > 0 ? " x " : "") + std::to_string(n);
        if (n == 0) fail("{}: its header says dims with a 0 (axis {})", path, axis);
        if (axis < 3) {
            too_long = too_long || n > kMaxVoxelsPerAxis;
            too_many = __builtin_mul_overflow(voxels, n, &voxels) || voxels > kMaxVoxels || too_many;
        }
        too_big = __builtin_mul_overflow(total, n, &total) || total > kMaxBytes || too_big;
    }
    if (too_long) fail("{}: dims {}: an axis may have at most {} voxels", path, text, kMaxVoxelsPerAxis);
    if (too_many) fail("{}: dims {}: a volume may have at most {} voxels", path, text, kMaxVoxels);
    if (too_big) fail("{}: dims {}: more than {} GiB to read", path, text, kMaxBytes >> 30);
    check_memory(path, "dims " + text, total + voxels * sizeof(float));
    return total;
}

void check_memory(const std::string& path, std::string_view what, std::size_t bytes) {
    std::size_t limit = static_cast<std::size_t>(std::max(sysconf(_SC_PHYS_PAGES), 1L)) *
                        static_cast<std::size_t>(std::max(sysconf(_SC_PAGESIZE), 1L));
    if (const char* text = std::getenv(kMemoryVariable); text != nullptr && *text != '\0') {
        std::size_t mib = 0;
        const std::string_view digits = text;
        const auto [end, error] = std::from_chars(digits.begin(), digits.end(), mib);
        if (error != std::errc() || end != digits.end() || mib < 1 || mib > std::size_t{1} << 40)
            fail("{}: '{}', expected a whole number of MiB, at least 1", kMemoryVariable, digits);
        limit = mib << 20;
    }
    if (bytes > limit)
        fail("{}: {}: reading takes {} MiB of memory, expected at most {} MiB ({})", path, what, (bytes >> 20) + 1,
             limit >> 20, kMemoryVariable);
}

void check_stored_size(const std::string& path, std::size_t needed, std::size_t stored, std::size_t ratio) {
    if (needed / ratio > stored + 4096)
        fail(
            "{}: its header promises {} bytes of voxels, but there are only {} bytes of data: truncated, or the header "
            "is wrong",
            path, needed, stored);
}

std::size_t chosen_component(const std::string& path, const LoadOptions& options, std::size_t count,
                             const std::vector<std::string>& names) {
    return chosen(path, options.component, count, "component", "component", "vector or colour", names);
}

std::size_t chosen_frame(const std::string& path, const LoadOptions& options, std::size_t count) {
    return chosen(path, options.frame, count, "frame", "frame", "4-D");
}

void report(const LoadOptions& options, double fraction, std::string_view what) {
    if (options.progress) options.progress(fraction, what);
}

void apply_spacing(Volume& volume, const LoadOptions& options) {
    if (!options.spacing) return;
    auto& axes = volume.geometry.index_to_world_axes;
    for (int axis = 0; axis < 3; ++axis) {
        const double wanted = (*options.spacing)[axis];
        if (!(wanted > 0) || !(wanted < 1e9)) fail("--spacing: {} is not a length in mm above 0", wanted);
        const double length = glm::length(axes[axis]);
        if (length > 0) axes[axis] *= wanted / length;
    }
}

std::string trimmed(const std::string& text) {
    constexpr auto kBlanks = " \t\r\n";
    const auto first = text.find_first_not_of(kBlanks), last = text.find_last_not_of(kBlanks);
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string tidy(std::string_view message) {
    static const std::regex noise(
        R"((^|\n)[^\n]*\.(cxx|hxx|txx|h|cpp):\d+:|\b(itk::|ITK )?ERROR: |\w+ ?\(0x[0-9a-f]+\): )"
        R"(|(^|\n)(Warning|WARNING): In [^\n]*|\x1b\[[0-9;]*m|\d{4}-\d\d-\d\d [^\n|]*\| *)");
    // Limits the length: libraries repeat their input, and std::regex uses stack for every character.
    std::string text = std::regex_replace(std::string(message.substr(0, 2000)), noise, "\n");
    std::string line;
    for (const char c : text) {
        const bool blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == '.'))
        line.pop_back();
    return line.substr(0, 400);
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "edgesplat-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) fail("cannot make a temporary folder like {}", name);
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

OutputCapture::OutputCapture() {
    capture_mutex().lock();
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
    file_ = memfd_create("edgesplat-capture", MFD_CLOEXEC);
    saved_out_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    saved_err_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    if (file_ >= 0 && saved_out_ >= 0) dup2(file_, STDOUT_FILENO);
    if (file_ >= 0 && saved_err_ >= 0) dup2(file_, STDERR_FILENO);
}

OutputCapture::~OutputCapture() {
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
    if (saved_out_ >= 0) dup2(saved_out_, STDOUT_FILENO);
    if (saved_err_ >= 0) dup2(saved_err_, STDERR_FILENO);
    for (const int file : {file_, saved_out_, saved_err_})
        if (file >= 0) close(file);
    capture_mutex().unlock();
}

std::string OutputCapture::text() {
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
    std::string text(16384, '\0');
    const ssize_t size = file_ >= 0 ? pread(file_, text.data(), text.size(), 0) : 0;
    text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return text;
}

}  // namespace edgesplat::detail
