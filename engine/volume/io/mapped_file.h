// A file's bytes, mapped into memory for reading. Internal to engine/volume/io.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "engine/error.h"

namespace edgesplat::detail {

/// The file must not become shorter while it is mapped.
class MappedFile {
  public:
    /// Throws Error if the file cannot be read.
    explicit MappedFile(const std::string& path) {
        const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
        struct stat status {};
        const bool opened = file >= 0 && fstat(file, &status) == 0;
        size_ = opened ? static_cast<std::size_t>(status.st_size) : 0;
        if (opened && size_ > 0) data_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
        const int error = errno;
        if (file >= 0) close(file);
        if (!opened || data_ == MAP_FAILED) fail("{}: cannot be read: {}", path, std::strerror(error));
    }
    ~MappedFile() {
        if (data_ != nullptr) munmap(data_, size_);
    }
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

  private:
    void* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace edgesplat::detail
