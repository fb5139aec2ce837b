#include <fmt/format.h>
#include <imgui.h>

#include "apps/edgesplat-fly/panels.h"

void path_panel(AppState& state) {
    if (!state.session.is_open()) return;
    auto& session = state.session;
    auto& tour = session.tour();
    const bool choosing = state.tool == Tool::PathStart || state.tool == Tool::PathEnd;
    if (ImGui::Button(choosing ? "click in the picture..." : "click two points"))
        state.tool = choosing ? Tool::Move : Tool::PathStart;
    if (choosing) {
        ImGui::SameLine();
        ImGui::TextUnformatted(state.tool == Tool::PathStart ? "first point" : "second point");
    }
    if (ImGui::Button("start here")) tour.from = session.motion().camera().eye;
    ImGui::SameLine();
    if (ImGui::Button("end here")) {
        tour.to = session.motion().camera().eye;
        tour.find(session.walls());
    }
    if (tour.searching()) ImGui::TextUnformatted("searching the path...");
    if (!tour.line()) return;
    auto at = static_cast<float>(tour.position());
    if (ImGui::SliderFloat("mm", &at, 0, static_cast<float>(tour.line()->length), "%.1f")) {
        tour.playing = false;
        tour.set_position(static_cast<double>(at));
        session.motion().jump(tour.camera(session.motion().camera().up));
    }
    if (ImGui::Button(tour.playing ? "stop" : "travel")) tour.toggle();
    ImGui::SameLine();
    if (ImGui::Button("look ahead")) tour.look = glm::dvec2(0);
    ImGui::SameLine();
    if (ImGui::Button("set as movie")) {
        const edgesplat::CameraPath path = tour.path(session.motion().camera().up);
        session.edit([&](edgesplat::SceneDocument& d) {
            d.movie.orbit.reset();
            d.movie.flight.reset();
            d.movie.voxel = false;
            d.movie.path = path.keys;
            d.movie.loop = path.loop;
        });
        session.say("the scene's movie follows the path: save it, then edgesplat movie SCENE");
    }
    auto speed = static_cast<float>(tour.speed), fov = static_cast<float>(tour.fov);
    if (ImGui::SliderFloat("mm/s", &speed, 1, 200, "%.0f", ImGuiSliderFlags_Logarithmic))
        tour.speed = static_cast<double>(speed);
    if (ImGui::SliderFloat("view angle", &fov, 20, 120, "%.0f°")) tour.fov = static_cast<double>(fov);
}
