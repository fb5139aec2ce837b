// Runs a long measurement as a list of small pieces. Finished pieces are in the journal and are not run again.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/accuracy/journal.h"
#include "engine/error.h"

namespace edgesplat::accuracy {

/// Progress of a measurement.
struct Progress {
    double done = 0;          ///< share of the expected time, 0..1
    double seconds_left = 0;  ///< estimate from the time of such pieces so far
    std::size_t pieces_done = 0, pieces = 0;
    std::string what;  ///< the current work, a few words
};

/// Called between pieces and within long ones; returning false stops the measurement.
using ProgressFunction = std::function<bool(const Progress&)>;

/// Thrown if the progress function returns false. Finished pieces are in the journal.
class Interrupted : public Error {
  public:
    using Error::Error;
};

/// A piece of a measurement.
struct Piece {
    std::string kind;  ///< pieces of one kind take about the same time
    std::string key;   ///< in the journal
    std::string what;  ///< shown as progress
    std::function<nlohmann::ordered_json()> run;
};

/// Runs the pieces that are not in the journal.
class WorkList {
  public:
    WorkList(Journal& journal, ProgressFunction progress) : journal_(journal), progress_(std::move(progress)) {}

    /// `expected_seconds` is used until a piece of that kind has been timed.
    void add(Piece piece, double expected_seconds = 1);

    /// Runs all pieces in order. Throws Interrupted, or what a piece throws.
    void run();

    /// Called within a piece: whether to continue.
    bool should_continue(double share_of_piece = 0);

    /// The same, but throws Interrupted instead of returning false.
    void check(double share_of_piece = 0);

    /// Throws Interrupted.
    [[noreturn]] void stop() const;

  private:
    struct Kind {
        double seconds = 0, expected = 1;
        std::size_t timed = 0, left = 0;
        double each() const { return timed > 0 ? seconds / static_cast<double>(timed) : expected; }
    };
    Kind& kind(const std::string& name);

    Journal& journal_;
    ProgressFunction progress_;
    std::vector<Piece> pieces_;
    std::vector<std::pair<std::string, Kind>> kinds_;
    std::size_t current_ = 0;
    double spent_ = 0;  ///< seconds of the finished pieces
};

}  // namespace edgesplat::accuracy
