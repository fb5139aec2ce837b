// Checks beyond the ranges of single keys: counts, order, combinations, missing files.
#include <algorithm>
#include <exception>

#include "engine/error.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/scene_document.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/scene_presets.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

class Checker {
  public:
    /// `added`: the document is an entry of `volumes`.
    Checker(const SceneDocument& document, const std::vector<fs::path>& folders, bool added = false)
        : d_(document), folders_(folders) {
        if (!added && d_.volume.rule != VolumeRule::Add)
            add("volume.rule", "\"{}\" is for a volume beside the first; expected it in an entry of [[volumes]]",
                d_.volume.rule == VolumeRule::Cut ? "cut" : "inside");
        if (d_.volume.rim > 0 && d_.volume.rule != VolumeRule::Inside)
            add("volume.rim", "a rim is where a volume replaces the others; expected volume.rule = \"inside\"");
    }

    std::vector<DocumentProblem> run() {
        check_volume();
        check_iso_values();
        check_materials();
        check_transfer();
        check_lights();
        check_clip();
        check_camera();
        check_movie();
        check_output();
        for (std::size_t i = 0; i < d_.volumes.size(); ++i)
            for (const DocumentProblem& problem : Checker(d_.volumes[i], folders_, true).run())
                problems_.push_back({fmt::format("volumes[{}].{}", i, problem.path), problem.text});
        return std::move(problems_);
    }

  private:
    template <typename... Args>
    void add(std::string path, fmt::format_string<Args...> format, Args&&... args) {
        problems_.push_back({std::move(path), fmt::format(format, std::forward<Args>(args)...)});
    }

