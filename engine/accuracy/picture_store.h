// Pictures that took long to compute, kept as files beside the journal.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/accuracy/journal.h"
#include "engine/image/image.h"

namespace edgesplat::accuracy {

/// A picture and how far it may be from what it stands for.
struct ReferencePicture {
    Image image;
    double error_estimate = 0;  ///< largest over the pixels, of full scale
};

/// A folder of pictures in float32, bit for bit, and what the journal says about each.
class PictureStore {
  public:
    PictureStore(std::filesystem::path folder, Journal& journal) : folder_(std::move(folder)), journal_(journal) {}

    /// The picture of a key: from its file if that is whole, else computed, written and entered into the journal.
    ReferencePicture get(const std::string& key, const std::function<ReferencePicture()>& compute);

    /// Computes and writes it; what the journal is to hold.
    nlohmann::ordered_json make(const std::string& key, const std::function<ReferencePicture()>& compute) const;

  private:
    std::filesystem::path file_of(const std::string& key) const;

    std::filesystem::path folder_;
    Journal& journal_;
};

}  // namespace edgesplat::accuracy
