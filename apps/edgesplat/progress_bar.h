// A bar with the time left on stderr, where that is a terminal, and Ctrl-C as a request to stop.
#pragma once

#include <chrono>
#include <string>

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

/// While it lives, the first SIGINT or SIGTERM is only noted; a second one ends the program at once.
class StopRequest {
  public:
    StopRequest();
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    bool asked() const;
};
