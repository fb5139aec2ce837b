#include "engine/accuracy/measure.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/accuracy/identity.h"
#include "engine/accuracy/model_references.h"
#include "engine/accuracy/report_json.h"
#include "engine/reference/pixel_rows.h"
#include "engine/scene/ladder.h"

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

/// The camera, turned around the volume's middle by an angle about its own up.
Camera orbited(const Camera& camera, const VolumeGeometry& geometry, double degrees) {
    const glm::dvec3 center = geometry.center();
    const glm::dvec3 axis = camera_frame(camera).up;
    const double angle = glm::radians(degrees);
    const auto turned = [&](const glm::dvec3& v) {
        return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
               axis * glm::dot(axis, v) * (1 - std::cos(angle));
    };
    return {center + turned(camera.eye - center), turned(camera.direction), camera.up, camera.fov_y};
}

class Measurement {
  public:
    Measurement(Renderer& renderer, const ReportInput& input, const ReportOptions& options, Journal& journal,
                const ProgressFunction& progress)
        : renderer_(renderer),
          input_(input),
          options_(options),
          journal_(journal),
          work_(journal, progress),
          references_(input, options.tolerance, options.folder / "cache", journal,
                      [this](double share) { return work_.should_continue(share); }),
          trilinear_{.settings = options.base, .rays = RaycastFilter::Trilinear} {
        report_.input = input;
        report_.options = options;
        report_.device = renderer.device();
        report_.cameras = report_cameras(*input.volume, input.scene, options.size.x, options.size.y);
        far_ = report_.cameras.front().camera;
        report_.rows = configurations(options.base, options.knobs);
        choose_cameras();
        collect_settings();
        if (input.analytic && input.analytic->signed_distance && !input.analytic->iso_values.empty() &&
            input.scene.iso_values == input.analytic->iso_values)
            report_.surface = surface_points(*input.analytic, options.surface_points);
    }

    Measured run() {
        add_errors();
        add_memory();
        add_orbit();
        add_times();
        try {
            work_.run();
        } catch (const reference::Cancelled&) {
            work_.stop();
        }
        assemble();
        return {report_, pictures()};
    }

  private:
    void choose_cameras() {
        if (options_.cameras.empty()) return;
        for (const std::string& name : options_.cameras)
            if (std::none_of(report_.cameras.begin(), report_.cameras.end(),
                             [&](const ReportCamera& c) { return c.name == name; }))
                fail("this volume has no camera '{}'", name);
        std::erase_if(report_.cameras, [&](const ReportCamera& c) {
            return std::find(options_.cameras.begin(), options_.cameras.end(), c.name) == options_.cameras.end();
        });
    }

