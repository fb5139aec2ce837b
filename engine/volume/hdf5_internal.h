// HDF5 as far as packed volumes need it: files, attributes of the root, boxes of 3-D datasets. Every failure is an
// Error that names the file and the field. Internal to engine/volume; nothing here is installed.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "engine/volume/load_internal.h"

namespace edgesplat::detail {

/// The library keeps its state in the process and is not everywhere built for threads: held around every use of it, by
/// ITK's MINC reader too. May be taken again by the thread that has it.
std::recursive_mutex& hdf5_mutex();

/// An identifier of HDF5, given back when this dies.
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
    /// False where HDF5 says so: what was to be written is not there.
    bool close();
    std::int64_t get() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

  private:
    std::int64_t id_ = -1;
    Close close_ = nullptr;
};

/// Slowest axis first, as HDF5 counts: of samples (z, y, x).
using Hdf5Extent = std::vector<std::uint64_t>;

class Hdf5Dataset {
  public:
    const Hdf5Extent& extent() const { return extent_; }
    /// As stored; int8 to float64, in any byte order.
    SampleType type() const { return type_; }
    /// Boxes: `low` and `size` have as many axes as the dataset. Converted from and to the type in memory.
    void read(const Hdf5Extent& low, const Hdf5Extent& size, SampleType memory_type, void* out) const;
    void write(const Hdf5Extent& low, const Hdf5Extent& size, SampleType memory_type, const void* data) const;
    /// After the last `write`: that there was no room for what HDF5 kept till now is said here and nowhere else.
    void finish() const;

  private:
    friend class Hdf5File;
    std::string file_, name_;
    Hdf5Id id_;
    Hdf5Extent extent_;
    SampleType type_ = SampleType::Float32;
};

/// How a new dataset is laid out.
struct Hdf5Layout {
    SampleType type = SampleType::Float32;
    Hdf5Extent extent;
    std::uint64_t chunk = 0;  ///< voxels along each side of a chunk; 0: in one piece
    bool compress = false;    ///< shuffle and deflate 1; needs chunks
};

class Hdf5File {
  public:
    /// For reading. Whether it is HDF5 at all is said first.
    static Hdf5File open(const std::string& path);
    /// Made empty, whatever is there; messages name it `shown_path`.
    static Hdf5File create(const std::string& path, const std::string& shown_path);
    /// What is still to be written goes nowhere. To be called where writing failed, before anything else is given back:
    /// HDF5 keeps what it cannot write on a full disk, and ends the program when it tries again at its end.
    void abandon() noexcept;
    /// Everything to disk; a file that is written must be closed by this, which fails where the disk is full.
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

    /// "/levels/0/samples": whether there is such a group or dataset.
    bool has(const std::string& path) const;
    /// `cache`: bytes of chunks that are kept, unpacked, for the next read; 0: as HDF5 would.
    Hdf5Dataset dataset(const std::string& path, std::size_t cache = 0) const;
    /// Groups on the way are made.
    Hdf5Dataset create_dataset(const std::string& path, const Hdf5Layout& layout);

  private:
    Hdf5Id attribute(const std::string& name) const;
    std::string path_;
    Hdf5Id id_;
};

}  // namespace edgesplat::detail
