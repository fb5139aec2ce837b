// What is left of a shader once its specialization constants are set and what they rule out is gone.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/pipelines.h"

namespace edgesplat::test {

/// The module with the constants set and frozen, and optimised by SPIRV-Tools for speed. Throws Error if that fails.
std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> module, const gpu::Specialization& constants);

/// Instructions of functions' bodies; declarations and names do not count.
std::size_t instruction_count(std::span<const std::uint32_t> module);

/// "FrameParams.saturation": every member of a struct that an access chain goes through. A struct that is loaded whole
/// counts with all its members.
std::set<std::string> members_read(std::span<const std::uint32_t> module);

}  // namespace edgesplat::test