    void collect_settings() {
        std::map<std::string, std::size_t> known;
        for (const Configuration& row : report_.rows) {
            const std::string key = picture_key(row);
            const auto [at, fresh] = known.emplace(key, report_.results.size());
            if (fresh) {
                report_.results.push_back({.settings = canonical(row.settings), .rays = row.rays});
                keys_.push_back(key);
            }
            report_.result_of_row.push_back(at->second);
        }
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            const std::string model = model_key(report_.results[i].settings);
            if (std::find(models_.begin(), models_.end(), model) == models_.end()) models_.push_back(model);
        }
    }

    RenderResult draw(Renderer& renderer, const SettingsResult& result, const Camera& camera) const {
        const glm::ivec2 size = options_.size;
        if (result.rays)
            return renderer.raycast(input_.scene, camera, result.settings, {.filter = *result.rays}, size.x, size.y);
        return renderer.render(input_.scene, camera, result.settings, size.x, size.y);
    }

    std::string error_key(std::size_t i, const ReportCamera& camera) const {
        return "error|" + camera.name + "|" + keys_[i];
    }
    std::string memory_key(std::size_t i) const { return "memory|" + keys_[i]; }
    std::string edges_key(const std::string& model) const { return "edges|" + model; }
    std::string time_key(std::size_t i, int round) const { return fmt::format("time|{}|{}", round, keys_[i]); }
    std::string orbit_key(std::size_t i) const { return "orbit|" + keys_[i]; }

    /// Grouped by model, so that each model is prepared once.
    void add_errors() {
        const double pixels = static_cast<double>(options_.size.x) * options_.size.y;
        const double voxels = static_cast<double>(input_.volume->geometry.voxel_count());
        for (const ReportCamera& camera : report_.cameras)
            work_.add({"truth", references_.truth_key(camera.name), "truth, " + camera.name,
                       [this, &camera] { return references_.make_truth(camera.name, camera.camera, options_.size); }},
                      (input_.analytic ? 2e-5 : 2e-4) * pixels);
        for (const std::string& model : models_) {
            std::vector<std::size_t> of_model;
            for (std::size_t i = 0; i < keys_.size(); ++i)
                if (model_key(report_.results[i].settings) == model) of_model.push_back(i);
            const Settings settings = model_of(report_.results[of_model.front()].settings);
            for (const ReportCamera& camera : report_.cameras) {
                work_.add({"reference", references_.key(settings, camera.name), "reference, " + camera.name,
                           [this, &camera, settings] {
                               return references_.make(settings, camera.name, camera.camera, options_.size);
                           }},
                          2e-4 * pixels + 1e-5 * voxels);
                for (const std::size_t i : of_model)
                    work_.add({"error", error_key(i, camera), "errors, " + camera.name,
                               [this, i, &camera] { return measure_error(i, camera); }});
            }
            if (report_.surface)
                work_.add({"edges", edges_key(model), "edges", [this, settings] {
                               return to_json(edge_figures(references_.prepared(settings), report_.surface->points));
                           }});
        }
    }

    ordered_json measure_error(std::size_t i, const ReportCamera& camera) {
        const RenderResult result = draw(renderer_, report_.results[i], camera.camera);
        const ReferencePicture reference =
            references_.get(model_of(report_.results[i].settings), camera.name, camera.camera, options_.size);
        const ReferencePicture truth = references_.truth(camera.name, camera.camera, options_.size);
        return {{"truth", to_json(image_error(result.color, truth.image))},
                {"method", to_json(image_error(result.color, reference.image))},
                {"reference_error", std::max(reference.error_estimate, truth.error_estimate)},
                {"splats_drawn", result.stats.splats_drawn},
                {"sheets", result.stats.sheets}};
    }

    /// Each on a new renderer, since a renderer keeps what earlier pictures needed.
    void add_memory() {
        for (std::size_t i = 0; i < keys_.size(); ++i)
            work_.add({"memory", memory_key(i), "memory", [this, i] {
                           Renderer fresh({.device = std::to_string(renderer_.device().index)});
                           fresh.set_volume(input_.volume);
                           std::uint64_t bytes = 0;
                           for (const ReportCamera& camera : report_.cameras)
                               bytes = draw(fresh, report_.results[i], camera.camera).stats.device_bytes;
                           return ordered_json(bytes);
                       }});
    }

    /// Results whose popping is measured: whole and sliced sheets, and presets of the same model.
    std::vector<std::size_t> orbit_results() const {
        std::vector<std::size_t> list;
        for (std::size_t row = 0; row < report_.rows.size(); ++row) {
            const Configuration& c = report_.rows[row];
            const bool wanted =
                c.kind == ConfigurationKind::Base || c.kind == ConfigurationKind::Preset ||
                (c.kind == ConfigurationKind::Step && (c.knob == "sheets" || c.knob == "sheet-spacing"));
            const std::size_t i = report_.result_of_row[row];
            if (wanted && model_key(c.settings) == model_key(options_.base) &&
                std::find(list.begin(), list.end(), i) == list.end())
                list.push_back(i);
        }
        return list;
    }

    Camera orbit_camera(int frame) const { return orbited(far_, input_.volume->geometry, frame); }

    void add_orbit() {
        if (options_.orbit_frames < 1) return;
        const glm::ivec2 size(options_.orbit_size);
        const Settings model = model_of(options_.base);
        for (int frame = 0; frame <= options_.orbit_frames; ++frame) {
            const std::string name = fmt::format("orbit {}", frame);
            work_.add({"orbit reference", references_.key(model, name), "reference of an orbit",
                       [=, this] { return references_.make(model, name, orbit_camera(frame), size); }},
                      1e-4 * size.x * size.y);
        }
        for (const std::size_t i : orbit_results())
            work_.add(
                {"orbit", orbit_key(i), "popping",
                 [=, this] {
                     std::vector<Image> frames, expected;
                     for (int frame = 0; frame <= options_.orbit_frames; ++frame) {
                         const Camera camera = orbit_camera(frame);
                         frames.push_back(
                             renderer_.render(input_.scene, camera, report_.results[i].settings, size.x, size.y).color);
                         expected.push_back(references_.get(model, fmt::format("orbit {}", frame), camera, size).image);
                         work_.check(static_cast<double>(frame) / (options_.orbit_frames + 1));
                     }
                     return to_json(popping(frames, expected));
                 }},
                2);
    }

    /// Rounds over all configurations, grouped by model, since each change of the model repeats the estimation.
    void add_times() {
        for (int round = 0; round < options_.repeats; ++round) {
            for (const std::size_t m : order_of_round(models_.size(), round)) {
                std::vector<std::size_t> of_model;
                for (std::size_t i = 0; i < keys_.size(); ++i)
                    if (model_key(report_.results[i].settings) == models_[m]) of_model.push_back(i);
                for (const std::size_t k : order_of_round(of_model.size(), round)) {
                    const std::size_t i = of_model[k];
                    work_.add({"time", time_key(i, round),
                               fmt::format("times, round {} of {}", round + 1, options_.repeats), [this, i] {
                                   ordered_json visits = ordered_json::object();
                                   for (const ReportCamera& camera : report_.cameras) {
                                       visits[camera.name] = to_json(time_visit(
                                           [&] { return draw(renderer_, report_.results[i], camera.camera).stats; },
                                           [&] { return draw(renderer_, trilinear_, camera.camera).stats; }));
                                       work_.check();
                                   }
                                   return visits;
                               }});
                }
            }
        }
    }

    void assemble() {
        // The setup belongs to a model; a ray caster has its own.
        std::map<std::string, std::vector<double>> setups;
        const auto set_up = [&](std::size_t i) {
            return report_.results[i].rays ? keys_[i] : model_key(report_.results[i].settings);
        };
        std::vector<std::vector<double>> rays(report_.cameras.size());
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            SettingsResult& result = report_.results[i];
            const std::string model = model_key(result.settings);
            for (std::size_t c = 0; c < report_.cameras.size(); ++c) {
                const ReportCamera& camera = report_.cameras[c];
                const ordered_json& error = *journal_.find(error_key(i, camera));
                CameraResult of_camera;
                of_camera.truth = image_error_from(error.at("truth"));
                of_camera.method = image_error_from(error.at("method"));
                of_camera.reference_error = error.at("reference_error");
                of_camera.splats_drawn = error.at("splats_drawn");
                of_camera.sheets = error.at("sheets");
                std::vector<TimedVisit> visits;
                for (int round = 0; round < options_.repeats; ++round) {
                    visits.push_back(timed_visit_from(journal_.find(time_key(i, round))->at(camera.name)));
                    if (visits.back().setup_milliseconds > 0)
                        setups[set_up(i)].push_back(visits.back().setup_milliseconds);
                }
                of_camera.times = summarise(visits, ratio_clock(report_.device));
                rays[c].push_back(of_camera.times.ray_median);
                report_.largest_reference_error = std::max(report_.largest_reference_error, of_camera.reference_error);
                result.cameras.push_back(std::move(of_camera));
            }
            result.device_bytes = *journal_.find(memory_key(i));
            if (const ordered_json* edges = journal_.find(edges_key(model)); edges && !result.rays)
                result.edges = edge_figures_from(*edges);
            if (const ordered_json* orbit = journal_.find(orbit_key(i))) result.popping = popping_from(*orbit);
            combine_cameras(result);
        }
        for (std::size_t i = 0; i < keys_.size(); ++i)
            report_.results[i].setup_ms = quantile(setups[set_up(i)], 0.5);
        for (const auto& list : rays)
            report_.raycast_ms.push_back(quantile(list, 0.5));
        find_front();
        add_notes();
    }

    static void combine_cameras(SettingsResult& result) {
        std::vector<ImageError> truth, method;
        const double n = static_cast<double>(result.cameras.size());
        glm::dvec3 logs(0);
        double wall = 0;
        for (const CameraResult& c : result.cameras) {
            truth.push_back(c.truth);
            method.push_back(c.method);
            result.frame_ms += c.times.frame.median / n;
            const Spread& r = c.times.ratio;
            logs += glm::log(glm::dvec3(r.median, r.low, r.high)) / n;
            wall += std::log(c.times.wall_ratio.median) / n;
        }
        result.wall_ratio = std::exp(wall);
        result.ratio = {std::exp(logs.x), std::exp(logs.y), std::exp(logs.z)};
        result.truth = pooled(truth);
        result.method = pooled(method);
    }

    void find_front() {
        std::vector<CostAndError> points;
        for (const SettingsResult& result : report_.results)
            points.push_back({result.frame_ms, result.truth.rms});
        const auto& rows = report_.result_of_row;
        for (const std::size_t i : pareto_front(points))  // the first row of each result
            report_.front.push_back(static_cast<std::size_t>(std::find(rows.begin(), rows.end(), i) - rows.begin()));
    }

    void add_notes() {
        double smallest = 1;
        for (const SettingsResult& r : report_.results)
            for (const CameraResult& c : r.cameras)
                smallest = std::min({smallest, c.method.rms, c.truth.rms});
        report_.notes.push_back(fmt::format(
            "The references' own error is at most {:.1e} of full scale at any pixel. The smallest measured error "
            "(RMS of a camera) is {:.1e}, {:.0f} times as large.",
            report_.largest_reference_error, smallest, smallest / std::max(report_.largest_reference_error, 1e-300)));
        if (smallest < 10 * report_.largest_reference_error)
            report_.notes.push_back("That is less than 10 times as large: use a smaller --tolerance to measure it.");
        if (!input_.analytic)
            report_.notes.emplace_back(
                "The truth is not known. Instead pictures are compared with the exact surfaces of the cubic B-spline "
                "through the samples. Cubic rays show the same surfaces, with steps.");
        for (const std::string_view name : {"near", "grazing", "inside"})
            if (options_.cameras.empty() && std::none_of(report_.cameras.begin(), report_.cameras.end(),
                                                         [&](const ReportCamera& c) { return c.name == name; }))
                report_.notes.push_back(fmt::format("There is no camera `{}`: this volume has no place for it.", name));
        if (report_.surface)
            report_.notes.push_back(fmt::format(
                "Edges are measured at {} points of the surface. {} more were left out near the grid's border, {} "
                "because of a corner or another surface within {} voxels.",
                report_.surface->points.size(), report_.surface->near_border, report_.surface->disturbed,
                report_.surface->room));
        else
            report_.notes.push_back("Rise and location of edges are not measured: the true surface is not known.");
    }

    std::vector<ReportPictures> pictures() {
        Settings plain = options_.base;
        plain.edges = EdgeEstimator::Off;
        const SettingsResult cubic{.settings = options_.base, .rays = RaycastFilter::Cubic};
        std::vector<ReportPictures> list;
        for (const ReportCamera& camera : report_.cameras) {
            const auto shown = [&](const SettingsResult& result) {
                return draw(renderer_, result, camera.camera).color;
            };
            list.push_back({shown({.settings = plain}), shown({.settings = options_.base}),
                            shown({.settings = presets().back().settings}),
                            references_.get(model_of(options_.base), camera.name, camera.camera, options_.size).image,
                            shown(trilinear_), shown(cubic),
                            references_.truth(camera.name, camera.camera, options_.size).image});
        }
        return list;
    }

    Renderer& renderer_;
    ReportInput input_;
    ReportOptions options_;
    Journal& journal_;
    WorkList work_;
    ModelReferences references_;
    Report report_;
    SettingsResult trilinear_;  ///< the ray caster that times are divided by
    Camera far_;
    std::vector<std::string> keys_;    ///< picture_key of each result
    std::vector<std::string> models_;  ///< model_key of each model, in order of appearance
};

}  // namespace

Measured measure_accuracy(Renderer& renderer, const ReportInput& input, const ReportOptions& options,
                          const ProgressFunction& progress) {
    std::error_code error;
    std::filesystem::create_directories(options.folder / "cache", error);
    if (error) fail("cannot create the folder {}: {}", options.folder.string(), error.message());
    Journal journal(options.folder / "journal.jsonl", identity_of(input, options, renderer.device()), options.restart);
    return Measurement(renderer, input, options, journal, progress).run();
}

}  // namespace edgesplat::accuracy
