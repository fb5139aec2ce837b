// Encodes and writes frames while the next ones are drawn.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <vector>

#include "engine/image/image_file.h"

/// Encodes frames on worker threads and writes them on the caller's thread.
class FrameWriter {
  public:
    /// Holds at most `in_flight` frames at a time, >= 1.
    explicit FrameWriter(std::size_t in_flight) : in_flight_(in_flight) {}
    /// Writes the remaining frames as far as possible; an error of one frame does not lose the others.
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Starts to encode a frame. If `in_flight` frames are held, it first writes the oldest one and throws that frame's
    /// error.
    void add(std::function<std::vector<edgesplat::FileContent>()> encode);
    /// Writes all frames in order; throws the first error.
    void finish();

  private:
    void write_first();

    std::size_t in_flight_;
    std::deque<std::future<std::vector<edgesplat::FileContent>>> frames_;
};
