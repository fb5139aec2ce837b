#include "apps/edgesplat/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "engine/accuracy/work_list.h"
#include "footprints/temporary_file.h"

namespace {

volatile std::sig_atomic_t is_stop_requested = 0;

const char* exit_message = nullptr;

// Only async-signal-safe calls, see signal-safety(7).
void note_stop(int signal) {
    is_stop_requested = 1;
    std::signal(signal, SIG_DFL);
    if (exit_message != nullptr) alarm(1);
}

void end_now(int) {
    if (edgesplat::DeferSignals::any()) {
        alarm(1);
        return;
    }
    for (const char* text : {"edgesplat: ", exit_message, "\n"})
        if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
    _exit(kStoppedStatus);
}

}  // namespace

std::string duration_text(double seconds) {
    const auto s = static_cast<long>(seconds + 0.5);
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
    return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

void run_until_stopped(int& exit_status, const std::function<void()>& body) {
    try {
        body();
    } catch (const edgesplat::accuracy::Interrupted& interrupted) {
        fmt::print(stderr, "edgesplat: {}\n", interrupted.what());
        exit_status = kStoppedStatus;
    }
}

ProgressBar::ProgressBar(bool quiet) : visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double done, double seconds_left, const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    if (!visible_ || (shown_ && now - last_ < std::chrono::milliseconds(100))) return;
    last_ = now;
    shown_ = true;
    constexpr int kWidth = 24;
    const int filled = std::clamp(static_cast<int>(done * kWidth), 0, kWidth);
    fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3.0f} %  {} left  {:.40}", "", filled, "", kWidth - filled,
               100 * done, duration_text(seconds_left), what);
    std::fflush(stderr);
}

ProgressLine::~ProgressLine() {
    if (shown_ && isatty(STDERR_FILENO) == 1) std::fputs("\r\033[K", stderr);
}

void ProgressLine::update(double fraction, std::string_view what) {
    using namespace std::chrono;
    const bool terminal = isatty(STDERR_FILENO) == 1;
    const auto now = Clock::now();
    if (quiet_ || now - begin_ < seconds(1) || now - last_ < (terminal ? milliseconds(100) : milliseconds(5000)))
        return;
    last_ = now;
    shown_ = true;
    constexpr int kWidth = 30;
    const int filled = std::clamp(static_cast<int>(fraction * kWidth), 0, kWidth);
    fmt::print(stderr, "{}[{:#<{}}{:.<{}}] {:3.0f} % {}{}", terminal ? "\r\033[K" : "", "", filled, "", kWidth - filled,
               100 * fraction, what, terminal ? "" : "\n");
    std::fflush(stderr);
}

StopRequest::StopRequest(const char* last_words) {
    is_stop_requested = 0;
    exit_message = last_words;
    std::signal(SIGALRM, end_now);
    std::signal(SIGINT, note_stop);
    std::signal(SIGTERM, note_stop);
}

StopRequest::~StopRequest() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    alarm(0);
    std::signal(SIGALRM, SIG_DFL);
}

bool StopRequest::asked() const {
    return is_stop_requested != 0;
}
