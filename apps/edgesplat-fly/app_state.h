// State shared by the parts of the window: the session, and how it is displayed.
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
    Move,       ///< no action: the mouse moves the eye
    Measure,    ///< picks the surface
    PathStart,  ///< sets the start of the guided path, then PathEnd
    PathEnd,
};

/// A file that is being written on a thread.
struct Writing {
    std::string path;
    std::future<void> done;
};

/// Requests of the panels to the app, carried out before the next frame.
struct PendingRequests {
    std::string open;                   ///< path
    std::string save_scene;             ///< path
    std::string save_picture;           ///< path
    glm::ivec2 picture_size{0};         ///< of the picture; 0: as displayed
    std::optional<std::string> device;  ///< see DeviceChoice
    bool quit = false;
    bool full_screen = false;  ///< toggle it
};

struct AppState {
    edgesplat::viewer::Session session;
    edgesplat::viewer::Preferences preferences;
    edgesplat::DeviceChoice device;
    std::vector<edgesplat::DeviceInfo> devices;
    std::unique_ptr<edgesplat::viewer::Drawer> drawer;
    std::unique_ptr<edgesplat::viewer::Loading> loading;
    std::vector<Writing> writing;
    PendingRequests pending_requests;

    std::optional<edgesplat::viewer::DrawnPicture> shown;  ///< without its pixels once they are on the canvas
    edgesplat::Image last_edges, last_plain;               ///< the pixels of `shown`
    bool has_plain = false;                                ///< `shown` has a conventional picture, too
    bool sharpening_due = false;                           ///< `sharpening` must be computed from them
    CanvasPicture edges, plain, sharpening;
    std::vector<Placed> pictures;  ///< pictures that this frame paints under the panels, lowest first

    glm::ivec4 area{0};         ///< rectangle of the picture in the window: left, top, right, bottom
    glm::ivec4 slices_area{0};  ///< rectangle of the slices; empty without them
    Tool tool = Tool::Move;
    bool panels = true, help = false, slices = false;
    bool overlays = true;  ///< scale bar, orientation, picks
    double boost = 1;      ///< factor on flying speed, set with the wheel
    edgesplat::viewer::Drawer::Options::Rays rays = edgesplat::viewer::Drawer::Options::Rays::OnProcessor;
    double target = 150;               ///< time limit of a picture in motion, milliseconds
    std::string error;                 ///< shown until the user closes it
    std::optional<glm::dvec2> cursor;  ///< pixel of the picture under the mouse

    SceneEditing editing;
    SliceView slice_view;
    SlicePictures slice_pictures;
    std::map<std::string, glm::dvec4> places;  ///< widgets of the last frame, for scripts: left, top, right, bottom
    std::string scope;                         ///< see Scope
    bool wait;                                 ///< frames wait for background threads

    explicit AppState(bool waits) : session(waits), wait(waits) {}
    /// How the picture is shown: as the session says, but edge-preserved until a conventional picture is drawn.
    edgesplat::viewer::Show visible() const { return has_plain ? session.show() : edgesplat::viewer::Show::Edges; }
    glm::ivec2 picture_size() const { return {area.z - area.x, area.w - area.y}; }
    /// Height of text, pixels: the unit of widget sizes.
    double em = 16;
};
