#include "engine/image/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "engine/error.h"
#include "engine/files/memory_file.h"
#include "engine/image/image_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

std::string script_of(const Plot& figure, PlotFormat format) {
    const bool svg = format == PlotFormat::Svg;
    std::string script = svg ? "set terminal svg size 720,440 font 'sans-serif,13' background 'white'\n"
                             : "set terminal pngcairo size 900,600 enhanced font ',12'\n";
    script += fmt::format("set title '{}'\nset xlabel '{}'\nset ylabel '{}'\nset xrange [{}:{}]\n{}\n", figure.title,
                          figure.x_label, figure.y_label, figure.low, figure.high, figure.extra);
    const int steps = svg ? 600 : 1200;  // every point is text in an SVG
    std::string plot = "plot ";
    for (std::size_t c = 0; c < figure.curves.size(); ++c) {
        const Curve& curve = figure.curves[c];
        script += fmt::format("$curve{} << EOD\n", c);
        for (int i = 0; i <= steps; ++i) {
            const double x = figure.low + (figure.high - figure.low) * i / steps;
            script += fmt::format("{:.8g} {:.8g}\n", x, curve.y(x));
        }
        script += "EOD\n";
        plot += fmt::format("{}$curve{} with lines {} {}", c == 0 ? "" : ", ", c, curve.style,
                            curve.title.empty() ? "notitle" : "title '" + curve.title + "'");
    }
    return script + plot + "\n";
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
    const MemoryFile in, out;
    in.fill(script);
    // Starts gnuplot without a shell, so that paths need no quoting.
    std::string program = "gnuplot";
    char* arguments[] = {program.data(), nullptr};
    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_adddup2(&files, in.descriptor(), STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&files, out.descriptor(), STDOUT_FILENO);
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, program.c_str(), &files, nullptr, arguments, environ);
    ::posix_spawn_file_actions_destroy(&files);
    int status = 0;
    if (problem == 0) ::waitpid(child, &status, 0);
    if (problem == ENOENT || (WIFEXITED(status) && WEXITSTATUS(status) == 127))
        fail("gnuplot is not installed (Debian: gnuplot-nox); it draws the plots");
    if (problem != 0) fail("gnuplot cannot be started: {}", std::generic_category().message(problem));
    std::string drawn = out.text();
    if (status != 0 || drawn.empty()) fail("gnuplot failed (status {})", status);
    return drawn;
}

void draw_script(const std::string& script, const fs::path& target) {
    const fs::path folder = target.parent_path();
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) fail("{}: {}", folder.string(), error.message());
    check_output_path(target);
    const FileContent file{target, run_gnuplot(script)};
    write_files({&file, 1});
}

fs::path draw(const Plot& plot, const fs::path& folder, PlotFormat format) {
    fs::path target = folder / (plot.name + (format == PlotFormat::Svg ? ".svg" : ".png"));
    draw_script(script_of(plot, format), target);
    return target;
}

}  // namespace edgesplat
