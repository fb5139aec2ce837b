// Provides the pictures that errors are measured against: the truth, or its substitute, and the converged picture of
// each model.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "engine/accuracy/picture_store.h"
#include "engine/accuracy/report.h"
#include "engine/reference/reference_renderer.h"

namespace edgesplat::accuracy {

/// Computes and keeps these pictures. A name identifies a camera; one name must always mean the same camera and size.
class ModelReferences {
  public:
    /// `progress` is called repeatedly with the share of a picture that is done; if it returns false,
    /// reference::Cancelled is thrown.
    ModelReferences(const ReportInput& input, double tolerance, std::filesystem::path folder, Journal& journal,
                    std::function<bool(double)> progress);

    // Keys in the journal, entries of the journal, and the pictures themselves.
    std::string key(const Settings& model, const std::string& camera) const;
    std::string truth_key(const std::string& camera) const;
    nlohmann::ordered_json make(const Settings& model, const std::string& name, const Camera& camera, glm::ivec2 size);
    nlohmann::ordered_json make_truth(const std::string& name, const Camera& camera, glm::ivec2 size);
    ReferencePicture get(const Settings& model, const std::string& name, const Camera& camera, glm::ivec2 size);
    ReferencePicture truth(const std::string& name, const Camera& camera, glm::ivec2 size);

    /// Edges of the model, unquantised; kept until another model is requested.
    const reference::PreparedVolume& prepared(const Settings& model);

  private:
    ReferencePicture evaluate(const Settings& model, const Camera& camera, glm::ivec2 size);
    ReferencePicture evaluate_truth(const Camera& camera, glm::ivec2 size);

    const ReportInput& input_;
    AnalyticScene truth_;  ///< the exact scene where it is known, else the spline through the samples
    double tolerance_;
    PictureStore store_;
    std::function<bool(double)> progress_;
    std::string prepared_key_;
    std::optional<reference::PreparedVolume> prepared_;
};

}  // namespace edgesplat::accuracy
