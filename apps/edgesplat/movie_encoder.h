// Encodes numbered frames to a film with the program ffmpeg.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

/// Input and output of an encoding.
struct Encoding {
    std::filesystem::path folder;  ///< of the frames and the unfinished film
    std::string pattern;           ///< of the frames' names, such as frame_%05d.png
    int first = 0, count = 0;      ///< frames
    double fps = 25;
    std::filesystem::path output;  ///< .mp4 (H.264) or .webm (VP9); written completely or not at all
};

/// Checks, before anything is rendered, that ffmpeg is installed. Throws edgesplat::Error naming the package.
void check_encoder();

/// Runs ffmpeg and polls `stop`. Returns false if stopped; then no film is left. Throws edgesplat::Error with the last
/// lines of ffmpeg's output.
bool encode(const Encoding& encoding, const std::function<bool()>& stop);
