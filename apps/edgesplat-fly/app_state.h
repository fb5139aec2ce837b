// What the parts of the window share: the session, and how it is looked at.
#pragma once

#include <array>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/edgesplat-fly/canvas.h"
#include "apps/edgesplat-fly/input.h"
#include "apps/edgesplat-fly/scene_editing.h"
#include "apps/edgesplat-fly/slice_pictures.h"
#include "engine/viewer/preferences.h"
#include "engine/viewer/session.h"

/// What a click in the picture does.
enum class Tool {
    Move,       ///< nothing: the mouse moves the eye
    Measure,    ///< picks the surface
    PathStart,  ///< where the guided path begins, then PathEnd
    PathEnd,
};

/// A file that is being written on a thread.
struct Writing {
    std::string path;
    std::future<void> done;
};

/// A question to the rest of the app that a panel asks; done before the next frame.
struct Wishes {
    std::string open;                   ///< path
    std::string save_scene;             ///< path
    std::string save_picture;           ///< path
    glm::ivec2 picture_size{0};         ///< of it; 0: as it is shown
    std::optional<std::string> device;  ///< see DeviceChoice
    bool quit = false;
    bool full_screen = false;  ///< to be toggled
};

struct AppState {
    edgesplat::viewer::Session session;
    edgesplat::viewer::Preferences preferences;
    edgesplat::DeviceChoice device;
    std::vector<edgesplat::DeviceInfo> devices;
    std::unique_ptr<edgesplat::viewer::Drawer> drawer;
    std::unique_ptr<edgesplat::viewer::Loading> loading;
    std::vector<Writing> writing;
    Wishes wishes;

    std::optional<edgesplat::viewer::DrawnPicture> shown;  ///< without its pixels once they are on the canvas
    edgesplat::Image last_edges, last_plain;               ///< its pixels
    bool has_plain = false;                                ///< it was drawn with conventional splatting beside it
    bool sharpening_due = false;                           ///< not made of them yet
    CanvasPicture edges, plain, sharpening;
    std::vector<Placed> pictures;  ///< what this frame paints under the panels, lowest first

    glm::ivec4 area{0};         ///< of the picture in the window: left, top, right, bottom
    glm::ivec4 slices_area{0};  ///< of the slices; empty without them
    Tool tool = Tool::Move;
    bool panels = true, help = false, slices = false;
    bool overlays = true;  ///< scale bar, orientation, picks
    double boost = 1;      ///< factor on flying speed, by the wheel
    edgesplat::viewer::Drawer::Options::Rays rays = edgesplat::viewer::Drawer::Options::Rays::OnProcessor;
    double target = 150;               ///< milliseconds a picture may take while something moves
    std::string error;                 ///< to be shown until it is clicked away
    std::optional<glm::dvec2> cursor;  ///< pixel of the picture below the mouse

    SceneEditing editing;
    SliceView slice_view;
    SlicePictures slice_pictures;
    std::map<std::string, glm::dvec4> places;  ///< of widgets in the last frame, for scripts: left, top, right, bottom
    std::string scope;                         ///< see Scope
    bool wait;                                 ///< what else happens on threads is done before a frame ends

    explicit AppState(bool waits) : session(waits), wait(waits) {}
    /// How the picture is looked at: as the session says, or until what that needs is drawn, edge-preserved.
    edgesplat::viewer::Show visible() const { return has_plain ? session.show() : edgesplat::viewer::Show::Edges; }
    glm::ivec2 picture_size() const { return {area.z - area.x, area.w - area.y}; }
    /// A length of text and widgets, pixels.
    double em = 16;
};
