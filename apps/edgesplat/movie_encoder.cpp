#include "apps/edgesplat/movie_encoder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>
#include <vector>

#include "engine/error.h"
#include "engine/files/memory_file.h"

namespace fs = std::filesystem;
using edgesplat::fail;

namespace {

constexpr int kNotStarted = 127;  ///< exit status that a shell reports for a missing program

/// Escapes a path for ffmpeg's image patterns: % becomes %%.
std::string escaped(const std::string& path) {
    std::string text;
    for (const char c : path)
        text += c == '%' ? std::string("%%") : std::string(1, c);
    return text;
}

std::vector<std::string> arguments_for(const Encoding& encoding, const fs::path& film) {
    std::vector<std::string> arguments{
        "ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "warning", "-y", "-framerate",
        fmt::format("{}", encoding.fps), "-start_number", fmt::format("{}", encoding.first), "-i",
        escaped(fs::absolute(encoding.folder).string()) + "/" + encoding.pattern, "-frames:v",
        fmt::format("{}", encoding.count),
        // Even sides; colours of high definition television (BT.709), declared in the stream.
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709", "-pix_fmt", "yuv420p", "-colorspace",
        "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-map_metadata", "-1"};
    const bool webm = encoding.output.extension() == ".webm";
    const std::vector<std::string> codec =
        webm ? std::vector<std::string>{"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-f", "webm"}
             : std::vector<std::string>{"-c:v", "libx264",   "-crf",       "17", "-preset",
                                        "slow", "-movflags", "+faststart", "-f", "mp4"};
    arguments.insert(arguments.end(), codec.begin(), codec.end());
    arguments.push_back(fs::absolute(film).string());
    return arguments;
}

std::string last_lines(const std::string& messages) {
    std::istringstream file(messages);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) lines.push_back(line);
    std::string text;
    for (std::size_t i = lines.size() > 4 ? lines.size() - 4 : 0; i < lines.size(); ++i)
        text += (text.empty() ? "" : "; ") + lines[i];
    return text.empty() ? "no output" : text;
}

/// Starts ffmpeg, which ends with this process. Otherwise a killed and continued movie could be encoded twice at once.
pid_t start(std::vector<std::string>& arguments, int messages) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const pid_t parent = ::getpid(), child = ::fork();
    if (child == 0) {  // only async-signal-safe calls here
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() == parent && ::dup2(messages, STDOUT_FILENO) >= 0 && ::dup2(messages, STDERR_FILENO) >= 0)
            ::execvp("ffmpeg", pointers.data());
        ::_exit(kNotStarted);
    }
    if (child < 0) fail("ffmpeg cannot be started: {}", std::generic_category().message(errno));
    return child;
}

/// Waits for ffmpeg. Returns the status of waitpid, or nullopt if stopped.
std::optional<int> wait_for(pid_t child, const std::function<bool()>& stop) {
    int status = 0;
    bool stopped = false;
    while (::waitpid(child, &status, WNOHANG) == 0) {
        stopped |= stop();
        if (stopped) ::kill(child, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    // A terminal's Ctrl-C ends ffmpeg, too.
    if (stopped || (status != 0 && stop())) return std::nullopt;
    return status;
}

}  // namespace

void check_encoder() {
    const char* path = std::getenv("PATH");
    std::stringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((folder.empty() ? "ffmpeg" : folder + "/ffmpeg").c_str(), X_OK) == 0) return;
    fail(
        "the program ffmpeg, which encodes films, is not installed (Debian: ffmpeg); numbered frames do not need it: "
        "-o FOLDER/frame_%04d.png");
}

bool encode(const Encoding& encoding, const std::function<bool()>& stop) {
    const fs::path film = encoding.folder / ("unfinished" + encoding.output.extension().string());
    std::vector<std::string> arguments = arguments_for(encoding, film);
    const edgesplat::MemoryFile messages;
    const std::optional<int> status = wait_for(start(arguments, messages.descriptor()), stop);
    std::error_code error;
    if (!status) {
        fs::remove(film, error);
        return false;
    }
    try {
        if (WIFEXITED(*status) && WEXITSTATUS(*status) == kNotStarted) fail("ffmpeg cannot be started");
        if (*status != 0 || !fs::exists(film, error))
            fail("ffmpeg could not write {} (status {}): {}. The frames are in {}", encoding.output.string(),
                 WIFEXITED(*status) ? WEXITSTATUS(*status) : *status, last_lines(messages.text()),
                 encoding.folder.string());
        const int written = ::open(film.c_str(), O_RDONLY | O_CLOEXEC);
        const bool synced = written >= 0 && ::fsync(written) == 0;
        const int problem = errno;
        if (written >= 0) ::close(written);
        if (!synced) fail("{}: {}", encoding.output.string(), std::generic_category().message(problem));
        fs::rename(film, encoding.output, error);
        if (error) fail("{}: {}", encoding.output.string(), error.message());
    } catch (...) {
        fs::remove(film, error);
        throw;
    }
    return true;
}
