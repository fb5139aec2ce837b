// Collects the times of pictures, for reports.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/viewer/drawer.h"

class FrameTimes {
  public:
    void add(const edgesplat::viewer::DrawnPicture& picture);
    void clear();
    /// Writes the times as JSON. Throws Error.
    void write(const std::filesystem::path& path, double target) const;
    std::size_t moving() const { return moving_.size(); }

  private:
    struct Moving {
        double milliseconds = 0;
        edgesplat::viewer::Rung rung;
    };
    std::vector<Moving> moving_;
    std::vector<double> standstills_;  ///< milliseconds from a request to its complete picture
    std::uint64_t number_ = 0;
    double spent_ = 0;
};
