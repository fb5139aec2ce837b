#include "apps/edgesplat/movie_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>

#include "apps/device_options.h"
#include "apps/edgesplat/film.h"
#include "apps/edgesplat/frame_writer.h"
#include "apps/edgesplat/max_error_option.h"
#include "apps/edgesplat/movie_encoder.h"
#include "apps/edgesplat/movie_folder.h"
#include "apps/edgesplat/mpi_ranks.h"
#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/render_command.h"
#include "apps/edgesplat/render_output.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/error.h"
#include "engine/scene/camera_path.h"
#include "engine/scene/scene_file.h"

namespace {

namespace fs = std::filesystem;
using edgesplat::fail;
using edgesplat::SceneDocument;

// Most frames that are encoded while the next one is drawn; at most one per processor.
constexpr unsigned kMaxFramesInFlight = 8;

/// First and last frame, both included.
struct FrameRange {
    int first = 0, last = 0;
};

/// Values of the command line.
struct MovieCommand {
    std::vector<std::string> sources;
    std::string output;
    VolumeOptions volume;
    DocumentEdits edits;
    std::optional<double> orbit, seconds, fps;
    std::optional<FrameRange> range;
    edgesplat::DeviceChoice device;
    bool keep_frames = false, restart = false, quiet = false;
};

/// Output paths of frames and film.
struct Places {
    fs::path folder;
    std::string pattern;
    bool film = false;
};

Places places_of(const MovieCommand& command) {
    const fs::path output(command.output);
    const std::string extension = output.extension().string();
    if (extension == ".mp4" || extension == ".webm") {
        edgesplat::check_output_path(output);
        check_encoder();
        return {output.string() + ".frames", "frame_%05d.png", true};
    }
    if (extension != ".png" && extension != ".exr")
        fail("{}: expected a film (.mp4 or .webm) or numbered frames such as frames/frame_%04d.png or .exr",
             command.output);
    FramePattern checked(output.filename().string());
    return {output.parent_path(), output.filename().string(), false};
}

SceneDocument document_of(const MovieCommand& command, std::vector<fs::path>& folders) {
    SceneDocument document;
    read_sources(command.sources, document, folders);
    apply(command.volume, document.volume);
    command.edits.apply(document);
    document.output.file.clear();
    if (command.fps) document.movie.fps = *command.fps;
    if (command.orbit) {
        document.movie.path.clear();
        document.movie.flight.reset();
        document.movie.orbit = edgesplat::OrbitChoice{};
        document.movie.orbit->degrees = *command.orbit;
        if (command.seconds) document.movie.orbit->seconds = *command.seconds;
    }
    check_film(document);
    std::string text;
    for (const edgesplat::DocumentProblem& problem : problems_of(document, folders))
        text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", problem.path, problem.text);
    if (!text.empty()) fail("{}", text);
    return document;
}

FrameRange range_of(const MovieCommand& command, const Film& film) {
    const int last = film.count - 1;
    const FrameRange range = command.range.value_or(FrameRange{0, last});
    if (range.last > last) fail("--frames: the movie's last frame is {}, not {}", last, range.last);
    return range;
}

/// The inputs that determine the frames, for the note in their folder.
nlohmann::ordered_json decisions(const Film& film, const edgesplat::DeviceInfo& device) {
    const glm::ivec2& size = film.document.output.size;
    return {{"program", "edgesplat " EDGESPLAT_VERSION},
            {"scene", scene_text(film.document)},
            {"volume", fmt::format("{:016x}", film.volume->checksum)},
            {"size", fmt::format("{}x{}", size.x, size.y)},
            {"frames per second", film.fps},
            {"device", fmt::format("{}, {} {}", device.name, device.driver, device.driver_version)}};
}

/// Draws a frame; the writer encodes and stores it.
void make_frame(Film& film, edgesplat::Renderer& renderer, int frame, const fs::path& file, FrameWriter& writer) {
    std::vector<RenderedFrame> frames(1);
    frames[0].settings = film.settings;
    frames[0].result = draw_frame(film, renderer, frame);
    const edgesplat::ImageMetadata metadata{{"Software", "edgesplat " EDGESPLAT_VERSION},
                                            {"edgesplat:volume", film.document.volume.path},
                                            {"edgesplat:checksum", fmt::format("{:016x}", film.volume->checksum)}};
    writer.add([file, metadata, drawn = std::make_shared<const std::vector<RenderedFrame>>(std::move(frames))] {
        return picture_files(file, *drawn, metadata);
    });
}

/// Number of existing frames, and the missing frames that this rank draws: of N ranks, each draws every N-th.
struct Missing {
    std::size_t there = 0;
    std::vector<int> frames;
};

Missing missing_frames(const FrameRange& range, const fs::path& folder, const FramePattern& pattern, bool quiet) {
    const int all = range.last - range.first + 1;
    // Only the first rank looks for files, before any rank starts to write.
    std::vector<unsigned char> there(static_cast<std::size_t>(all));
    if (ranks::first())
        for (int i = 0; i < all; ++i)
            there[static_cast<std::size_t>(i)] = fs::exists(folder / pattern.name(range.first + i)) ? 1 : 0;
    ranks::share(std::span(there));
    Missing mine{static_cast<std::size_t>(std::count(there.begin(), there.end(), 1)), {}};
    if (mine.there > 0 && !quiet) fmt::print("{}: {} of {} frames exist already\n", folder.string(), mine.there, all);
    int missing = 0;
    for (int i = 0; i < all; ++i)
        if (there[static_cast<std::size_t>(i)] == 0 && missing++ % ranks::count() == ranks::index())
            mine.frames.push_back(range.first + i);
    return mine;
}

/// Renders the missing frames. Returns false if stopped.
bool make_frames(Film& film, edgesplat::Renderer& renderer, const fs::path& folder, const FramePattern& pattern,
                 const Missing& to_make, const StopRequest& stop, bool quiet) {
    const auto& [there, missing] = to_make;
    const std::size_t all = there + missing.size();
    using Clock = std::chrono::steady_clock;
    ProgressBar bar(quiet);
    FrameWriter writer(std::clamp(std::thread::hardware_concurrency(), 1U, kMaxFramesInFlight));
    bool whole = true;
    const auto start = Clock::now();
    renderer.set_interruption([&] { return stop.asked(); });
    for (std::size_t done = 0; done < missing.size(); ++done) {
        whole = !stop.asked();
        if (!whole) break;
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        const double left =
            done == 0 ? 0 : seconds / static_cast<double>(done) * static_cast<double>(missing.size() - done);
        bar.update(static_cast<double>(there + done) / static_cast<double>(all), left,
                   fmt::format("frame {} of {}", there + done + 1, all));
        try {
            make_frame(film, renderer, missing[done], folder / pattern.name(missing[done]), writer);
        } catch (const edgesplat::Interrupted&) {
            whole = false;
            break;
        }
    }
    renderer.set_interruption({});
    writer.finish();
    return whole;
}

/// Checks that all frames exist and encodes the film. Returns false if stopped.
bool finish(const MovieCommand& command, const FrameRange& range, double fps, const Places& places, MovieFolder& folder,
            const StopRequest& stop) {
    const int count = range.last - range.first + 1;
    for (int frame = range.first; frame <= range.last; ++frame)
        if (!folder.has(frame))
            fail("{}: this frame is missing; all ranks must use the same folder", folder.frame_path(frame).string());
    if (places.film) {
        if (!encode({places.folder, places.pattern, range.first, count, fps, command.output},
                    [&] { return stop.asked(); }))
            return false;
        if (!command.keep_frames) folder.remove();
    }
    if (!command.quiet)
        fmt::print("{}: {} frames, {:.4g} s at {:g} frames per second\n", command.output, count, count / fps, fps);
    return true;
}

void stopped(const fs::path& folder, int& exit_status) {
    exit_status = kStoppedStatus;
    if (ranks::first())
        fmt::print(stderr, "edgesplat: stopped; the frames so far are in {}; run the same command again to continue\n",
                   folder.string());
}

void run(const MovieCommand& command, int& exit_status) {
    const Places places = places_of(command);
    std::vector<fs::path> folders;
    SceneDocument document = document_of(command, folders);
    start_volume(document);
    edgesplat::Volume volume = load_with_progress(document, folders, command.quiet);
    Film film =
        film_of(document, folders, std::make_shared<const edgesplat::Volume>(std::move(volume)), command.seconds);
    const FrameRange range = range_of(command, film);
    edgesplat::Renderer renderer(command.device);
    renderer.set_volume(film.volume);
    const FramePattern pattern(places.pattern);
    const fs::path path = places.folder.empty() ? "." : places.folder;
    std::optional<MovieFolder> folder;
    if (ranks::first()) folder.emplace(path, pattern, decisions(film, renderer.device()), command.restart);
    const edgesplat::Scene first = scene_at(film, film.path.keys.front().time);
    if (ranks::first())
        apply_max_error(film.document.quality.max_error, renderer, *film.volume, first,
                        camera_at(film.path, film.path.keys.front().time), film.document.output.size, film.settings,
                        command.quiet);
    ranks::share(std::span(&film.settings, 1));
    const Missing missing = missing_frames(range, path, pattern, command.quiet);
    const StopRequest stop("stopped; run the same command again to continue from the existing frames");
    if (ranks::any(!make_frames(film, renderer, path, pattern, missing, stop, command.quiet))) {
        stopped(path, exit_status);
        return;
    }
    if (renderer.validation_messages() > 0)
        fail("the frames are written, but Vulkan validation reported {} messages", renderer.validation_messages());
    ranks::wait();
    if (!ranks::first()) return;
    if (!finish(command, range, film.fps, places, *folder, stop)) stopped(path, exit_status);
}

FrameRange parse_range(const std::string& text) {
    FrameRange range;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, range.first);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == ':') {
        const auto last = std::from_chars(first.ptr + 1, end, range.last);
        if (last.ec == std::errc() && last.ptr == end && range.first >= 0 && range.last >= range.first) return range;
    }
    throw CLI::ValidationError("--frames", fmt::format("'{}' is not FIRST:LAST, such as 0:99", text));
}

