// Keeps pictures that take long to compute as files beside the journal.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/accuracy/journal.h"
#include "engine/image/image.h"

namespace edgesplat::accuracy {

/// A picture and its largest possible error.
struct ReferencePicture {
    Image image;
    double error_estimate = 0;  ///< largest over the pixels, of full scale
};

/// A folder of float32 pictures, exact to the bit, with their entries in the journal.
class PictureStore {
  public:
    PictureStore(std::filesystem::path folder, Journal& journal) : folder_(std::move(folder)), journal_(journal) {}

    /// The picture of a key: read from its file if that is intact, else computed, written and entered into the journal.
    ReferencePicture get(const std::string& key, const std::function<ReferencePicture()>& compute);

    /// Computes and writes the picture; returns its entry for the journal.
    nlohmann::ordered_json make(const std::string& key, const std::function<ReferencePicture()>& compute) const;

  private:
    std::filesystem::path file_of(const std::string& key) const;

    std::filesystem::path folder_;
    Journal& journal_;
};

}  // namespace edgesplat::accuracy
