// The code of a shader after its specialization constants are set and dead code is removed.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/pipelines.h"

namespace edgesplat::test {

/// The module with the constants set and frozen, optimised by SPIRV-Tools for speed. Throws Error on failure.
std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> module, const gpu::Specialization& constants);

/// Number of instructions in function bodies; declarations and names do not count.
std::size_t instruction_count(std::span<const std::uint32_t> module);

/// "FrameParams.saturation": every struct member that an access chain reads. If a struct is loaded as a whole, all its
/// members count.
std::set<std::string> members_read(std::span<const std::uint32_t> module);

}  // namespace edgesplat::test
