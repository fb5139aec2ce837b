#include "apps/edgesplat-fly/controls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/edgesplat-fly/clip_handles.h"
#include "engine/viewer/keeping.h"

namespace {

using edgesplat::viewer::Controls;
using edgesplat::viewer::MotionMode;
using edgesplat::viewer::Session;
using edgesplat::viewer::Show;

constexpr double kRadiansPerHeight = 3.5;  // turned by a drag over the picture's height
constexpr double kClickPixels = 4, kDoubleClickSeconds = 0.4;
constexpr double kDividerPixels = 8;

void toggle(Session& session, Show show) {
    session.set_show(session.show() == show ? Show::Edges : show);
}

void toggle_mode(AppState& s) {
    auto& motion = s.session.motion();
    const bool fly = motion.mode() == MotionMode::Orbit;
    motion.set_mode(fly ? MotionMode::Fly : MotionMode::Orbit);
    s.session.say(fly ? "fly: W A S D to move, mouse to look" : "orbit: drag to turn, wheel to zoom");
}

void go_home(AppState& s) {
    s.session.tour().playing = false;
    s.session.motion().home();
}

void next_show(AppState& s) {
    constexpr std::array<Show, 4> kAll{Show::Edges, Show::Plain, Show::Wipe, Show::Sharpening};
    const auto now = static_cast<std::size_t>(std::ranges::find(kAll, s.session.show()) - kAll.begin());
    s.session.set_show(kAll[(now + 1) % kAll.size()]);
}

/// Saves under the first name that does not exist as a file and is not being written.
void save_picture(AppState& s) {
    s.pending_requests.save_picture =
        edgesplat::viewer::free_path(".", "picture", ".png", [&](const std::filesystem::path& path) {
            return std::ranges::count(s.writing, path.string(), &Writing::path) > 0;
        }).string();
}

constexpr std::array<Shortcut, 43> kShortcuts{{
    {"F1", "this help", [](AppState& s) { s.help = !s.help; }},
    {"Tab", "show or hide the panels", [](AppState& s) { s.panels = !s.panels; }},
    {"F", "switch between flying and orbiting", toggle_mode},
    {"Home", "back to the first view", go_home},
    {"Space", "plain or edge-preserved picture", [](AppState& s) { toggle(s.session, Show::Plain); }},
    {"X", "wipe between plain and edge-preserved", [](AppState& s) { toggle(s.session, Show::Wipe); }},
    {"H", "show where edges were sharpened, and how much", [](AppState& s) { toggle(s.session, Show::Sharpening); }},
    {"B", "most accurate picture when nothing moves",
     [](AppState& s) { s.session.set_best_when_still(!s.session.best_when_still()); }},
    {"C", "switch collisions with walls on or off",
     [](AppState& s) {
         auto& motion = s.session.motion();
         motion.set_collisions(!motion.collisions());
         s.preferences.collisions = motion.collisions();
     }},
    {"M", "measure: click to pick the surface",
     [](AppState& s) { s.tool = s.tool == Tool::Measure ? Tool::Move : Tool::Measure; }},
    {"Delete", "delete the picks", [](AppState& s) { s.session.clear_picks(); }},
    {"G", "guided path: click its two ends",
     [](AppState& s) { s.tool = s.tool == Tool::PathStart || s.tool == Tool::PathEnd ? Tool::Move : Tool::PathStart; }},
    {"Enter", "start or stop travelling along the path", [](AppState& s) { s.session.tour().toggle(); }},
    {"L", "show or hide slices through the last pick", [](AppState& s) { s.slices = !s.slices; }},
    {"O", "show or hide scale bar, orientation and picks", [](AppState& s) { s.overlays = !s.overlays; }},
    {"Ctrl+Z", "undo", [](AppState& s) { s.session.undo(); }},
    {"Ctrl+Y", "redo", [](AppState& s) { s.session.redo(); }},
    {"Ctrl+S", "save the scene in the working folder",
     [](AppState& s) { s.pending_requests.save_scene = edgesplat::viewer::free_path(".", "scene", ".toml").string(); }},
    {"F12", "save the picture in the working folder", save_picture},
    {"Ctrl+R", "start or stop recording the flight", toggle_recording},
    {"F11", "full screen", [](AppState& s) { s.pending_requests.full_screen = true; }},
    {"Ctrl+Q", "quit", [](AppState& s) { s.pending_requests.quit = true; }},
    {"Escape", "stop travelling, leave the tool, close the help",
     [](AppState& s) {
         s.session.tour().playing = false;
         s.tool = Tool::Move;
         s.help = false;
     }},
    {"W A S D", "fly forward, left, back, right (orbit: pan)", nullptr},
    {"Q E", "down, up", nullptr},
    {"Z V", "roll left, right", nullptr},
    {"Shift", "move three times as fast", nullptr},
    {"left drag", "orbit, or look around when flying", nullptr},
    {"right drag", "pan when orbiting", nullptr},
    {"wheel", "zoom when orbiting, change the speed when flying", nullptr},
    {"double click", "fly to that surface and orbit around it", nullptr},
    {"Ctrl+click", "pick the surface", nullptr},
    {"drag the divider", "move the wipe", nullptr},
    {"drag a handle", "move a clip plane or a side of a box", nullptr},
    {"histogram", "drag to move, double click adds, right click removes", nullptr},
    {"slices", "click or drag to set the point, wheel: next slice", nullptr},
    {"drop a file or folder", "open it", nullptr},
    {"left stick, right stick", "gamepad: fly, look around; triggers: down, up", nullptr},
    {"PadX", "gamepad: plain or edge-preserved picture", [](AppState& s) { toggle(s.session, Show::Plain); }},
    {"PadB", "gamepad: next display: plain, wipe, sharpening", next_show},
    {"PadA", "gamepad: switch between flying and orbiting", toggle_mode},
    {"PadY", "gamepad: back to the first view", go_home},
    {"PadStart", "gamepad: save the picture in the working folder", save_picture},
}};

bool pressed(const Input& input, std::string_view keys) {
    constexpr std::string_view kCtrl = "Ctrl+";
    const bool ctrl = keys.starts_with(kCtrl);
    if (ctrl) keys.remove_prefix(kCtrl.size());
    return ctrl == input.ctrl() && std::ranges::find(input.pressed, keys) != input.pressed.end();
}

double axis(const Input& input, std::string_view less, std::string_view more) {
    return (input.holds(more) ? 1.0 : 0.0) - (input.holds(less) ? 1.0 : 0.0);
}

}  // namespace