void add_movie_options(CLI::App& app, MovieCommand& command) {
    constexpr const char* kGroup = "Movie";
    app.add_option("-o,--output", command.output,
                   "A film (.mp4, .webm), or numbered frames: FOLDER/frame_%04d.png or .exr")
        ->required()
        ->type_name("FILE")
        ->group(kGroup);
    add_number(app, "--orbit", command.orbit, {-36000, 36000},
               "Orbit around the volume's centre by this angle, starting at the scene's camera")
        ->type_name("DEGREES")
        ->group(kGroup);
    add_number(app, "--fps", command.fps, {0.01, 1000}, "Frames per second; default: the scene file's, otherwise 25")
        ->group(kGroup);
    add_number(app, "--seconds", command.seconds, {0.001, 1e6},
               "Duration, seconds; default: until the camera path and all animations end; 8 with --orbit")
        ->group(kGroup);
    app.add_option_function<std::string>(
           "--frames", [&command](const std::string& text) { command.range = parse_range(text); },
           "Render only these frames, both included; the movie's first frame is 0")
        ->type_name("FIRST:LAST")
        ->group(kGroup);
    app.add_flag("--keep-frames", command.keep_frames, "Keep the frames of a film, in FILE.frames")->group(kGroup);
    app.add_flag("--restart", command.restart, "Delete the frames of an earlier run and start again")->group(kGroup);
    app.add_flag("-q,--quiet", command.quiet, "Print only warnings and errors")->group(kGroup);
}

}  // namespace

void add_movie_command(CLI::App& app, int& exit_status) {
    CLI::App& sub = *app.add_subcommand("movie", "Render a movie: a camera path around or through a volume");
    const auto command = std::make_shared<MovieCommand>();
    sub.add_option("VOLUME", command->sources,
                   "A volume file, a folder or pattern of slices, builtin:NAME, or a scene file (.toml) whose table "
                   "[movie] describes the camera path and the animations. More than one: as for `edgesplat render`")
        ->required()
        ->type_name("");
    add_movie_options(sub, *command);
    add_document_options(sub, command->edits, command->volume);
    add_device_options(sub, command->device);
    sub.footer(
        "Each frame is written to FILE.frames beside the film. After a stop or a kill, the same command continues\n"
        "with the missing frames. Frames of different scenes are never mixed.\n\n"
        "Examples:\n"
        "  edgesplat movie builtin:phantom --orbit 360 --seconds 6 -o phantom.mp4\n"
        "  edgesplat movie nose.toml -o nose.webm --size 640x480\n"
        "  edgesplat movie nose.toml -o frames/frame_%04d.exr --frames 0:49");
    sub.callback([command, &exit_status] { run(*command, exit_status); });
}
