#include "engine/viewer/keeping.h"

#include <array>

#include "engine/error.h"
#include "engine/image/image_file.h"
#include "engine/scene/scene_file.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/load_volume.h"

namespace edgesplat::viewer {
namespace fs = std::filesystem;

void save_scene(SceneDocument document, const Volume& volume, const fs::path& path) {
    constexpr std::array<std::string_view, 1> kExtensions{".toml"};
    check_output_path(path, kExtensions);
    std::string& source = document.volume.path;
    if (!is_builtin(source) && !fs::path(source).is_absolute()) {
        std::error_code error;
        const fs::path folder = fs::absolute(path, error).parent_path();
        if (fs::exists(split_inner(volume.name).file, error))
            source = fs::proximate(fs::absolute(volume.name), folder).string();
    }
    for (SceneDocument& entry : document.volumes) {
        const fs::path beside = fs::proximate(entry.volume.path, fs::absolute(path).parent_path());
        // Files below the scene's folder move with it.
        if (!is_builtin(entry.volume.path) && *beside.begin() != "..") entry.volume.path = beside.string();
    }
    check_path_is_text(document);
    document.output.file.clear();
    const FileContent content{path, scene_text(document)};
    write_files({&content, 1});
}

void save_picture(const PictureJob& order) {
    constexpr std::array<std::string_view, 2> kExtensions{".png", ".exr"};
    check_output_path(order.path, kExtensions);
    const Scene scene = resolve_scene(order.document, *order.volume);
    const Camera camera = resolve_camera(order.document, *order.volume, scene);
    const Settings& settings = order.document.quality.settings;
    const glm::ivec2 size = order.document.output.size;
    Renderer renderer(order.device);
    renderer.set_volume(order.volume);
    const RenderResult result = renderer.render(scene, camera, settings, size.x, size.y);
    const ImageMetadata metadata{{"Software", order.program},
                                 {"edgesplat:volume", order.document.volume.path},
                                 {"edgesplat:checksum", fmt::format("{:016x}", order.volume->checksum)},
                                 {"edgesplat:device", result.stats.device.name},
                                 {"edgesplat:scene", scene_text(order.document)}};
    FileContent content{order.path, {}};
    if (is_png_path(order.path)) {
        content.bytes = encode_png(without_alpha(result.color), metadata);
    } else {
        const ImageLayer layer{&result.color, {"R", "G", "B", "A"}};
        content.bytes = encode_exr({&layer, 1}, metadata);
    }
    write_files({&content, 1});
}

fs::path free_path(const fs::path& folder, const std::string& stem, const std::string& extension,
                   const std::function<bool(const fs::path&)>& taken) {
    for (int number = 1;; ++number) {
        fs::path path = folder / fmt::format("{}-{}{}", stem, number, extension);
        std::error_code error;
        if (!fs::exists(path, error) && !(taken && taken(path))) return path;
    }
}

}  // namespace edgesplat::viewer
