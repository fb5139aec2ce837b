// A minimal HDF5 wrapper for packed volumes: files, root attributes, boxes of 3-D datasets. Every failure is an Error
// that names the file and the field. Internal to engine/volume, not installed.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

/// The first bytes of every HDF5 file.
inline constexpr std::string_view kHdf5Signature = "\x89HDF\r\n\x1a\n";

/// HDF5 keeps global state and may be built without thread safety. Lock this mutex around every use of it, including
/// libnetcdf. Recursive.
std::recursive_mutex& hdf5_mutex();

/// Owns an HDF5 identifier and closes it in the destructor.
class Hdf5Id {
  public:
    using Close = int (*)(std::int64_t);
    Hdf5Id() = default;
    Hdf5Id(std::int64_t id, Close how) : id_(id), close_(how) {}
    Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Hdf5Id& operator=(Hdf5Id&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Hdf5Id() { (void)close(); }
    /// False if HDF5 reports a failure: the data may not have been written.
    bool close();
    std::int64_t get() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

  private:
    std::int64_t id_ = -1;
    Close close_ = nullptr;
};

/// Slowest axis first, the order of HDF5: (z, y, x) for samples.
using Hdf5Extent = std::vector<std::uint64_t>;

class Hdf5Dataset {
  public:
    const Hdf5Extent& extent() const { return extent_; }
    /// Bytes that its samples occupy in the file.
    std::uint64_t stored_bytes() const;
    /// Names of the axes (HDF5's dimension scales); empty texts where they have none.
    std::vector<std::string> axis_names() const;
    /// The stored type: int8 to float64, any byte order. Half floats are float32, enumerations and booleans integers.
    SampleType type() const { return type_; }
    /// Read or write a box. `low` and `size` have as many entries as the dataset has axes. Samples are converted from
    /// and to the type in memory.
    void read(const Hdf5Extent& low, const Hdf5Extent& size, SampleType memory_type, void* out) const;
    void write(const Hdf5Extent& low, const Hdf5Extent& size, SampleType memory_type, const void* data) const;
    /// Call after the last `write`: flushes the data that HDF5 has buffered. A full disk is reported only here.
    void finish() const;

  private:
    friend class Hdf5File;
    std::string file_, name_;
    Hdf5Id id_;
    Hdf5Extent extent_;
    SampleType type_ = SampleType::Float32;
};

/// Layout of a new dataset.
struct Hdf5Layout {
    SampleType type = SampleType::Float32;
    Hdf5Extent extent;
    std::uint64_t chunk = 0;  ///< side of a chunk, voxels; 0: contiguous
    bool compress = false;    ///< shuffle filter and deflate level 1; needs chunks
};

class Hdf5File {
  public:
    /// Opens a file for reading. Checks first that it is HDF5.
    static Hdf5File open(const std::string& path);
    /// Creates an empty file and replaces an existing one; messages use the name `shown_path`.
    static Hdf5File create(const std::string& path, const std::string& shown_path);
    /// Discards all unwritten data. Call it after a failed write, before any other identifier is closed: HDF5 keeps
    /// data that it cannot write on a full disk and aborts the program when it retries at exit.
    void abandon() noexcept;
    /// Writes everything to disk; fails if the disk is full. Required for every written file.
    void close();

    bool has_attribute(const std::string& name) const;
    std::string text(const std::string& name) const;
    std::vector<double> numbers(const std::string& name, std::size_t count) const;
    double number(const std::string& name) const { return numbers(name, 1)[0]; }
    std::uint64_t whole_number(const std::string& name) const;
    void set_text(const std::string& name, const std::string& value);
    void set_numbers(const std::string& name, SampleType type, const Hdf5Extent& extent, const double* values);
    void set_number(const std::string& name, SampleType type, double value) { set_numbers(name, type, {}, &value); }
    void set_whole_number(const std::string& name, std::uint64_t value);

    /// Whether the group or dataset exists, e.g. "/levels/0/samples".
    bool has(const std::string& path) const;
    /// Paths of all datasets of numbers, in order; those behind soft and external links are left out.
    std::vector<std::string> datasets() const;
    struct ExternalLink {
        std::string name, file, object;
    };
    /// Links to objects of other files, which are not followed.
    std::vector<ExternalLink> external_links() const;
    /// The numbers of an attribute of the object `path`; nullopt if it is missing or not numeric.
    std::optional<std::vector<double>> find_numbers(const std::string& path, const std::string& name) const;
    /// The text of an attribute, or all its texts joined; nullopt if it is missing or not a text.
    std::optional<std::string> find_text(const std::string& path, const std::string& name) const;
    /// The one text that a dataset holds.
    std::string text_dataset(const std::string& path) const;
    /// `cache`: bytes of unpacked chunks to keep for later reads; 0: HDF5's default.
    Hdf5Dataset dataset(const std::string& path, std::size_t cache = 0) const;
    /// Creates missing parent groups.
    Hdf5Dataset create_dataset(const std::string& path, const Hdf5Layout& layout);

  private:
    Hdf5Id attribute(const std::string& name) const;
    std::string path_;
    Hdf5Id id_;
};

}  // namespace edgesplat::detail
