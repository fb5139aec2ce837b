// App: the functions that scripts call.
#include "apps/edgesplat-fly/app.h"
#include "apps/edgesplat-fly/picture_view.h"
#include "engine/error.h"
#include "engine/image/image_file.h"
#include "engine/image/srgb.h"
#include "engine/scene/nearest_name.h"

namespace {

namespace viewer = edgesplat::viewer;

edgesplat::Image as_image(const viewer::ScreenPicture& picture) {
    edgesplat::Image image(picture.width, picture.height, 3);
    // encode_png converts linear light to sRGB; the inverse before it keeps the bytes unchanged.
    for (std::size_t i = 0; i < image.pixels.size() / 3; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image.pixels[3 * i + c] = static_cast<float>(edgesplat::to_linear(picture.pixels[4 * i + c] / 255.0));
    return image;
}

}  // namespace

ScriptHost App::script_host() {
    ScriptHost host;
    host.open = [this](const std::string& path) {
        begin_loading(path);
        finish_loading();
        if (!state_.error.empty()) edgesplat::fail("{}", state_.error);
    };
    host.settled = [this] { return !is_busy() && !state_.session.moving(); };
    host.screenshot = [this](const std::string& path) { edgesplat::write_image(path, as_image(canvas_->read())); };
    host.picture = [this](const std::string& path) {
        edgesplat::write_image(path, as_image(part_of(canvas_->read(), state_.area)));
    };
    host.save = [this](const std::string& path) {
        state_.pending_requests.save_scene = path;
        apply_requests();
        if (!state_.error.empty()) edgesplat::fail("{}", state_.error);
    };
    host.report = [this](const std::string& path) {
        times_.write(path, state_.target);
        times_.clear();
    };
    host.fix_quality = [this](bool fixed) { state_.drawer->freeze_pace(fixed); };
    host.widget = [this](const std::string& name) {
        const auto found = state_.places.find(name);
        if (found != state_.places.end()) return found->second;
        std::vector<std::string> names;
        for (const auto& [known, place] : state_.places)
            names.push_back(known);
        const std::string nearest = edgesplat::nearest_name(name, names);
        edgesplat::fail("no visible widget is called '{}'{}", name,
                        nearest.empty() ? std::string() : fmt::format("; did you mean {}?", nearest));
    };
    host.simulate_device_loss = [this](bool window) {
        if (window)
            lose_window_ = true;
        else
            state_.drawer->simulate_device_loss();
    };
    host.value = [this](const std::string& name) { return value(name); };
    return host;
}
