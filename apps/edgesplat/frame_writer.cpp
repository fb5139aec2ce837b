#include "apps/edgesplat/frame_writer.h"

#include <utility>

FrameWriter::~FrameWriter() {
    while (!frames_.empty())
        try {
            write_first();
        } catch (...) {
            // The error that ended the movie has been reported.
            continue;
        }
}

void FrameWriter::add(std::function<std::vector<edgesplat::FileContent>()> encode) {
    while (frames_.size() >= in_flight_)
        write_first();
    frames_.push_back(std::async(std::launch::async, std::move(encode)));
}

void FrameWriter::finish() {
    while (!frames_.empty())
        write_first();
}

void FrameWriter::write_first() {
    auto first = std::move(frames_.front());
    frames_.pop_front();
    edgesplat::write_files(first.get());
}
