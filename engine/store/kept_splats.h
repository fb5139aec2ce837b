// Splat lists that are kept in files between runs, so that surfaces are not found again. DeviceChoice::keep_splats.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/plan/device_session.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// All that a volume's splat lists depend on, as bytes: samples and labels by their checksum, the plan, the passes'
/// shaders, the device and its driver. Lists with equal keys are equal bit for bit.
std::string splats_key(const gpu::Device& device, const Volume& volume, const CollectionPlan& plan);

/// Splat lists as a file keeps them.
struct KeptSplats {
    std::uint64_t splats = 0, with_edge = 0, with_crease = 0, traced = 0;
    glm::ivec3 low{0}, high{0};  ///< SplatLists::box_low, box_high
    std::uint32_t border = 0;    ///< faces_with_matter
    std::vector<SplatBrick> bricks;
    std::vector<std::vector<std::uint8_t>> lists;  ///< of each of splat_list_rows(); empty: the plan has none
};

std::vector<std::uint8_t> pack(const KeptSplats& kept, const std::string& key);
/// nullopt for other bytes than those of pack() with this key, and for lists that do not fit the plan.
std::optional<KeptSplats> unpack_splats(const std::vector<std::uint8_t>& bytes, const std::string& key,
                                        const CollectionPlan& plan);

/// The lists in `folder` with this key; nullopt if there are none.
std::optional<KeptSplats> read_splats(const std::filesystem::path& folder, const std::string& key,
                                      const CollectionPlan& plan);
/// Keeps the lists in `folder`. The files read longest ago are removed so that all have at most `most_bytes`. Returns
/// whether the file was written.
bool keep_splats(const std::filesystem::path& folder, const std::string& key, const KeptSplats& kept,
                 std::uint64_t most_bytes = std::uint64_t{4} << 30U);

}  // namespace edgesplat
