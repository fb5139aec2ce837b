// A progress bar on stderr (if it is a terminal), and Ctrl-C as a request to stop.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

inline constexpr int kStoppedStatus = 130;  ///< exit status that a shell reports for a program ended by Ctrl-C

/// Runs `body`. If it throws accuracy::Interrupted, prints the message and sets `exit_status` to kStoppedStatus.
void run_until_stopped(int& exit_status, const std::function<void()>& body);

/// A duration in words: "40 s", "2:05 min".
std::string duration_text(double seconds);

/// Redraws at most ten times a second. The destructor erases the line.
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

/// Progress of work that is usually short: shown only if it takes longer than a second, as a bar on a terminal, else as
/// a few lines. The destructor erases the bar.
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet) : quiet_(quiet) {}
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void update(double fraction, std::string_view what);

  private:
    using Clock = std::chrono::steady_clock;
    bool quiet_, shown_ = false;
    Clock::time_point begin_ = Clock::now(), last_ = begin_ - std::chrono::hours(1);
};

/// While this object exists, the first SIGINT or SIGTERM is only recorded; a second one ends the program at once. With
/// `last_words`, the program also ends if this object still exists one second after the first signal: it prints that
/// text and exits with kStoppedStatus, but finishes a file that is being written. Use it for work that loses nothing if
/// it ends at once, and that cannot always poll asked().
class StopRequest {
  public:
    /// `last_words`: must outlive this object; no line end.
    explicit StopRequest(const char* last_words = nullptr);
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    bool asked() const;
};
