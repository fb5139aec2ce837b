#include "apps/edgesplat-fly/script_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/error.h"

namespace {

using edgesplat::viewer::ScriptCommand;

constexpr int kMostSettleFrames = 20000;

Button button_named(const std::string& name) {
    return name == "left" ? Button::Left : name == "right" ? Button::Right : Button::Middle;
}

void set_button(Input& input, Button button, bool down) {
    input.buttons[static_cast<std::size_t>(button)] = down;
}

std::u32string decoded(const std::string& utf8) {
    std::u32string out;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[i++]);
        int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
        char32_t c = more == 3 ? lead & 0x07U : more == 2 ? lead & 0x0FU : more == 1 ? lead & 0x1FU : lead;
        for (; more > 0 && i < utf8.size(); --more)
            c = c << 6U | (static_cast<unsigned char>(utf8[i++]) & 0x3FU);
        out.push_back(c);
    }
    return out;
}

}  // namespace

ScriptPlayer::ScriptPlayer(std::vector<ScriptCommand> commands, ScriptHost host, const glm::ivec2& size)
    : commands_(std::move(commands)), host_(std::move(host)) {
    input_.size = size;
}

std::optional<Input> ScriptPlayer::next() {
    input_.pressed.clear();
    input_.text.clear();
    input_.dropped.clear();
    input_.wheel = 0;
    while (pending_.empty()) {
        if (settling_) {
            settling_ = !host_.settled();
            if (!settling_) continue;
            if (++settle_frames_ > kMostSettleFrames)
                edgesplat::fail("{}: settle: the picture was not complete within {} frames", commands_[at_ - 1].where,
                                kMostSettleFrames);
            frame();
            break;
        }
        if (at_ == commands_.size()) return std::nullopt;
        begin(commands_[at_++]);
    }
    // cppcheck-suppress containerOutOfBounds; begin() above adds to pending_
    const Change change = std::move(pending_.front());
    pending_.pop_front();
    if (change) change(input_);
    return input_;
}

void ScriptPlayer::expect(const ScriptCommand& command) const {
    std::string value;
    try {
        value = host_.value(command.words[0]);
    } catch (const edgesplat::Error& error) {
        edgesplat::fail("{}: expect: {}", command.where, error.what());
    }
    if (!edgesplat::viewer::holds(value, command.words[1], command.words[2]))
        edgesplat::fail("{}: expect: {} is {}, expected {} {}", command.where, command.words[0], value,
                        command.words[1], command.words[2]);
}

