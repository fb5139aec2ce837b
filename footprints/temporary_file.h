// Files that appear whole or not at all: written under a temporary name beside their target, then renamed. All writers
// go through here, so that what a killed one leaves has one name and is removed in one place.
#pragma once

#include <filesystem>
#include <string_view>

namespace edgesplat {

/// While any lives, SIGINT, SIGTERM and SIGHUP are only noted; when the last one dies they take their course.
class DeferSignals {
  public:
    DeferSignals();
    ~DeferSignals();
    /// Whether one lives. May be asked by a signal handler.
    static bool any() noexcept;
    DeferSignals(const DeferSignals&) = delete;
    DeferSignals& operator=(const DeferSignals&) = delete;
};

/// Appends all of it to an open file, however often it is interrupted. Throws std::system_error.
void write_all(int descriptor, std::string_view bytes);

/// A new and empty file beside its target, named .NAME.edgesplat-PID-COUNT.tmp; removed unless it is renamed. It is
/// locked while this lives, and the lock dies with the process: what is not locked was left by one that was killed.
/// The first one that a process makes in a folder removes what others left there. Throws std::system_error.
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
    /// Everything, by whomever it was written, to the disk.
    void sync();
    void rename_to_target();

  private:
    bool open_new();
    void close() noexcept;
    std::filesystem::path target_, path_;
    int descriptor_ = -1;
};

/// Removes what killed processes left of their TemporaryFiles in a folder; those of living ones, on other machines that
/// share the folder too, are locked and stay. Where a file system has no locks all of them stay.
void remove_stale_temporaries(const std::filesystem::path& folder) noexcept;

}  // namespace edgesplat
