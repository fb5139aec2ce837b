// A long measurement as a list of small pieces, each in the journal when it is done; what is there is not done again.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/accuracy/journal.h"
#include "engine/error.h"

namespace edgesplat::accuracy {

/// How far a measurement is.
struct Progress {
    double done = 0;          ///< share of the expected time, 0..1
    double seconds_left = 0;  ///< by what such pieces took so far
    std::size_t pieces_done = 0, pieces = 0;
    std::string what;  ///< what is being done, a few words
};

/// Called between pieces and within long ones; returning false stops the measurement.
using ProgressFunction = std::function<bool(const Progress&)>;

/// Thrown where the progress function said no. What was finished is in the journal.
class Interrupted : public Error {
  public:
    using Error::Error;
};

/// Something to be measured.
struct Piece {
    std::string kind;  ///< pieces of one kind take about as long as one another
    std::string key;   ///< in the journal
    std::string what;  ///< for those who wait
    std::function<nlohmann::ordered_json()> run;
};

/// Does what the journal has not.
class WorkList {
  public:
    WorkList(Journal& journal, ProgressFunction progress) : journal_(journal), progress_(std::move(progress)) {}

    /// `expected_seconds` counts until a piece of that kind has been timed.
    void add(Piece piece, double expected_seconds = 1);

    /// Runs all pieces in order. Throws Interrupted, or what a piece throws.
    void run();

    /// From within a piece: whether to go on.
    bool go_on(double share_of_piece = 0);

    /// The same, throwing Interrupted if not.
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
    double spent_ = 0;  ///< expected or true seconds of what is done
};

}  // namespace edgesplat::accuracy
