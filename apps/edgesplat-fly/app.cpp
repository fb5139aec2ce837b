#include "apps/edgesplat-fly/app.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>

#include "apps/edgesplat-fly/gui_input.h"
#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/picture_view.h"
#include "engine/error.h"
#include "engine/image/image_file.h"
#include "engine/overlays/font.h"
#include "engine/viewer/keeping.h"

namespace {

namespace fs = std::filesystem;
namespace viewer = edgesplat::viewer;

constexpr const char* kBuiltin = "builtin:cube-hole";
constexpr const char* kProgram = "edgesplat-fly " EDGESPLAT_VERSION;
constexpr double kTargetSoftware = 150, kTarget = 33;
constexpr double kSlicesShare = 0.34, kSlicesMost = 24;  // of the width beside the panels; em
constexpr double kTextSize = 15;                         // pixels, on a screen of normal density
// Seconds to wait for events: while something moves, while something is computed, otherwise.
constexpr double kWaitMoving = 0.004, kWaitBusy = 0.03, kWaitIdle = 0.5;

bool usable(const std::vector<edgesplat::DeviceInfo>& devices, const std::string& name) {
    return std::ranges::any_of(
        devices, [&](const edgesplat::DeviceInfo& device) { return device.name == name && device.rejections.empty(); });
}

}  // namespace

App::App(const AppOptions& options) : options_(options), state_(!options.script.empty()) {
    if (options_.remember) state_.preferences = viewer::read_preferences(viewer::preferences_path());
    const auto& remembered = state_.preferences;
    size_ = options_.size.x > 0 ? options_.size : glm::ivec2(remembered.width, remembered.height);
    state_.device = options_.device;
    state_.devices = edgesplat::list_devices();
    // The device of the last run may no longer exist.
    if (state_.device.device.empty() && usable(state_.devices, remembered.device))
        state_.device.device = remembered.device;
    if (!options_.script.empty()) {
        auto commands = viewer::read_script(options_.script, &is_key);
        player_ = std::make_unique<ScriptPlayer>(std::move(commands), script_host(), size_);
    }
    if (!options_.record.empty()) {
        edgesplat::check_output_path(options_.record);
        recorder_ = std::make_unique<ScriptRecorder>(1.0 / 60);
    }
    if (!options_.headless) window_ = std::make_unique<Window>(size_, "Edgesplat");
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    prepare_gui_input();
    if (window_) Window::install_clipboard(window_->handle());
    load_font();
    open_gui();
    const bool software = device_->info().is_processor;
    state_.target = options_.target > 0     ? options_.target
                    : remembered.target > 0 ? remembered.target
                    : software              ? kTargetSoftware
                                            : kTarget;
    make_drawer();
    begin_loading(options_.source.empty() ? kBuiltin : options_.source);
}

App::~App() {
    state_.drawer.reset();
    finish_writing(true);
    close_gui();
    if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
}

void App::load_font() {
    const double wanted = state_.preferences.text_scale;
    const double scale = wanted > 0 ? wanted : window_ ? window_->content_scale() : 1;
    state_.em = std::round(kTextSize * scale);
    ImGuiIO& io = ImGui::GetIO();
    static const ImWchar ranges[] = {0x20, 0xFF, 0};
    if (const auto file = edgesplat::font_file())
        io.Fonts->AddFontFromFileTTF(file->c_str(), static_cast<float>(state_.em), nullptr, ranges);
    if (io.Fonts->Fonts.empty()) {
        io.Fonts->AddFontDefault();
        io.FontGlobalScale = static_cast<float>(scale);
    }
    ImGui::GetStyle().ScaleAllSizes(static_cast<float>(scale));
}

void App::open_gui() {
    edgesplat::gpu::DeviceExtensions extensions;
    if (window_) {
        extensions.instance = Window::instance_extensions();
        extensions.device = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    }
    const auto open = [&](const edgesplat::DeviceChoice& choice) {
        device_ = std::make_unique<edgesplat::gpu::Device>(choice, extensions);
        if (window_) surface_ = std::make_unique<Surface>(*device_, window_->handle());
    };
    // A device that can draw pictures may be unable to draw to the screen.
    std::string reasons;
    std::vector<std::string> candidates{state_.device.device};
    for (const edgesplat::DeviceInfo& device : state_.devices)
        if (window_ && device.rejections.empty()) candidates.push_back(std::to_string(device.index));
    for (const std::string& candidate : candidates) {
        try {
            open({.device = candidate, .validation = state_.device.validation});
            // cppcheck-suppress nullPointer; open() has made it, or thrown
            canvas_ = std::make_unique<Canvas>(*device_);
            return;
        } catch (const edgesplat::Error& error) {
            surface_.reset();
            device_.reset();
            if (reasons.empty()) reasons = error.what();
        }
    }
    edgesplat::fail("{}", reasons);
}

