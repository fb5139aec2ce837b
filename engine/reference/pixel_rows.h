// A picture computed row by row on every core, with a report of progress that can stop it.
#pragma once

#include <functional>

#include "engine/error.h"

namespace edgesplat::reference {

/// Thrown where the progress function said no.
class Cancelled : public Error {
  public:
    using Error::Error;
};

/// Given the share done, 0..1; false stops.
using Progress = std::function<bool(double done)>;

/// Throws Error unless both are 1 to 16384 pixels.
void check_picture_size(int width, int height);

/// Calls `row(y)` for every y in [0, height), several at a time and in an order in which cheap and dear rows mix.
/// `progress` may be empty; it is called from the calling thread only, at the end with 1. Throws Cancelled, or what a
/// row threw.
void for_each_row(int height, const Progress& progress, const std::function<void(int y)>& row);

}  // namespace edgesplat::reference
