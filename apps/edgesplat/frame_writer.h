// Frames that become files while the next ones are drawn.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <vector>

#include "engine/image/image_file.h"

/// Encodes frames on threads of their own and writes them on the caller's.
class FrameWriter {
  public:
    /// At most `in_flight` >= 1 frames are held at a time.
    explicit FrameWriter(std::size_t in_flight) : in_flight_(in_flight) {}
    /// Writes what is left, as far as it can: frames that are drawn are kept where another one fails.
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Begins with a frame as soon as there is room, for which the first one is written. Throws what that one threw.
    void add(std::function<std::vector<edgesplat::FileContent>()> encode);
    /// Writes all frames, in their order; throws what the first of them threw that did.
    void finish();

  private:
    void write_first();

    std::size_t in_flight_;
    std::deque<std::future<std::vector<edgesplat::FileContent>>> frames_;
};