void App::close_gui() {
    // Objects on the device are destroyed before it.
    surface_.reset();
    canvas_.reset();
    for (CanvasPicture* picture : {&state_.edges, &state_.plain, &state_.sharpening})
        *picture = {};
    state_.slice_pictures = {};
    state_.pictures.clear();
    if (device_) messages_ += device_->validation_messages();
    device_.reset();
}

void App::make_drawer() {
    if (state_.drawer) messages_ += state_.drawer->validation_messages();
    state_.drawer.reset();
    state_.drawer = std::make_unique<viewer::Drawer>(viewer::Drawer::Options{.device = state_.device,
                                                                             .memory_budget = options_.memory_budget,
                                                                             .target = state_.target,
                                                                             .rays = state_.rays,
                                                                             .threaded = player_ == nullptr});
}

void App::begin_loading(const std::string& path) {
    state_.loading = std::make_unique<viewer::Loading>(path);
}

void App::finish_loading() {
    if (!state_.loading || (!player_ && !state_.loading->ready())) return;
    const auto loading = std::move(state_.loading);
    try {
        const glm::ivec2 size = state_.picture_size();
        viewer::Opened opened = loading->take();
        // From the top its hole is visible.
        if (options_.source.empty() && opened.path == kBuiltin) opened.document.camera.view = "top";
        state_.session.open(std::move(opened), glm::max(size, glm::ivec2(64)));
        state_.session.motion().set_collisions(state_.preferences.collisions);
        state_.shown.reset();
        state_.boost = 1;
        state_.tool = Tool::Move;
        viewer::remember(state_.preferences, loading->path());
        if (window_) window_->set_title("Edgesplat: " + loading->path());
    } catch (const std::exception& error) {
        state_.error = error.what();
        viewer::remove_missing(state_.preferences);
    }
}

