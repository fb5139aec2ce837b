// Reads a volume or scene file while the window stays responsive.
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/scene/cuts.h"
#include "engine/scene/scene_document.h"

namespace edgesplat::viewer {

/// An opened volume, and its scene document, in which unset keys stay unset.
struct Opened {
    std::string path;  ///< as requested
    SceneDocument document;
    std::vector<std::filesystem::path> folders;  ///< folders that were searched for the volume
    std::shared_ptr<const Volume> whole;         ///< preprocessed
    std::shared_ptr<const Volume> volume;        ///< the same as others cut it
    Cuts cuts;                                   ///< which did
    std::shared_ptr<const Volume> samples;       ///< as read, if it is a segmentation or has one; else null
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
    /// Waits for the result. Call once. Throws Error.
    Opened take() { return result_.get(); }

  private:
    std::string path_;
    std::atomic<double> fraction_{0};
    mutable std::mutex mutex_;
    std::string what_;
    std::future<Opened> result_;  ///< last: its thread ends before the members it writes to are destroyed
};

}  // namespace edgesplat::viewer
