#include "apps/edgesplat/movie_encoder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include "engine/error.h"

namespace fs = std::filesystem;
using edgesplat::fail;

namespace {

/// A path as ffmpeg's image patterns read it: a percent sign is written twice.
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
        // Even sides, and the colours of high definition television, said so.
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

std::string last_lines(const fs::path& log) {
    std::ifstream file(log);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) lines.push_back(line);
    std::string text;
    for (std::size_t i = lines.size() > 4 ? lines.size() - 4 : 0; i < lines.size(); ++i)
        text += (text.empty() ? "" : "; ") + lines[i];
    return text.empty() ? "it said nothing" : text;
}

}  // namespace

void check_encoder() {
    const char* path = std::getenv("PATH");
    std::stringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((folder.empty() ? "ffmpeg" : folder + "/ffmpeg").c_str(), X_OK) == 0) return;
    fail(
        "the program ffmpeg is not installed (Debian: ffmpeg); it makes films of frames. Frames alone need none: "
        "-o FOLDER/frame_%04d.png");
}

void encode(const Encoding& encoding) {
    const fs::path film = encoding.folder / ("unfinished" + encoding.output.extension().string());
    const fs::path log = encoding.folder / "encoder.log";
    std::vector<std::string> arguments = arguments_for(encoding, film);
    std::vector<char*> pointers;
    for (std::string& argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, "ffmpeg", &files, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (problem != 0) fail("ffmpeg cannot be started: {}", std::generic_category().message(problem));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    std::error_code error;
    if (status != 0 || !fs::exists(film, error))
        fail("ffmpeg could not make {} (status {}): {}. All it said is in {}, the frames are beside it",
             encoding.output.string(), status, last_lines(log), log.string());
    fs::rename(film, encoding.output, error);
    if (error) fail("{}: {}", encoding.output.string(), error.message());
    fs::remove(log, error);
}