void toggle_recording(AppState& s) {
    auto& recorder = s.session.recorder();
    if (recorder.recording()) {
        recorder.stop();
        s.session.say(fmt::format("recorded {:.1f} s; it is saved with the scene", recorder.seconds()));
    } else {
        recorder.start();
        s.session.say("recording the flight");
    }
}

std::span<const Shortcut> shortcuts() {
    return kShortcuts;
}

void PictureControls::click(AppState& state, const glm::dvec2& pixel, bool twice, bool picking) {
    Session& session = state.session;
    const glm::ivec2 size = state.picture_size();
    if (twice && state.tool == Tool::Move) {
        if (!session.fly_to(pixel, size)) session.say("no surface there to fly to");
        return;
    }
    if (picking || state.tool == Tool::Measure) {
        if (!session.pick_at(pixel, size)) session.say("no surface there");
        return;
    }
    if (state.tool != Tool::PathStart && state.tool != Tool::PathEnd) return;
    const auto found =
        edgesplat::viewer::pick(session.volume(), session.scene(), session.motion().camera(), size, pixel);
    if (!found || !session.walls()) {
        session.say(found ? "walls are still being computed" : "no surface there; click in the cavity");
        return;
    }
    // The end lies two voxels off the clicked wall: on the wall itself, the path might run on its opposite side.
    const glm::dvec3 place = found->world + 2 * session.walls()->voxel() * found->normal;
    auto& tour = session.tour();
    if (state.tool == Tool::PathStart) {
        tour.clear();
        tour.from = place;
        state.tool = Tool::PathEnd;
    } else {
        tour.to = place;
        tour.find(session.walls());
        state.tool = Tool::Move;
    }
}

