// What pictures are measured against: the truth, or what stands in for it, and the converged evaluation of their own
// model.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "engine/accuracy/picture_store.h"
#include "engine/accuracy/report.h"
#include "engine/reference/reference_renderer.h"

namespace edgesplat::accuracy {

/// Computes and keeps them. Names tell cameras apart; one name must always stand for one camera and size.
class ModelReferences {
  public:
    /// `progress` is called now and then with the share done of a picture; where it returns false, reference::Cancelled
    /// is thrown.
    ModelReferences(const ReportInput& input, double tolerance, std::filesystem::path folder, Journal& journal,
                    std::function<bool(double)> progress);

    // What the journal calls them, what it is to hold, and the pictures themselves.
    std::string key(const Settings& model, const std::string& camera) const;
    std::string truth_key(const std::string& camera) const;
    nlohmann::ordered_json make(const Settings& model, const std::string& name, const Camera& camera, glm::ivec2 size);
    nlohmann::ordered_json make_truth(const std::string& name, const Camera& camera, glm::ivec2 size);
    ReferencePicture get(const Settings& model, const std::string& name, const Camera& camera, glm::ivec2 size);
    ReferencePicture truth(const std::string& name, const Camera& camera, glm::ivec2 size);

    /// Edges of the model, unquantised; kept until another model is asked for.
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
