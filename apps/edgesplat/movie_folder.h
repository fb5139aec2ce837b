// A folder with the numbered frames of a movie and a note of the inputs that determine them. With it a stopped or
// killed movie can be continued.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

/// A file name with one number in it, such as frame_%04d.png.
class FramePattern {
  public:
    /// Throws edgesplat::Error unless there is exactly one %d or %0Nd.
    explicit FramePattern(const std::string& name);

    std::string name(int frame) const;
    /// Whether a file of this name is one of the frames.
    bool matches(std::string_view name) const;

  private:
    std::string before_, after_;
    int digits_ = 0;
};

/// The folder, its frames and its note, movie.json. Only one process at a time uses it.
class MovieFolder {
  public:
    /// Creates or reopens the folder. `decided_by`: the inputs that determine the frames, as texts by name. Throws
    /// edgesplat::Error if an existing note differs (naming the entries), if frames have no note, or if another process
    /// uses the folder. With `restart`, existing frames and note are deleted first.
    MovieFolder(const std::filesystem::path& folder, const FramePattern& pattern,
                const nlohmann::ordered_json& decided_by, bool restart);
    ~MovieFolder();
    MovieFolder(const MovieFolder&) = delete;
    MovieFolder& operator=(const MovieFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }
    std::filesystem::path frame_path(int frame) const { return folder_ / pattern_.name(frame); }
    /// Frames are written completely or not at all, so an existing frame is finished.
    bool has(int frame) const { return std::filesystem::exists(frame_path(frame)); }

    /// Removes the frames, the note and, if empty, the folder.
    void remove();

  private:
    void lock();
    void remove_frames() const;

    std::filesystem::path folder_;
    FramePattern pattern_;
    int lock_ = -1;
};