void ScriptPlayer::begin(const ScriptCommand& c) {
    const auto place = [&](std::size_t word) { return glm::dvec2(c.number(word), c.number(word + 1)); };
    const auto struck = [](const std::string& keys) {
        return [keys](Input& in) {
            const bool ctrl = keys.starts_with("Ctrl+");
            const Key key = ctrl ? keys.substr(5) : keys;
            if (ctrl) in.held.insert("Ctrl");
            in.held.insert(key);
            in.pressed.push_back(key);
        };
    };
    const auto clicked = [&](const glm::dvec2& at) {
        frame([at](Input& in) { in.mouse = at; });
        frame([](Input& in) { set_button(in, Button::Left, true); });
        frame([](Input& in) { set_button(in, Button::Left, false); });
    };
    if (c.verb == "size") frame([size = glm::ivec2(place(0))](Input& in) { in.size = size; });
    if (c.verb == "step") input_.seconds = std::clamp(c.number(0), 1e-4, 1.0);
    if (c.verb == "quality") host_.fix_quality(c.words[0] == "fixed");
    if (c.verb == "open") host_.open(c.words[0]);
    if (c.verb == "frames")
        for (int i = 0; i < static_cast<int>(c.number(0)); ++i)
            frame();
    if (c.verb == "settle") {
        frame();
        settling_ = true;
        settle_frames_ = 0;
    }
    if (c.verb == "move") frame([at = place(0)](Input& in) { in.mouse = at; });
    if (c.verb == "drag") {
        const int frames = std::max(static_cast<int>(c.number(2)), 1);
        for (int i = 1; i <= frames; ++i)
            frame([to = place(0), left = frames - i + 1](Input& in) {
                in.mouse += (to - in.mouse) / static_cast<double>(left);
            });
    }
    if (c.verb == "aim") aim(c, place(1));
    if (c.verb == "tap") {
        aim(c, glm::dvec2(0.5));
        frame([](Input& in) { set_button(in, Button::Left, true); });
        frame([](Input& in) { set_button(in, Button::Left, false); });
    }
    if (c.verb == "press" || c.verb == "release")
        frame([b = button_named(c.words[0]), down = c.verb == "press"](Input& in) { set_button(in, b, down); });
    if (c.verb == "click" || c.verb == "double") clicked(place(0));
    if (c.verb == "double") clicked(place(0));
    if (c.verb == "wheel") frame([steps = c.number(0)](Input& in) { in.wheel = steps; });
    if (c.verb == "hold") frame(struck(c.words[0]));
    if (c.verb == "let") frame([key = c.words[0]](Input& in) { in.held.erase(key); });
    if (c.verb == "key") {
        frame(struck(c.words[0]));
        frame([keys = c.words[0]](Input& in) {
            const bool ctrl = keys.starts_with("Ctrl+");
            if (ctrl) in.held.erase("Ctrl");
            in.held.erase(ctrl ? keys.substr(5) : keys);
        });
    }
    if (c.verb == "sticks") frame([pad = Gamepad{place(0), place(2), c.number(4)}](Input& in) { in.gamepad = pad; });
    if (c.verb == "type") frame([text = decoded(c.words[0])](Input& in) { in.text = text; });
    if (c.verb == "drop") frame([path = c.words[0]](Input& in) { in.dropped = {path}; });
    if (c.verb == "wander") wander(c.number(0), static_cast<unsigned>(static_cast<int>(c.number(1))));
    if (c.verb == "screenshot") host_.screenshot(c.words[0]);
    if (c.verb == "picture") host_.picture(c.words[0]);
    if (c.verb == "save") host_.save(c.words[0]);
    if (c.verb == "expect") expect(c);
    if (c.verb == "lose") host_.simulate_device_loss(c.words[0] == "window");
    if (c.verb == "report") host_.report(c.words[0]);
}

void ScriptPlayer::aim(const ScriptCommand& command, const glm::dvec2& share) {
    // The widget's place is read in that frame, not now.
    frame([this, where = command.where, name = command.words[0], share](Input& in) {
        try {
            const glm::dvec4 at = host_.widget(name);
            in.mouse = {at.x + share.x * (at.z - at.x), at.y + share.y * (at.w - at.y)};
        } catch (const edgesplat::Error& error) {
            edgesplat::fail("{}: {}", where, error.what());
        }
    });
}

void ScriptPlayer::wander(double seconds, unsigned seed) {
    std::mt19937 random(seed);
    // Without distributions, because they differ between standard libraries.
    const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    const auto frames = static_cast<int>(std::lround(seconds / input_.seconds));
    for (int i = 0; i < frames;) {
        const int length = std::min(static_cast<int>((0.5 + uniform()) / input_.seconds) + 1, frames - i);
        const double angle = 2 * std::numbers::pi * uniform(), rate = 120 + 360 * uniform();  // pixels per second
        const glm::dvec2 way = rate * input_.seconds * glm::dvec2(std::cos(angle), std::sin(angle));
        const bool forward = uniform() < 0.85;
        for (int j = 0; j < length; ++j) {
            frame([way, forward, first = j == 0, last = j + 1 == length](Input& in) {
                const glm::dvec2 middle = 0.5 * glm::dvec2(in.size);
                in.mouse = first ? middle : in.mouse + way;
                set_button(in, Button::Left, !first && !last);
                in.held.erase(forward ? "S" : "W");
                in.held.insert(forward ? "W" : "S");
            });
        }
        i += length;
    }
    frame([](Input& in) {
        in.held.clear();
        in.buttons = {};
    });
}
