// A volume or scene file that is read while the window stays alive.
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat::viewer {

/// What there is to look at: its samples, and the scene with what the file left open still open.
struct Opened {
    std::string path;  ///< as it was asked for
    SceneDocument document;
    std::vector<std::filesystem::path> folders;  ///< where its volume was looked for
    std::shared_ptr<const Volume> volume;
};

/// Reads a volume file, a folder, builtin:NAME or a scene file. Throws Error.
Opened open_path(const std::string& path,
                 const std::function<void(double fraction, std::string_view what)>& progress = {});

/// The same on a thread of its own.
class Loading {
  public:
    explicit Loading(std::string path);
    const std::string& path() const { return path_; }
    double fraction() const { return fraction_; }
    std::string what() const;
    bool ready() const;
    /// Waits for it. Throws Error; once.
    Opened take() { return result_.get(); }

  private:
    std::string path_;
    std::atomic<double> fraction_{0};
    mutable std::mutex mutex_;
    std::string what_;
    std::future<Opened> result_;  ///< last: ends before what the thread writes to
};

}  // namespace edgesplat::viewer
