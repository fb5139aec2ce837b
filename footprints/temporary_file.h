// Files that appear completely or not at all: written under a temporary name beside their target, then renamed. All
// writers use this class. So the files that a killed process leaves have one pattern of names and are removed in one
// place.
#pragma once

#include <filesystem>
#include <string_view>

namespace edgesplat {

/// Defers SIGINT, SIGTERM and SIGHUP while any instance lives; the last destructor delivers them.
class DeferSignals {
  public:
    DeferSignals();
    ~DeferSignals();
    /// Whether an instance lives. Safe in a signal handler.
    static bool any() noexcept;
    DeferSignals(const DeferSignals&) = delete;
    DeferSignals& operator=(const DeferSignals&) = delete;
};

/// Writes all bytes to an open file, however often it is interrupted. Throws std::system_error.
void write_all(int descriptor, std::string_view bytes);

/// A new, empty file beside its target, named .NAME.edgesplat-PID-COUNT.tmp. It is removed unless it is renamed. It is
/// locked while this object lives; the lock ends with the process, so an unlocked file belongs to a killed process. The
/// first file of a process in a folder removes those. Throws std::system_error.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& target);
    ~TemporaryFile();
    TemporaryFile(TemporaryFile&& other) noexcept;
    TemporaryFile& operator=(TemporaryFile&&) = delete;

    const std::filesystem::path& target() const { return target_; }
    const std::filesystem::path& path() const { return path_; }
    /// Appends.
    void write(std::string_view bytes);
    /// Flushes the whole file to disk, whoever wrote it.
    void sync();
    void rename_to_target();

  private:
    bool open_new();
    void close() noexcept;
    std::filesystem::path target_, path_;
    int descriptor_ = -1;
};

/// Removes the temporary files of killed processes from a folder. Files of running processes are locked and stay, also
/// those of other machines that share the folder. On a file system without locks all files stay.
void remove_stale_temporaries(const std::filesystem::path& folder) noexcept;

}  // namespace edgesplat
