// Scene files: an accepted document round-trips; its scene, camera, path and transfer function are resolved for a small
// volume.
#include <cmath>
#include <cstdlib>

#include "engine/error.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/analytic_volumes.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

namespace {

void use(const SceneDocument& document) {
    static const Volume volume = builtin_volume("builtin:sphere:8");
    const Scene scene = resolve_scene(document, volume);
    for (const double value : {-1e30, 0.0, 0.5, 1e30})
        if (!scene.transfer.empty()) (void)transfer_at(scene.transfer, value);
    (void)scaled_transfer(scene, volume);
    const Camera camera = resolve_camera(document, volume, scene);
    for (const AnimatedParameter& parameter : resolve_animation(document))
        (void)value_at(parameter, 0.5);
    const CameraPath path = resolve_camera_path(document, volume, camera);
    for (const double at : {0.0, 0.3, 1.0})
        (void)camera_at(path, path.keys.front().time + at * duration(path));
    const std::string text = scene_text(resolved(document, volume, scene, camera, document.quality.settings));
    (void)parse_scene(text, "resolved.toml", {.folders = {}, .whole = false});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)fuzz::folder();
    SceneDocument document;
    try {
        document = parse_scene(fuzz::text_of(data, size), "scene.toml", {.folders = {}});
    } catch (const Error&) {
        return 0;
    }
    // No try here: an accepted document must be writable and readable again.
    for (const std::string& text : {scene_text(document), commented_scene_text(document)})
        if (!(parse_scene(text, "again.toml", {.folders = {}}) == document)) std::abort();
    try {
        use(document);
    } catch (const Error&) {
    }
    return 0;
}
