// Numbered frames to a film, by the program ffmpeg.
#pragma once

#include <filesystem>
#include <string>

/// What is to be encoded.
struct Encoding {
    std::filesystem::path folder;  ///< of the frames; takes what the encoder says (encoder.log) and the unfinished film
    std::string pattern;           ///< of the frames' names, such as frame_%05d.png
    int first = 0, count = 0;      ///< frames
    double fps = 25;
    std::filesystem::path output;  ///< .mp4 (H.264) or .webm (VP9); appears whole or not at all
};

/// Refuses, before anything is rendered, where there is no ffmpeg. Throws edgesplat::Error naming the package.
void check_encoder();

/// Runs ffmpeg. Throws edgesplat::Error with the last thing it said.
void encode(const Encoding& encoding);
