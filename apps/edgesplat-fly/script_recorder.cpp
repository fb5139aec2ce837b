#include "apps/edgesplat-fly/script_recorder.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

void ScriptRecorder::add(const Input& input) {
    std::string done;
    long frames = 0;  // that the commands below advance by themselves
    const auto write = [&](const std::string& line) {
        done += line + "\n";
        ++frames;
    };
    if (first_ || input.size != last_.size) write(fmt::format("size {} {}", input.size.x, input.size.y));
    if (first_ || input.mouse != last_.mouse) write(fmt::format("move {:.1f} {:.1f}", input.mouse.x, input.mouse.y));
    constexpr std::array<const char*, 3> kButtons{"left", "right", "middle"};
    for (std::size_t b = 0; b < kButtons.size(); ++b)
        if (input.buttons[b] != last_.buttons[b])
            write(fmt::format("{} {}", input.buttons[b] ? "press" : "release", kButtons[b]));
    if (input.wheel != 0) write(fmt::format("wheel {:g}", input.wheel));
    for (const Key& key : input.pressed)
        write(fmt::format("hold {}", key));
    for (const Key& key : last_.held)
        if (!input.held.contains(key)) write(fmt::format("let {}", key));
    std::string typed;
    for (const char32_t c : input.text)
        if (c < 0x80) typed.push_back(static_cast<char>(c));
    if (!typed.empty() && typed != " ") write("type " + typed);
    for (const std::string& path : input.dropped)
        write("drop " + path);
    time_ += input.seconds;
    last_ = input;
    first_ = false;
    if (done.empty()) return;
    const long now = std::lround(time_ / step_), before = now - frames - written_;
    if (before > 0) {
        text_ += fmt::format("frames {}\n", before);
        written_ += before;
    }
    text_ += done;
    written_ += frames;
}

std::string ScriptRecorder::text() const {
    return fmt::format("step {:g}\n{}settle\n", step_, text_);
}
