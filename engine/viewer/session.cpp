#include "engine/viewer/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "engine/error.h"
#include "engine/scene/ladder.h"
#include "engine/scene/views.h"
#include "engine/volume/grid.h"

namespace edgesplat::viewer {
namespace {

// Seconds without change after which the picture is refined.
constexpr double kQuiet = 0.15;

/// A double click brings the eye so near that a voxel has this height in pixels.
constexpr double kPixelsPerVoxel = 12;

constexpr double kFlightSeconds = 0.8;

bool same(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.direction == b.direction && a.up == b.up && a.fov_y == b.fov_y;
}

SceneDocument with_quality_of(const SceneDocument& other, SceneDocument document) {
    document.quality = other.quality;
    return document;
}

/// Whether both scenes have the same solid matter before clipping.
bool same_matter(const Scene& a, const Scene& b) {
    return a.iso_values == b.iso_values && a.materials == b.materials && a.transfer == b.transfer &&
           a.label_colors == b.label_colors && a.added == b.added;
}

}  // namespace

void Session::open(Opened opened, const glm::ivec2& size) {
    SceneDocument document = opened.document;
    document.output.size = size;
    const Scene scene = resolve_scene(document, *opened.volume);
    const Camera camera = resolve_camera(document, *opened.volume, scene);
    const SceneDocument open = document;
    document = resolved(document, *opened.volume, scene, camera, document.quality.settings);
    // Boxes stay boxes, so that they can be dragged.
    document.effects.clip = open.effects.clip;
    document.keep_box = open.keep_box;
    document.remove_box = open.remove_box;
    document.movie = open.movie;
    Scene shown = resolve_scene(document, *opened.volume);
    opened_ = std::move(opened);
    drawn_ = document;
    history_.emplace(std::move(document));
    motion_ = Motion();
    motion_.set_home(camera, opened_.volume->geometry.center());
    motion_.jump(camera);
    motion_.set_center(opened_.volume->geometry.center());
    tour_.clear();
    recorder_ = {};
    clear_picks();
    walls_.reset();
    message_.clear();
    apply(std::move(shown));
    const glm::dvec3 index = opened_.volume->geometry.to_index(camera.eye);
    const bool inside = glm::all(glm::greaterThan(index, glm::dvec3(0))) &&
                        glm::all(glm::lessThan(index, glm::dvec3(opened_.volume->geometry.dims - 1)));
    motion_.set_mode(inside ? MotionMode::Fly : MotionMode::Orbit);
}

std::shared_ptr<const Volume> Session::relabelled(SceneDocument& document) const {
    VolumeSource& wanted = document.volume;
    const VolumeSource& now = drawn_.volume;
    const bool same = wanted.labels.value_or(false) == now.labels.value_or(false) && wanted.only == now.only &&
                      wanted.hide == now.hide;
    if (!opened_.samples) return nullptr;
    // Cuts through a scan depend on its iso-values.
    const bool of_scan = opened_.samples->has_segmentation();
    const bool cut_alike = !of_scan || !chooses_labels(wanted) || document.iso_values == drawn_.iso_values;
    if (same && cut_alike) return nullptr;
    wanted.checksum.clear();
    auto volume = std::make_shared<const Volume>(of_scan ? prepared_volume(document, *opened_.samples)
                                                         : preprocessed(*opened_.samples, wanted));
    wanted.checksum = fmt::format("{:016x}", volume->checksum);
    return volume;
}

void Session::follow_document() {
    SceneDocument document = history_->now();
    if (auto whole = relabelled(document)) {
        opened_.whole = std::move(whole);
        drawn_ = document;
    }
    opened_.volume = opened_.cuts.apply(document, opened_.whole);
    history_->amend(std::move(document));
    forget_cuts();
    apply(current_scene());
}

void Session::forget_cuts() {
    history_->for_others([](SceneDocument& document) {
        document.whole = {};
        for (SceneDocument& entry : document.volumes)
            entry.cut = {};
    });
}

Scene Session::current_scene() const {
    return resolve_scene(document(), *opened_.volume);
}

void Session::apply(Scene scene, bool seen) {
    scene_ = std::move(scene);
    ++scene_number_;
    changed_ = true;
    if (!seen) return;
    ++view_number_;
    quiet_ = 0;
    walls_outdated_ = true;
}

void Session::edit(const std::function<void(SceneDocument&)>& change, bool finished) {
    SceneDocument document = history_->now();
    Scene scene;
    std::shared_ptr<const Volume> whole, volume;
    try {
        change(document);
        validate(document.quality.settings);
        whole = relabelled(document);
        read_volumes(document, opened_.folders, {}, opened_.samples.get());
        volume = opened_.cuts.apply(document, whole ? whole : opened_.whole);
        scene = resolve_scene(document, *volume);
    } catch (const Error& error) {
        message_ = error.what();
        return;
    }
    const SceneDocument& now = history_->now();
    const bool same = document == now, seen = !same && !(with_quality_of(now, document) == now);
    opened_.volume = std::move(volume);
    if (whole) {
        opened_.whole = std::move(whole);
        drawn_ = document;
    }
    history_->change(std::move(document), finished);
    forget_cuts();
    if (!same) apply(std::move(scene), seen);
}

void Session::finish_edit() {
    if (is_open() && history_->has_pending_edit()) history_->change(SceneDocument(history_->now()), true);
}

void Session::undo() {
    if (!can_undo()) return;
    history_->undo();
    follow_document();
}

void Session::redo() {
    if (!can_redo()) return;
    history_->redo();
    follow_document();
}

void Session::set_show(Show show) {
    if (show == show_) return;
    const auto plain = [](Show s) { return s != Show::Edges; };
    changed_ = changed_ || plain(show) != plain(show_);
    show_ = show;
}

void Session::set_wipe(double share) {
    if (std::isfinite(share)) wipe_ = std::clamp(share, 0.0, 1.0);
}

void Session::set_best_when_still(bool on) {
    changed_ = changed_ || on != best_;
    best_ = on;
}

void Session::find_walls() {
    if (!walls_outdated_ || pending_walls_.valid()) return;
    if (walls_ && same_matter(walls_scene_, scene_)) {
        walls_outdated_ = false;
        walls_ = std::make_shared<const Walls>(*walls_, scene_.effects.clip);
        motion_.set_walls(walls_);
        return;
    }
    if (quiet_ < kQuiet) return;
    walls_outdated_ = false;
    walls_scene_ = scene_;
    walls_volume_ = opened_.volume;
    pending_walls_ = std::async(std::launch::async, [volume = opened_.volume, scene = scene_] {
        return std::make_shared<const Walls>(volume, scene);
    });
}

void Session::poll() {
    find_walls();
    if (pending_walls_.valid() &&
        (wait_ || pending_walls_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)) {
        try {
            auto found = pending_walls_.get();
            if (walls_volume_ == opened_.volume) {  // not the walls of the previous volume
                walls_ = std::move(found);
                motion_.set_walls(walls_);
            }
        } catch (const Error& error) {
            walls_.reset();
            message_ = error.what();
        }
        walls_volume_.reset();
    }
    if (!tour_.poll(wait_)) return;
    message_ = tour_.failed() ? "guided path: the two points are not connected; choose both in the same cavity"
                              : fmt::format("guided path: {:.1f} mm", tour_.line()->length);
    if (tour_.line()) motion_.jump(tour_.camera(motion_.camera().up));
    changed_ = true;
}

void Session::step(const Controls& controls, double seconds) {
    if (!is_open()) return;
    const Camera before = motion_.camera();
    if (tour_.playing) {
        tour_.look += controls.look;
        tour_.step(seconds);
        motion_.jump(tour_.camera(before.up));
    } else {
        motion_.step(controls, seconds);
    }
    const bool moved = !same(before, motion_.camera());
    quiet_ = moved ? 0 : quiet_ + seconds;
    changed_ = changed_ || moved;
    recorder_.step(motion_.camera(), seconds);
    poll();
}

bool Session::pick_at(const glm::dvec2& pixel, const glm::ivec2& size) {
    const auto found = pick(volume(), scene_, motion_.camera(), size, pixel);
    if (!found) return false;
    picks_.push_back(*found);
    point_ = found->world;
    return true;
}

void Session::clear_picks() {
    picks_.clear();
    point_.reset();
}

bool Session::fly_to(const glm::dvec2& pixel, const glm::ivec2& size) {
    const auto found = pick(volume(), scene_, motion_.camera(), size, pixel);
    if (!found) return false;
    Camera there = motion_.camera();
    const glm::dvec3 towards = glm::normalize(found->world - there.eye);
    const double voxel = shortest_spacing(volume().geometry);
    const double near = voxel * size.y / (2 * std::tan(glm::radians(there.fov_y) / 2) * kPixelsPerVoxel);
    // A nearer eye moves half the distance, so that it never enters the wall.
    const double distance = std::min(near, found->distance / 2);
    there.eye = found->world - distance * towards;
    there.direction = towards;
    motion_.fly_to(there, found->world, kFlightSeconds);
    return true;
}

std::optional<Ruler> Session::ruler() const {
    if (picks_.size() < 2) return std::nullopt;
    const Pick &a = picks_[picks_.size() - 2], &b = picks_.back();
    return Ruler{glm::length(a.world - b.world), std::hypot(a.uncertainty, b.uncertainty)};
}

bool Session::moving() const {
    return is_open() && (motion_.moving() || tour_.playing || quiet_ < kQuiet);
}

std::optional<DrawRequest> Session::next_request(const glm::ivec2& size) {
    if (!is_open() || size.x < 1 || size.y < 1) return std::nullopt;
    const bool now_moving = moving();
    if (size != asked_size_) {
        quiet_ = 0;
        ++view_number_;
        changed_ = true;
    }
    if (!changed_ && asked_moving_ == now_moving) return std::nullopt;
    changed_ = false;
    asked_moving_ = now_moving;
    asked_size_ = size;
    DrawRequest request;
    request.volume = opened_.volume;
    request.scene = scene_;
    request.settings = document().quality.settings;
    request.scene_number = scene_number_;
    request.camera = motion_.camera();
    request.size = size;
    request.plain = show_ != Show::Edges;
    request.moving = now_moving;
    request.same_view =
        !now_moving && asked_view_ && asked_view_->number == view_number_ && same(asked_view_->camera, request.camera);
    asked_view_.reset();
    if (!now_moving) asked_view_ = {view_number_, request.camera};
    if (best_) request.best = preset_named("accurate").settings;
    return request;
}

SceneDocument Session::document_to_save(const glm::ivec2& size) const {
    const SceneDocument& now = document();
    SceneDocument out = now;
    const Camera& camera = motion_.camera();
    out.camera = {{}, camera.eye, {}, camera.direction, camera.up, false, camera.fov_y};
    out.output.size = size;
    return out;
}

}  // namespace edgesplat::viewer
