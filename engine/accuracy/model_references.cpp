#include "engine/accuracy/model_references.h"

#include "engine/reference/direct_evaluation.h"
#include "engine/reference/interpolated_scene.h"
#include "engine/reference/truth.h"

namespace edgesplat::accuracy {

ModelReferences::ModelReferences(const ReportInput& input, double tolerance, std::filesystem::path folder,
                                 Journal& journal, std::function<bool(double)> progress)
    : input_(input),
      truth_(input.analytic ? *input.analytic
                            : reference::interpolated_scene(*input.volume, RaycastFilter::Cubic, input.scene)),
      tolerance_(tolerance),
      store_(std::move(folder), journal),
      progress_(std::move(progress)) {}

std::string ModelReferences::key(const Settings& model, const std::string& camera) const {
    return "reference|" + camera + "|" + settings_key(model);
}

std::string ModelReferences::truth_key(const std::string& camera) const {
    return "truth|" + camera;
}

const reference::PreparedVolume& ModelReferences::prepared(const Settings& model) {
    const std::string wanted = settings_key(model);
    if (!prepared_ || prepared_key_ != wanted) {
        prepared_.emplace(*input_.volume, input_.scene, model);
        prepared_key_ = wanted;
    }
    return *prepared_;
}

ReferencePicture ModelReferences::evaluate(const Settings& model, const Camera& camera, glm::ivec2 size) {
    const reference::DirectOptions options{tolerance_, progress_};
    auto result =
        reference::direct_evaluation(prepared(model), camera, size.x, size.y, reference::Output::Color, options);
    return {std::move(result.image), result.error_estimate};
}

ReferencePicture ModelReferences::evaluate_truth(const Camera& camera, glm::ivec2 size) {
    const reference::DirectOptions options{tolerance_, progress_};
    auto result = reference::truth(truth_, input_.volume->geometry, input_.scene, camera, size.x, size.y, options);
    return {std::move(result.image), result.error_estimate};
}

nlohmann::ordered_json ModelReferences::make(const Settings& model, const std::string& name, const Camera& camera,
                                             glm::ivec2 size) {
    return store_.make(key(model, name), [&] { return evaluate(model, camera, size); });
}

nlohmann::ordered_json ModelReferences::make_truth(const std::string& name, const Camera& camera, glm::ivec2 size) {
    return store_.make(truth_key(name), [&] { return evaluate_truth(camera, size); });
}

ReferencePicture ModelReferences::get(const Settings& model, const std::string& name, const Camera& camera,
                                      glm::ivec2 size) {
    return store_.get(key(model, name), [&] { return evaluate(model, camera, size); });
}

ReferencePicture ModelReferences::truth(const std::string& name, const Camera& camera, glm::ivec2 size) {
    return store_.get(truth_key(name), [&] { return evaluate_truth(camera, size); });
}

}  // namespace edgesplat::accuracy
