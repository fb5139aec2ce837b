// How coarsely pictures are drawn while something moves, so that each is there in time.
#pragma once

#include <span>
#include <vector>

namespace edgesplat::viewer {

/// How coarse a picture is: the volume's resolution (voxels of 2^level along each axis), its width and height as a
/// share of the window's, and whether rays are cast through the values in place of splatting.
struct Rung {
    int level = 0;
    double scale = 1;
    bool rays = false;
    bool operator==(const Rung&) const = default;
};

/// Shares of the window's width and height that pictures are drawn with, coarsest first.
std::span<const double> pace_scales();

/// Chooses the rung of the next picture from what those before it took. It goes down at once when a picture nears the
/// target, and up only after several that leave room, so that quality does not flicker.
class Pace {
  public:
    /// `target`: milliseconds that a picture may take, > 0. Levels 0 to `coarsest` may be drawn, or with `rays` level 0
    /// alone.
    Pace(double target, int coarsest, bool rays = false);

    void set_target(double milliseconds);
    double target() const { return target_; }
    const Rung& rung() const { return rung_; }

    /// What the picture just drawn with `rung()` took, milliseconds; `setup`: the part of it that the next one will
    /// not need again (estimation, collection). `finer_ready`: the level below can be drawn without a setup.
    void drawn(double milliseconds, double setup, bool finer_ready);

    /// Another volume, scene or place: what was measured says nothing about it.
    void restart();

  private:
    void go_down(double milliseconds);
    void go_up(double milliseconds, bool finer_ready);

    double target_;
    int coarsest_;
    Rung rung_;
    int calm_ = 0;           ///< pictures in a row that left room
    int since_finer_ = -1;   ///< pictures since a finer level was tried; -1: not on trial
    int finer_blocked_ = 0;  ///< pictures until a finer level may be tried again
    int finer_penalty_ = 0;  ///< how many trials failed
};

}  // namespace edgesplat::viewer