void App::finish_writing(bool wait) {
    std::erase_if(state_.writing, [&](Writing& writing) {
        if (!wait && writing.done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
        try {
            writing.done.get();
            state_.session.say("wrote " + writing.path);
        } catch (const std::exception& error) {
            state_.error = error.what();
        }
        return true;
    });
}

void App::apply_requests() {
    PendingRequests pending_requests = std::exchange(state_.pending_requests, {});
    if (!pending_requests.open.empty()) begin_loading(pending_requests.open);
    if (pending_requests.full_screen && window_) window_->set_full_screen(!window_->full_screen());
    if (pending_requests.device) {
        state_.device.device = state_.preferences.device = *pending_requests.device;
        make_drawer();
        state_.session.force_next_request();
    }
    leaving_ = leaving_ || pending_requests.quit;
    try {
        const glm::ivec2 shown = state_.picture_size();
        if (!pending_requests.save_scene.empty()) {
            edgesplat::SceneDocument document = state_.session.document_to_save(shown);
            auto& recorder = state_.session.recorder();
            if (!recorder.empty()) {
                document.movie = {};
                document.movie.path = recorder.path(0.1 * state_.session.volume().geometry.spacing().x).keys;
            }
            viewer::save_scene(std::move(document), state_.session.volume(), pending_requests.save_scene);
            state_.session.say("wrote " + pending_requests.save_scene);
        }
        if (!pending_requests.save_picture.empty()) {
            const glm::ivec2 size = pending_requests.picture_size.x > 0 ? pending_requests.picture_size : shown;
            viewer::PictureJob order{state_.session.opened().volume, state_.session.document_to_save(size),
                                     state_.device, pending_requests.save_picture, kProgram};
            state_.writing.push_back({pending_requests.save_picture,
                                      std::async(std::launch::async, [order] { viewer::save_picture(order); })});
            if (player_) finish_writing(true);
        }
    } catch (const std::exception& error) {
        state_.error = error.what();
    }
}

void App::lay_out(const Input& input) {
    const int line = static_cast<int>(std::lround(1.7 * state_.em));
    const int left = state_.panels ? std::min(static_cast<int>(std::lround(22 * state_.em)), input.size.x / 2) : 0;
    const int bottom = std::max(input.size.y - line, 1), beside = input.size.x - left;
    const bool slices = state_.slices && state_.session.is_open();
    const int width = std::clamp(static_cast<int>(std::lround(kSlicesShare * beside)), 0,
                                 static_cast<int>(std::lround(kSlicesMost * state_.em)));
    state_.area = {left, 0, input.size.x - (slices ? width : 0), bottom};
    state_.slices_area = {state_.area.z, 0, input.size.x, bottom};
    const glm::dvec2 at = input.mouse - glm::dvec2(state_.area.x, state_.area.y);
    const glm::dvec2 size(state_.picture_size());
    const bool inside = at.x >= 0 && at.y >= 0 && at.x < size.x && at.y < size.y;
    state_.cursor = inside ? std::optional(at) : std::nullopt;
}

void App::show_panels() {
    const auto em = static_cast<float>(state_.em);
    state_.places = {{"picture", glm::dvec4(state_.area)}};
    if (state_.panels) {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({static_cast<float>(state_.area.x), static_cast<float>(state_.area.w)});
        ImGui::Begin("panels", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
        ImGui::PushItemWidth(11 * em);
        const auto section = [&](const char* name, void (*panel)(AppState&), bool open) {
            if (!ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0)) return;
            ImGui::PushID(name);
            panel(state_);
            ImGui::PopID();
        };
        section("File", &file_panel, !state_.session.is_open());
        section("View", &view_panel, true);
        section("Scene", &scene_panel, true);
        section("Accuracy and time", &quality_panel, false);
        section("Guided path", &path_panel, false);
        section("Measure", &measure_panel, false);
        ImGui::PopItemWidth();
        ImGui::End();
    }
    slices_window(state_);
    // When the user releases a widget or handle, the change becomes an undo step.
    if (!ImGui::IsAnyItemActive() && !state_.editing.clip.held) state_.session.finish_edit();
    status_line(state_, state_.area.w, canvas_->size().y - state_.area.w);
    help_window(state_);
    notices(state_);
}

void App::present() {
    std::optional<Surface::Target> target;
    if (surface_) target = surface_->acquire(canvas_->size());
    if (!target) return canvas_->end(state_.pictures, ImGui::GetDrawData());
    canvas_->end(state_.pictures, ImGui::GetDrawData(), {target->free, target->painted},
                 [&](const vk::raii::CommandBuffer& commands, vk::Image image) {
                     surface_->record(commands, *target, image, canvas_->size());
                 });
    surface_->present(*target);
}

void App::frame(const Input& input) {
    if (recorder_) recorder_->add(input);
    if (input.size.x < 1 || input.size.y < 1) return;  // minimised: nothing to draw
    canvas_->resize(input.size);
    size_ = input.size;
    canvas_->begin();
    feed_gui(input);
    ImGui::NewFrame();
    const ImGuiIO& io = ImGui::GetIO();
    lay_out(input);
    for (const std::string& path : input.dropped)
        state_.pending_requests.open = path;
    apply_requests();
    finish_loading();
    finish_writing(false);
    const bool over_picture = state_.cursor && !io.WantCaptureMouse;
    const viewer::Controls controls = controls_.apply(state_, input, over_picture, io.WantTextInput);
    state_.session.step(controls, input.seconds);
    if (auto request = state_.session.next_request(state_.picture_size())) state_.drawer->ask(std::move(*request));
    if (take_pictures(state_) && player_) times_.add(*state_.shown);
    state_.pictures.clear();
    place_pictures(state_);
    show_panels();
    draw_over_picture(state_);
    ImGui::Render();
    if (std::exchange(lose_window_, false)) throw vk::DeviceLostError("simulated by a script");
    present();
}

bool App::is_busy() const {
    return state_.drawer->busy() || state_.loading || !state_.writing.empty() || state_.session.tour().searching() ||
           state_.editing.counter.busy();
}

std::optional<Input> App::next_input() {
    if (!player_) {
        Input input = window_->poll(state_.session.moving() ? kWaitMoving : is_busy() ? kWaitBusy : kWaitIdle);
        if (input.close || leaving_) return std::nullopt;
        return input;
    }
    if (window_) window_->poll(0);
    return leaving_ ? std::nullopt : player_->next();
}

void App::run() {
    // The first frame shows the window before anything is loaded.
    Input first;
    first.size = size_;
    frame(first);
    while (const auto input = next_input()) {
        try {
            frame(*input);
            lost_ = 0;
        } catch (const vk::DeviceLostError&) {
            if (++lost_ > 1) edgesplat::fail("window: the device {} was lost twice in a row", device_->info().name);
            ImGui::EndFrame();
            close_gui();
            open_gui();
            state_.session.force_next_request();
        }
    }
    finish_writing(true);
    if (recorder_) {
        const edgesplat::FileContent content{options_.record, recorder_->text()};
        edgesplat::write_files({&content, 1});
    }
    if (options_.remember) {
        auto& p = state_.preferences;
        if (!window_ || !window_->full_screen()) {
            p.width = size_.x;
            p.height = size_.y;
        }
        viewer::write_preferences(p, viewer::preferences_path());
    }
    const std::uint64_t messages = messages_ + device_->validation_messages() + state_.drawer->validation_messages();
    if (messages > 0) edgesplat::fail("{} validation messages", messages);
}
