// Chooses the resolution of pictures in motion, so that each is finished in time.
#pragma once

#include <span>
#include <vector>

namespace edgesplat::viewer {

/// Resolution of a picture: the volume's level (voxels of 2^level along each axis), its width and height as a share of
/// the window's, and whether it is ray cast through the values instead of splatted.
struct Rung {
    int level = 0;
    double scale = 1;
    bool rays = false;
    bool operator==(const Rung&) const = default;
};

/// Shares of the window's width and height at which pictures are drawn, coarsest first.
std::span<const double> pace_scales();

/// Chooses the rung of the next picture from the times of the previous ones. It steps down as soon as a picture nears
/// the target. It steps up only after several pictures with time to spare, so that quality does not flicker.
class Pace {
  public:
    /// `target`: time limit of a picture, milliseconds, > 0. Levels 0 to `coarsest` may be drawn; with `rays`, only
    /// level 0.
    Pace(double target, int coarsest, bool rays = false);

    void set_target(double milliseconds);
    double target() const { return target_; }
    const Rung& rung() const { return rung_; }

    /// Reports the picture drawn last with `rung()`: its time in milliseconds, and `setup`, the part of it that the
    /// next picture does not need (estimation, collection). `finer_ready`: the next finer level can be drawn without
    /// setup.
    void drawn(double milliseconds, double setup, bool finer_ready);

    /// Discards all measurements and starts at the coarsest level: for another volume, scene or place.
    void restart();

  private:
    void step_down(double milliseconds);
    void step_up(double milliseconds, bool finer_ready);

    double target_;
    int coarsest_;
    Rung rung_;
    int calm_ = 0;           ///< consecutive pictures with time to spare
    int since_finer_ = -1;   ///< pictures since a finer level was tried; -1: no trial
    int finer_blocked_ = 0;  ///< pictures until a finer level may be tried again
    int finer_penalty_ = 0;  ///< number of failed trials
};

}  // namespace edgesplat::viewer
