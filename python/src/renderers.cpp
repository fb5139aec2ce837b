// Renderers. They release the interpreter's lock while they draw, and Ctrl-C stops them.
#include <atomic>
#include <mutex>

#include "apps/edgesplat/explain_option.h"
#include "apps/edgesplat/film.h"
#include "apps/edgesplat/max_error_option.h"
#include "apps/edgesplat/renderer_option.h"
#include "engine/accuracy/analytic_truth.h"
#include "engine/accuracy/measure.h"
#include "engine/accuracy/report_files.h"
#include "engine/accuracy/report_json.h"
#include "engine/error.h"
#include "engine/overlays/overlays.h"
#include "engine/volume/packed_volume.h"
#include "python/src/pictures.h"
#include "python/src/signals.h"

namespace edgesplat::python {
namespace {

/// The scene with the given volume, checked before anything is drawn.
SceneDocument checked(const Document& document, const SharedVolume& volume) {
    SceneDocument scene = document.scene;
    const VolumeSource asked = scene.volume;
    VolumeSource reading = reading_part(asked), none;
    reading.path = none.path = volume.source.path;
    reading.segmentation = none.segmentation = volume.source.segmentation;
    reading.label_names = none.label_names = volume.source.label_names;
    if (reading != none && reading != volume.source)
        fail(
            "volume: {} is already read; expected component, frame, level, series, raw, no_data and spacing as "
            "arguments of "
            "Volume",
            volume.source.path);
    scene.volume = volume.source;
    scene.volume.threshold = asked.threshold;
    scene.volume.labels = volume.volume->is_label_mask() ? true : asked.labels;
    scene.volume.only = asked.only;
    scene.volume.hide = asked.hide;
    if (!asked.label_names.empty()) scene.volume.label_names = asked.label_names;
    scene.volume.box_filter = asked.box_filter;
    scene.volume.crop_low = asked.crop_low;
    scene.volume.crop_high = asked.crop_high;
    scene.volume.transform = asked.transform;
    scene.volume.visible = asked.visible;
    scene.volume.opacity = asked.opacity;
    scene.volume.clip = asked.clip;
    check_cpu_request(scene);
    validate(scene.quality.settings);
    std::string text;
    for (const DocumentProblem& problem : problems_of(scene, document.folders))
        if (!problem.path.ends_with("volume.path"))  // an array has no file, and the others are read
            text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", problem.path, problem.text);
    if (!text.empty()) fail("{}", text);
    return scene;
}

/// A renderer that several threads share; they draw one after another.
class SharedRenderer {
  public:
    SharedRenderer(const DeviceChoice& choice, double budget_mib)
        : renderer_(without_lock([&] { return std::make_unique<Renderer>(choice); })) {
        renderer_->set_memory_budget(ExplainOption{false, budget_mib}.budget_bytes());
    }

    /// Calls `work` with exclusive use of the renderer and without the interpreter's lock. Throws Error if it is
    /// closed.
    template <typename Work>
    auto use(Work work) {
        return without_lock([&] {
            Signals signals;
            std::unique_lock lock(mutex_, std::defer_lock);
            while (!lock.try_lock_for(std::chrono::milliseconds(50)))
                if (signals.request_stop()) throw Interrupted();
            if (!renderer_) fail("the renderer is closed");
            const Drawing drawing(*this, signals);
            return work(*renderer_);
        });
    }

    /// Within `use`: sets the volume of the following pictures. A volume is immutable, so one that is set already keeps
    /// its upload and its edges.
    void show(std::shared_ptr<const Volume> volume) {
        if (volume == shown_) return;
        shown_.reset();
        renderer_->set_volume(volume);
        shown_ = std::move(volume);
    }

    void interrupt() {
        if (drawing_) stop_ = true;
    }
    void close() {
        without_lock([&] {
            const std::lock_guard lock(mutex_);
            shown_.reset();
            renderer_.reset();
        });
    }
    /// For work that polls the interruption itself.
    std::function<bool()> interruption() const { return interruption_; }

  private:
    /// While this object exists, the renderer can be interrupted.
    struct Drawing {
        Drawing(SharedRenderer& shared, Signals& signals) : owner(shared) {
            owner.stop_ = false;
            owner.drawing_ = true;
            owner.interruption_ = [&shared, &signals] { return shared.stop_ || signals.request_stop(); };
            owner.renderer_->set_interruption(owner.interruption_);
        }
        ~Drawing() {
            owner.drawing_ = false;
            owner.interruption_ = {};
            owner.renderer_->set_interruption({});
            owner.renderer_->set_progress({});
        }
        Drawing(const Drawing&) = delete;
        Drawing& operator=(const Drawing&) = delete;
        SharedRenderer& owner;
    };

