// Numbered frames to a film, by the program ffmpeg.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

/// What is to be encoded.
struct Encoding {
    std::filesystem::path folder;  ///< of the frames; takes the unfinished film
    std::string pattern;           ///< of the frames' names, such as frame_%05d.png
    int first = 0, count = 0;      ///< frames
    double fps = 25;
    std::filesystem::path output;  ///< .mp4 (H.264) or .webm (VP9); appears whole or not at all
};

/// Refuses, before anything is rendered, where there is no ffmpeg. Throws edgesplat::Error naming the package.
void check_encoder();

/// Runs ffmpeg until it is done or `stop` says so, which is asked all the time; false where it was stopped: then as if
/// it had not been called. Throws edgesplat::Error with the last thing ffmpeg said.
bool encode(const Encoding& encoding, const std::function<bool()>& stop);
