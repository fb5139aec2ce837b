// A bar with the time left on stderr, where that is a terminal, and Ctrl-C as a request to stop.
#pragma once

#include <chrono>
#include <functional>
#include <string>

inline constexpr int kStoppedStatus = 130;  ///< what a shell says of a program that Ctrl-C ended

/// Runs `body`; where it ends by accuracy::Interrupted, says so and sets kStoppedStatus.
void run_until_stopped(int& exit_status, const std::function<void()>& body);

/// Draws at most ten times a second; takes its line away when it goes.
class ProgressBar {
  public:
    explicit ProgressBar(bool quiet);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void update(double done, double seconds_left, const std::string& what);

  private:
    bool shown_ = false, visible_;
    std::chrono::steady_clock::time_point last_;
};

/// While it lives, the first SIGINT or SIGTERM is only noted; a second one ends the program at once. With `last_words`
/// the program ends with them and kStoppedStatus where a second has passed and this still lives: for work of which
/// nothing is lost by that, and which may be busy for long with something that cannot be left off. A file that is being
/// written is written first.
class StopRequest {
  public:
    /// `last_words`: outlive this; no end of line.
    explicit StopRequest(const char* last_words = nullptr);
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    bool asked() const;
};