    void check_volume() {
        const VolumeSource& v = d_.volume;
        if (v.path.empty()) {
            add("volume.path", "is missing; expected a file, a folder, a pattern of slices or builtin:NAME");
        } else if (is_builtin(v.path)) {
            std::string name = v.path.substr(v.path.find(':') + 1);
            name.resize(std::min(name.find(':'), name.size()));
            const std::vector<std::string> names(analytic_scene_names().begin(), analytic_scene_names().end());
            if (std::find(names.begin(), names.end(), name) == names.end()) {
                const std::string nearest = nearest_name(name, names);
                add("volume.path", "\"{}\": no builtin volume has this name; expected one of: {}{}", v.path,
                    fmt::join(names, ", "), nearest.empty() ? "" : "; did you mean \"builtin:" + nearest + "\"?");
            } else {
                try {
                    builtin_scene(v.path);
                } catch (const Error& error) {
                    add("volume.path", "{}", error.what());
                }
            }
        } else {
            try {
                find_volume(v.path, folders_);
            } catch (const std::exception& error) {
                add("volume.path", "{}", error.what());
            }
        }
        const bool hex = std::all_of(v.checksum.begin(), v.checksum.end(),
                                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
        if (!v.checksum.empty() && (v.checksum.size() != 16 || !hex))
            add("volume.checksum", "\"{}\": expected 16 hexadecimal digits, 0-9 and a-f", v.checksum);
        if (v.crop_low && v.crop_high && glm::any(glm::greaterThanEqual(*v.crop_low, *v.crop_high)))
            add("volume.crop_high", "[{}, {}, {}]: expected more than crop_low along each axis", v.crop_high->x,
                v.crop_high->y, v.crop_high->z);
    }

    void check_iso_values() {
        const auto& iso = d_.iso_values;
        if (iso.size() > kMaxIsoValues) add("iso_values", "{} values: expected at most {}", iso.size(), kMaxIsoValues);
        for (std::size_t i = 1; i < iso.size(); ++i)
            if (!(iso[i] > iso[i - 1]))
                add("iso_values", "{} is not above {} before it; expected ascending values", iso[i], iso[i - 1]);
        const auto& sigmas = d_.iso_sigmas;
        if (!sigmas.empty() && !iso.empty())
            add("iso_sigmas", "is given together with iso_values; expected one of them");
        if (sigmas.size() > kMaxIsoValues)
            add("iso_sigmas", "{} values: expected at most {}", sigmas.size(), kMaxIsoValues);
        for (std::size_t i = 1; i < sigmas.size(); ++i)
            if (!(sigmas[i] > sigmas[i - 1]))
                add("iso_sigmas", "{} is not above {} before it; expected ascending values", sigmas[i], sigmas[i - 1]);
        if (d_.volume.labels.value_or(false) && d_.volume.threshold)
            add("volume.labels", "is given together with volume.threshold; expected one of them");
    }

    /// The preset with this name; adds a problem if there is none.
    std::optional<ScenePreset> preset_at(const std::string& path, const std::string& name) {
        try {
            return scene_preset(name);
        } catch (const std::exception& error) {
            add(path, "{}", error.what());
            return std::nullopt;
        }
    }

    void check_materials() {
        bool all_have_iso = !d_.materials.empty();
        for (std::size_t i = 0; i < d_.materials.size(); ++i) {
            const MaterialChoice& material = d_.materials[i];
            const std::string path = fmt::format("materials[{}].preset", i);
            const auto preset = material.preset.empty() ? std::nullopt : preset_at(path, material.preset);
            if (preset && preset->kind != PresetKind::Material)
                add(path, "\"{}\" is a {}; expected a material", material.preset,
                    preset->is_transfer() ? "transfer function (use transfer_preset)" : "look (use --look)");
            all_have_iso = all_have_iso && preset && !preset->content.iso_values.empty();
        }
        // Without iso_values, they come from presets, the data, or the builtin volume.
        const std::size_t given = d_.materials.size();
        if (given == 0) return;
        if (!d_.iso_values.empty() && given != d_.iso_values.size())
            add("materials", "{} materials for {} iso_values: expected one per iso-value", given, d_.iso_values.size());
        if (!d_.iso_sigmas.empty() && given != d_.iso_sigmas.size())
            add("materials", "{} materials for {} iso_sigmas: expected one per surface", given, d_.iso_sigmas.size());
        const bool open = d_.iso_values.empty() && d_.iso_sigmas.empty() && !all_have_iso && d_.transfer.empty() &&
                          d_.transfer_preset.empty();
        if (open && given != 1 && !is_builtin(d_.volume.path))
            add("materials", "{} materials, but no iso_values: expected iso_values, or a preset with one in each",
                given);
    }

    void check_transfer() {
        if (!d_.transfer_preset.empty()) {
            const auto preset = preset_at("transfer_preset", d_.transfer_preset);
            if (preset && !preset->is_transfer())
                add("transfer_preset", "\"{}\" is a {}; expected a transfer function", d_.transfer_preset,
                    preset->kind == PresetKind::Look ? "look (use --look)" : "material (use materials[].preset)");
            if (!d_.transfer.empty())
                add("transfer_preset", "is given together with [[transfer]]; expected one of them");
        }
        for (std::size_t i = 1; i < d_.transfer.size(); ++i)
            if (!(d_.transfer[i].value > d_.transfer[i - 1].value))
                add(fmt::format("transfer[{}].value", i), "{} is not above {} before it; expected ascending values",
                    d_.transfer[i].value, d_.transfer[i - 1].value);
    }

    void check_lights() {
        std::size_t with_shadows = 0;
        for (std::size_t i = 0; i < d_.lights.size(); ++i) {
            const Light& light = d_.lights[i];
            const std::string path = fmt::format("lights[{}].shadows", i);
            if (light.shadows && light.kind == Light::Kind::Headlight)
                add(path, "true: a headlight casts no visible shadows; expected kind directional or point");
            with_shadows += light.shadows ? 1 : 0;
            if (light.shadows && with_shadows == kMaxShadowLights + 1)
                add(path, "true: expected at most {} lights with shadows", kMaxShadowLights);
        }
    }

    void check_clip() {
        for (const auto& [box, path] :
             {std::pair{d_.keep_box, "effects.clip.keep_box.high"}, {d_.remove_box, "effects.clip.remove_box.high"}})
            if (box && !glm::all(glm::lessThan(box->low, box->high)))
                add(path, "[{}, {}, {}]: expected more than low along each axis", box->high.x, box->high.y,
                    box->high.z);
        const Clip& clip = d_.effects.clip;
        constexpr std::size_t kBeside = kMaxClipPlanes - 6;
        if (d_.keep_box && clip.keep.size() > kBeside)
            add("effects.clip.keep", "{} planes beside keep_box: expected at most {}", clip.keep.size(), kBeside);
        if (d_.remove_box && !clip.remove.empty())
            add("effects.clip.remove_box", "is given together with [[effects.clip.remove]]; expected one of them");
    }

    void check_camera() {
        const CameraChoice& c = d_.camera;
        if (!c.view.empty() && c.eye) add("camera.eye", "is given together with view; expected one of them");
        if (!c.view.empty() && c.direction)
            add("camera.direction", "is given together with view; expected one of them");
        if (c.target && c.direction) add("camera.target", "is given together with direction; expected one of them");
        if (c.target && !c.eye) add("camera.target", "is given without eye; expected both");
        if (c.target && c.eye && *c.target == *c.eye) add("camera.target", "equals the eye; expected another point");
    }

    void check_movie() {
        const MovieChoice& m = d_.movie;
        const int ways = (m.path.empty() ? 0 : 1) + (m.orbit ? 1 : 0) + (m.flight ? 1 : 0);
        if (ways > 1) add("movie", "has more than one of path, orbit and flight; expected one of them");
        if (m.flight && m.flight->points.empty())
            add("movie.flight.points", "is missing; expected at least two points");
        for (std::size_t i = 1; i < m.path.size(); ++i)
            if (!(m.path[i].time > m.path[i - 1].time))
                add(fmt::format("movie.path[{}].time", i), "{} is not above {} before it; expected ascending times",
                    m.path[i].time, m.path[i - 1].time);
        for (std::size_t i = 0; i < m.path.size(); ++i)
            if (m.path[i].eye == m.path[i].target)
                add(fmt::format("movie.path[{}].target", i), "equals the eye; expected another point");
        for (std::size_t i = 0; i < m.animate.size(); ++i)
            check_animation(m.animate[i], fmt::format("movie.animate[{}]", i));
    }

    void check_animation(const AnimationChoice& animation, const std::string& path) {
        if (animation.key.empty()) return add(path + ".key", "is missing; expected a key such as iso_values[0]");
        if (animation.times.size() != animation.values.size() || animation.times.empty())
            return add(path + ".values", "{} values for {} times; expected one per time, at least one",
                       animation.values.size(), animation.times.size());
        for (std::size_t i = 1; i < animation.times.size(); ++i)
            if (!(animation.times[i] > animation.times[i - 1]))
                return add(path + ".times", "{} is not above {} before it; expected ascending times",
                           animation.times[i], animation.times[i - 1]);
        SceneDocument scratch = d_;
        try {
            for (const double value : animation.values)
                animate_number(scratch, animation.key, value);
        } catch (const std::exception& error) {
            add(path + ".key", "{}", error.what());
        }
    }

    void check_output() {
        const OutputChoice& o = d_.output;
        if (!o.file.empty() && !o.file.ends_with(".png") && !o.file.ends_with(".exr"))
            add("output.file", "\"{}\": expected a name that ends in .png or .exr", o.file);
        const std::string_view renderer = name_of(o.renderer);
        const bool several = !std::ranges::all_of(d_.volumes, cuts);
        const bool only_tau = o.renderer == RendererKind::Reference;
        for (const std::string& aov : o.aovs)
            if (o.renderer != RendererKind::Splat && !(only_tau && aov == "tau"))
                add("output.aovs", "\"{}\": renderer {} has {}", aov, renderer,
                    only_tau ? "only the extra output tau" : "no extra outputs");
        if (!o.aovs.empty() && o.compare_plain) add("output.compare_plain", "true: expected no aovs beside it");
        if (!o.aovs.empty() && o.compare_raycast) add("output.compare_raycast", "true: expected no aovs beside it");
        if (o.compare_raycast && o.renderer != RendererKind::Splat)
            add("output.compare_raycast", "true: expected renderer \"splat\"");
        if (o.renderer != RendererKind::Splat && several)
            add("output.renderer", "\"{}\" draws one volume, but the scene has several; expected \"splat\"", renderer);
        if (o.compare_raycast && several)
            add("output.compare_raycast", "true: rays show one volume, but the scene has several volumes");
        if (d_.quality.max_error && several)
            add("quality.max_error", "its model is of one volume, but the scene has several");
        if (o.renderer == RendererKind::Truth && !is_builtin(d_.volume.path) && !d_.volume.path.empty())
            add("output.renderer", "\"truth\" needs the exact scene, which only builtin:NAME volumes have");
        if (o.renderer == RendererKind::Truth && !d_.volumes.empty())
            add("output.renderer", "\"truth\" shows a builtin volume whole, but others cut it");
        if (o.renderer != RendererKind::Splat && d_.quality.max_error)
            add("quality.max_error", "applies to splatting only; it needs output.renderer \"splat\"");
    }

    const SceneDocument& d_;
    const std::vector<fs::path>& folders_;
    std::vector<DocumentProblem> problems_;
};

}  // namespace

std::vector<DocumentProblem> problems_of(const SceneDocument& document, const std::vector<fs::path>& folders) {
    return Checker(document, folders).run();
}

}  // namespace edgesplat