void PictureControls::mouse(AppState& state, const Input& input, bool over_picture, Controls& controls) {
    Session& session = state.session;
    const glm::dvec2 at = input.mouse - glm::dvec2(state.area.x, state.area.y);
    const glm::ivec2 size = state.picture_size();
    const bool fly = session.motion().mode() == MotionMode::Fly;
    const bool left = input.down(Button::Left), right = input.down(Button::Right), middle = input.down(Button::Middle);
    const bool down = left || right || middle;
    since_click_ += input.seconds;
    if (down && !was_down_ && over_picture) {
        const bool divider =
            session.show() == Show::Wipe && left && std::abs(at.x - session.wipe() * size.x) < kDividerPixels;
        const bool shifts = right || middle || input.shift();
        drag_ = divider ? Drag::Wipe : fly && left ? Drag::Look : shifts ? Drag::Pan : Drag::Orbit;
        pressed_at_ = last_ = at;
        travelled_ = 0;
    }
    const glm::dvec2 way = at - last_;
    last_ = at;
    // Also if the button is up again: movement between two slow frames counts.
    if (drag_ != Drag::None) {
        travelled_ += glm::length(way);
        const glm::dvec2 turned = kRadiansPerHeight * state.preferences.turn / std::max(size.y, 1) * way;
        const double sign = state.preferences.invert_look ? 1 : -1;
        // A drag shorter than a hand's tremble is a click.
        if (travelled_ > kClickPixels || drag_ == Drag::Wipe) {
            if (drag_ == Drag::Wipe) session.set_wipe(at.x / std::max(size.x, 1));
            if (drag_ == Drag::Look) controls.look += glm::dvec2(turned.x, sign * turned.y) * 0.5;
            if (drag_ == Drag::Orbit) controls.orbit += glm::dvec2(-turned.x, turned.y);
            if (drag_ == Drag::Pan)
                controls.pan += glm::dvec2(-way.x, way.y) / static_cast<double>(std::max(size.y, 1));
        }
    }
    if (!down && was_down_ && drag_ != Drag::None) {
        if (travelled_ <= kClickPixels && drag_ != Drag::Wipe && drag_ != Drag::Pan) {
            const bool twice = since_click_ < kDoubleClickSeconds && glm::length(at - clicked_at_) < 2 * kClickPixels;
            click(state, pressed_at_, twice, input.ctrl());
            since_click_ = twice ? 1e9 : 0;
            clicked_at_ = at;
        }
        drag_ = Drag::None;
    }
    was_down_ = down;
    if (over_picture && input.wheel != 0) {
        if (fly)
            state.boost = std::clamp(state.boost * std::pow(1.2, input.wheel), 0.1, 10.0);
        else
            controls.zoom += input.wheel;
    }
}

Controls PictureControls::apply(AppState& state, const Input& input, bool over_picture, bool typing) {
    Controls controls;
    if (!typing) {
        for (const Shortcut& shortcut : kShortcuts)
            if (shortcut.act != nullptr && pressed(input, shortcut.keys) &&
                (state.session.is_open() || shortcut.keys == "F1" || shortcut.keys == "Ctrl+Q"))
                shortcut.act(state);
        if (!input.ctrl()) {
            controls.move = {axis(input, "A", "D"), axis(input, "Q", "E"), axis(input, "S", "W")};
            controls.roll = axis(input, "Z", "V");
        }
    }
    if (!state.session.is_open()) return {};
    if (!clip_handles(state, input, over_picture)) mouse(state, input, over_picture, controls);
    const Gamepad& pad = input.gamepad;
    controls.move += glm::dvec3(pad.left.x, pad.rise, pad.left.y);
    controls.look += 2.0 * input.seconds * state.preferences.turn * pad.right;
    controls.boost = state.boost * state.preferences.speed * (input.shift() ? 3 : 1);
    return controls;
}