    std::timed_mutex mutex_;
    std::unique_ptr<Renderer> renderer_;
    std::shared_ptr<const Volume> shown_;
    std::function<bool()> interruption_;
    std::atomic<bool> drawing_ = false, stop_ = false;
};

std::string device_text(const DeviceInfo& device) {
    return fmt::format("{}, {} {}", device.name, device.driver, device.driver_version);
}

void draw_on_processor(Picture& picture, std::function<bool()> interruption) {
    const OutputChoice& output = picture.document.output;
    CpuFrames done = render_on_processor({output, picture.document.quality.settings, true, std::move(interruption)},
                                         *picture.volume.volume, picture.scene, picture.camera);
    picture.frames = std::move(done.frames);
    picture.measurements = std::move(done.measurements);
    picture.device = "the processor";
    if (picture.scene.effects.overlays.any())
        for (RenderedFrame& frame : picture.frames)
            draw_overlays(frame.result.color, *picture.volume.volume, picture.scene, picture.camera);
}

void draw_on_device(Picture& picture, SharedRenderer& self, Renderer& renderer) {
    const OutputChoice& output = picture.document.output;
    Settings settings = picture.document.quality.settings;
    self.show(picture.volume.volume);
    picture.choice = apply_max_error(picture.document.quality.max_error, renderer, *picture.volume.volume,
                                     picture.scene, picture.camera, output.size, settings, true);
    if (output.compare_raycast)
        fail("output.compare_raycast: true: expected false; draw a second picture with output.renderer \"raycast\"");
    if (output.compare_plain) {
        picture.frames.push_back({"plain", settings, {}});
        picture.frames.back().settings.edges = EdgeEstimator::Off;
    }
    picture.frames.push_back({settings.edges != EdgeEstimator::Off ? "edges" : "plain", settings, {}});
    for (RenderedFrame& frame : picture.frames)
        frame.result = output.renderer == edgesplat::RendererKind::Raycast
                           ? renderer.raycast(picture.scene, picture.camera, frame.settings, raycast_settings(output),
                                              output.size.x, output.size.y)
                           : renderer.render(picture.scene, picture.camera, frame.settings, output.size.x,
                                             output.size.y, aov_request(output.aovs));
    picture.device = device_text(renderer.device());
}

/// `progress`: called with the share of the surfaces found while the picture waits for them; None: not.
Picture draw(SharedRenderer& self, const Document& document, const SharedVolume& volume, const py::object& progress) {
    Picture picture;
    picture.document = checked(document, volume);
    picture.volume = volume;
    self.use([&](Renderer& renderer) {
        const OutputChoice& output = picture.document.output;
        if (output.renderer != RendererKind::Splat)
            require_samples(*volume.volume, fmt::format("output.renderer {}", name_of(output.renderer)));
        if (picture.document.quality.max_error) require_samples(*volume.volume, "quality.max_error");
        picture.scene = resolve_scene(picture.document, *volume.volume);
        picture.camera = resolve_camera(picture.document, *volume.volume, picture.scene);
        if (on_processor(output.renderer)) return draw_on_processor(picture, self.interruption());
        if (!progress.is_none())
            renderer.set_progress([&](double share) {
                const py::gil_scoped_acquire held;
                progress(share);
            });
        draw_on_device(picture, self, renderer);
    });
    return picture;
}

/// A movie; each frame is drawn on request.
struct Movie {
    Film film;
    SharedVolume volume;
    std::optional<accuracy::ChosenSettings> choice;
};

Movie movie(SharedRenderer& self, const Document& document, const SharedVolume& volume, std::optional<double> seconds) {
    const SceneDocument scene = checked(document, volume);
    Movie made{{}, volume, {}};
    self.use([&](Renderer& renderer) {
        check_film(scene);
        made.film = film_of(scene, document.folders, volume.volume, seconds);
        const double start = made.film.time_of(0);
        self.show(volume.volume);
        made.choice = apply_max_error(scene.quality.max_error, renderer, *volume.volume, scene_at(made.film, start),
                                      camera_at(made.film.path, start), scene.output.size, made.film.settings, true);
    });
    return made;
}

Picture frame_of(SharedRenderer& self, const Movie& movie, int frame) {
    Film film = movie.film;
    const double time = film.time_of(frame);
    Picture picture;
    picture.document = film.document;
    picture.volume = movie.volume;
    picture.choice = movie.choice;
    self.use([&](Renderer& renderer) {
        picture.camera = camera_at(film.path, time);
        self.show(film.volume);
        picture.frames.push_back({film.settings.edges != EdgeEstimator::Off ? "edges" : "plain", film.settings,
                                  draw_frame(film, renderer, frame)});
        picture.volume.volume = film.volume;  // another one if volume.frame is animated
        picture.scene = scene_at(film, time);
        picture.device = device_text(renderer.device());
    });
    return picture;
}

/// Writes the report of `edgesplat accuracy` to `options.folder` and returns the text of its report.json.
std::string measure_steps(SharedRenderer& self, const Document& document, const SharedVolume& volume,
                          accuracy::ReportOptions options) {
    const SceneDocument scene = checked(document, volume);
    options.base = scene.quality.settings;
    return self.use([&](Renderer& renderer) {
        require_samples(*volume.volume, "accuracy");
        accuracy::check_report_folder(options.folder);
        accuracy::ReportInput input;
        input.volume = volume.volume;
        input.scene = resolve_scene(scene, *volume.volume);
        input.analytic = accuracy::analytic_scene_of(scene.volume);
        input.program = "edgesplat " EDGESPLAT_VERSION;
        input.command = "edgesplat.accuracy";
        self.show(volume.volume);
        try {
            const auto progress = [stop = self.interruption()](const accuracy::Progress&) { return !stop(); };
            const accuracy::Measured measured = measure_accuracy(renderer, input, options, progress);
            write_report(measured);
            return report_json(measured.report).dump();
        } catch (const accuracy::Interrupted&) {
            throw Interrupted();
        }
    });
}

py::dict as_dict(const DeviceInfo& device) {
    using namespace py::literals;
    return py::dict("index"_a = device.index, "name"_a = device.name, "type"_a = device.type,
                    "driver"_a = device.driver, "driver_version"_a = device.driver_version,
                    "api_version"_a = device.api_version, "rejections"_a = py::tuple(py::cast(device.rejections)));
}

}  // namespace

void add_renderers(py::module_& module) {
    py::class_<Movie>(module, "Movie")
        .def_property_readonly("count", [](const Movie& self) { return self.film.count; })
        .def_property_readonly("fps", [](const Movie& self) { return self.film.fps; });
    py::class_<SharedRenderer>(module, "Renderer")
        .def(py::init(
            [](const std::string& device, double budget_mib, bool validation, bool check_numbers, bool keep_splats) {
                return std::make_unique<SharedRenderer>(DeviceChoice{.device = device,
                                                                     .validation = validation,
                                                                     .check_numbers = check_numbers,
                                                                     .keep_splats = keep_splats,
                                                                     .profile = {}},
                                                        budget_mib);
            }))
        .def("device",
             [](SharedRenderer& self) {
                 return as_dict(self.use([](Renderer& renderer) { return renderer.device(); }));
             })
        .def("held_bytes",
             [](SharedRenderer& self) { return self.use([](Renderer& renderer) { return renderer.held_bytes(); }); })
        .def("validation_messages",
             [](SharedRenderer& self) {
                 return self.use([](Renderer& renderer) { return renderer.validation_messages(); });
             })
        .def("draw", draw)
        .def("movie", movie)
        .def("frame_of", frame_of)
        .def("accuracy",
             [](SharedRenderer& self, const Document& document, const SharedVolume& volume, const std::string& folder,
                const std::array<int, 2>& size, double tolerance, int repeats, int orbit,
                const std::vector<std::string>& knobs, const std::vector<std::string>& cameras) {
                 accuracy::ReportOptions options;
                 options.folder = folder;
                 options.size = {size[0], size[1]};
                 options.tolerance = tolerance;
                 options.repeats = repeats;
                 options.orbit_frames = orbit;
                 options.knobs = knobs;
                 options.cameras = cameras;
                 return measure_steps(self, document, volume, std::move(options));
             })
        .def("interrupt", &SharedRenderer::interrupt)
        .def("close", &SharedRenderer::close);
    module.def("list_devices", [] {
        std::vector<py::dict> devices;
        for (const DeviceInfo& device : list_devices())
            devices.push_back(as_dict(device));
        return devices;
    });
}

}  // namespace edgesplat::python
