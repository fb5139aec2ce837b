// The values that scripts can compare.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "apps/edgesplat-fly/app.h"
#include "engine/error.h"
#include "engine/scene/scene_keys.h"

namespace {

using edgesplat::viewer::MotionMode;
using edgesplat::viewer::Show;

std::string text(double number) {
    return fmt::format("{:.10g}", number);
}

std::string name_of(Show show) {
    switch (show) {
        case Show::Plain:
            return "plain";
        case Show::Wipe:
            return "wipe";
        case Show::Sharpening:
            return "sharpening";
        case Show::Edges:
            break;
    }
    return "edges";
}

using Values = std::map<std::string, std::function<std::string(AppState&)>>;

const Values& values() {
    static const Values all{
        {"show", [](AppState& s) { return name_of(s.session.show()); }},
        {"visible", [](AppState& s) { return name_of(s.visible()); }},
        {"wipe", [](AppState& s) { return text(s.session.wipe()); }},
        {"mode", [](AppState& s) { return s.session.motion().mode() == MotionMode::Fly ? "fly" : "orbit"; }},
        {"collisions", [](AppState& s) { return s.session.motion().collisions() ? "on" : "off"; }},
        {"panels", [](AppState& s) { return s.panels ? "on" : "off"; }},
        {"help", [](AppState& s) { return s.help ? "on" : "off"; }},
        {"slices", [](AppState& s) { return s.slices ? "on" : "off"; }},
        {"message", [](AppState& s) { return s.session.message(); }},
        {"error", [](AppState& s) { return s.error.empty() ? "none" : s.error; }},
        {"volume", [](AppState& s) { return s.session.is_open() ? s.session.opened().path : "none"; }},
        {"volumes", [](AppState& s) { return text(static_cast<double>(s.session.document().volumes.size() + 1)); }},
        {"volumes_shown",
         [](AppState& s) {
             const edgesplat::Scene& scene = s.session.scene();
             int shown = 0;
             for (std::size_t number = 0; number <= scene.added.size(); ++number)
                 shown += has_matter(scene_of_volume(scene, number)) ? 1 : 0;
             return text(shown);
         }},
        {"finished", [](AppState& s) { return s.shown && s.shown->finished ? "yes" : "no"; }},
        {"best", [](AppState& s) { return s.shown && s.shown->best ? "yes" : "no"; }},
        {"moving", [](AppState& s) { return s.shown && s.shown->moving ? "yes" : "no"; }},
        {"rays", [](AppState& s) { return s.shown && s.shown->rung.rays ? "yes" : "no"; }},
        {"level", [](AppState& s) { return text(s.shown ? s.shown->rung.level : -1); }},
        {"scale", [](AppState& s) { return text(s.shown ? s.shown->rung.scale : 0); }},
        {"splats", [](AppState& s) { return text(s.shown ? static_cast<double>(s.shown->stats.splats_drawn) : 0); }},
        {"renderers", [](AppState& s) { return text(static_cast<double>(s.drawer->renderers())); }},
        {"coarse_error",
         [](AppState& s) { return text(s.shown && s.shown->coarse_error ? *s.shown->coarse_error : -1); }},
        {"eye.x", [](AppState& s) { return text(s.session.motion().camera().eye.x); }},
        {"eye.y", [](AppState& s) { return text(s.session.motion().camera().eye.y); }},
        {"eye.z", [](AppState& s) { return text(s.session.motion().camera().eye.z); }},
        {"fov", [](AppState& s) { return text(s.session.motion().camera().fov_y); }},
        {"room",
         [](AppState& s) {
             return text(s.session.walls() ? s.session.walls()->distance(s.session.motion().camera().eye) : -1e9);
         }},
        {"picks", [](AppState& s) { return text(static_cast<double>(s.session.picks().size())); }},
        {"pick.value",
         [](AppState& s) { return text(s.session.picks().empty() ? -1e9 : s.session.picks().back().value); }},
        {"ruler", [](AppState& s) { return text(s.session.ruler() ? s.session.ruler()->length : -1); }},
        {"ruler.uncertainty",
         [](AppState& s) { return text(s.session.ruler() ? s.session.ruler()->uncertainty : -1); }},
        {"iso",
         [](AppState& s) {
             return text(s.session.scene().iso_values.empty() ? -1e9 : s.session.scene().iso_values.front());
         }},
        {"iso_values", [](AppState& s) { return text(static_cast<double>(s.session.scene().iso_values.size())); }},
        {"transfer_points", [](AppState& s) { return text(static_cast<double>(s.session.scene().transfer.size())); }},
        {"clip_planes",
         [](AppState& s) { return text(static_cast<double>(s.session.scene().effects.clip.keep.size())); }},
        {"lights", [](AppState& s) { return text(static_cast<double>(s.session.scene().lights.size())); }},
        {"undo", [](AppState& s) { return s.session.can_undo() ? "yes" : "no"; }},
        {"redo", [](AppState& s) { return s.session.can_redo() ? "yes" : "no"; }},
        {"point.x", [](AppState& s) { return text(s.session.point() ? s.session.point()->x : -1e9); }},
        {"point.y", [](AppState& s) { return text(s.session.point() ? s.session.point()->y : -1e9); }},
        {"point.z", [](AppState& s) { return text(s.session.point() ? s.session.point()->z : -1e9); }},
        {"keep_box", [](AppState& s) { return s.session.document().keep_box ? "on" : "off"; }},
        {"remove_box", [](AppState& s) { return s.session.document().remove_box ? "on" : "off"; }},
        {"path", [](AppState& s) { return text(s.session.tour().line() ? s.session.tour().line()->length : -1); }},
        {"path.position", [](AppState& s) { return text(s.session.tour().position()); }},
        {"recorded", [](AppState& s) { return text(s.session.recorder().seconds()); }},
        {"edges",
         [](AppState& s) { return std::string(edgesplat::name_of(s.session.document().quality.settings.edges)); }},
        {"device_mb", [](AppState& s) { return text(static_cast<double>(s.drawer->device_bytes()) / 1e6); }},
    };
    return all;
}

}  // namespace

std::string value_names() {
    std::string names = "scene.KEY (any number of the scene file)";
    for (const auto& [known, get] : values())
        names += ", " + known;
    return names;
}

std::string App::value(const std::string& name) {
    // For example scene.effects.fog.density: any number of the scene file.
    constexpr std::string_view kScene = "scene.";
    if (name.starts_with(kScene))
        return text(edgesplat::number_at(state_.session.document(), name.substr(kScene.size())));
    const auto found = values().find(name);
    if (found == values().end()) edgesplat::fail("'{}' is not a value; known values: {}", name, value_names());
    // cppcheck-suppress derefInvalidIteratorRedundantCheck; fail() does not return
    return found->second(state_);
}
