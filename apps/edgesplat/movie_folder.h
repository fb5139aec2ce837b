// The numbered frames of a movie in a folder, with a note of what decided them, so that a movie that was stopped, or
// whose program was killed, goes on where it was.
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

/// The folder, its frames and its note, movie.json. One program at a time works in it.
class MovieFolder {
  public:
    /// Makes or takes up the folder. `decided_by`: texts under the names of what decides the frames. Throws
    /// edgesplat::Error where the note of what is there differs (naming what does), frames lie there without a note,
    /// or another program is at work; with `restart` what is there is removed instead.
    MovieFolder(const std::filesystem::path& folder, const FramePattern& pattern,
                const nlohmann::ordered_json& decided_by, bool restart);
    ~MovieFolder();
    MovieFolder(const MovieFolder&) = delete;
    MovieFolder& operator=(const MovieFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }
    std::filesystem::path frame_path(int frame) const { return folder_ / pattern_.name(frame); }
    /// Frames appear whole, so one that is there is done.
    bool has(int frame) const { return std::filesystem::exists(frame_path(frame)); }

    /// Removes frames, note and folder (where nothing else is in it).
    void remove();

  private:
    void lock();
    void remove_frames() const;

    std::filesystem::path folder_;
    FramePattern pattern_;
    int lock_ = -1;
};
