// An anonymous file in memory: nothing of it remains when the process ends.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

namespace edgesplat {

/// Every member throws std::system_error.
class MemoryFile {
  public:
    MemoryFile() : descriptor_(::memfd_create("edgesplat", MFD_CLOEXEC)) { check(descriptor_ >= 0); }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    int descriptor() const { return descriptor_; }
    void fill(const std::string& text) const {
        check(::pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()));
    }
    /// Everything that was written, also by other processes.
    std::string text() const {
        std::string all;
        std::array<char, 65536> part{};
        ssize_t got = 0;
        while ((got = ::pread(descriptor_, part.data(), part.size(), static_cast<off_t>(all.size()))) > 0)
            all.append(part.data(), static_cast<std::size_t>(got));
        check(got == 0);
        return all;
    }

  private:
    static void check(bool well) {
        if (!well) throw std::system_error(errno, std::generic_category());
    }
    int descriptor_;
};

}  // namespace edgesplat
