#include "tests/passes/spirv_module.h"

#include <fmt/format.h>

#include <map>
#include <spirv-tools/optimizer.hpp>
#include <unordered_map>

#include "engine/error.h"

namespace edgesplat::test {
namespace {

// Opcodes of the SPIR-V specification, section 3.52.
enum Op : std::uint32_t {
    kName = 5,
    kMemberName = 6,
    kTypeVector = 23,
    kTypeMatrix = 24,
    kTypeArray = 28,
    kTypeRuntimeArray = 29,
    kTypeStruct = 30,
    kTypePointer = 32,
    kConstant = 43,
    kFunction = 54,
    kFunctionParameter = 55,
    kFunctionEnd = 56,
    kVariable = 59,
    kLoad = 61,
    kAccessChain = 65,
    kInBoundsAccessChain = 66,
    kConvertUToPtr = 120,
    kBitcast = 124,
    kLabel = 248,
    kPhi = 245,
    kSelect = 169,
};

struct Instruction {
    std::uint32_t op;
    std::span<const std::uint32_t> words;  ///< the first contains length and opcode
};

std::vector<Instruction> instructions_of(std::span<const std::uint32_t> module) {
    std::vector<Instruction> found;
    for (std::size_t at = 5; at < module.size();) {
        const std::uint32_t length = module[at] >> 16U;
        if (length == 0 || at + length > module.size()) fail("SPIR-V: an instruction of {} words at {}", length, at);
        found.push_back({module[at] & 0xffffU, module.subspan(at, length)});
        at += length;
    }
    return found;
}

std::string text_of(std::span<const std::uint32_t> words) {
    return {reinterpret_cast<const char*>(words.data())};  // NOLINT: strings are null-terminated bytes
}

/// Types, names and constants of a module.
struct Tables {
    std::unordered_map<std::uint32_t, Instruction> types;
    std::unordered_map<std::uint32_t, std::string> names;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> member_names;
    std::unordered_map<std::uint32_t, std::uint32_t> constants, type_of;

    explicit Tables(const std::vector<Instruction>& instructions) {
        for (const Instruction& i : instructions) {
            const auto& w = i.words;
            if (i.op == kName) names[w[1]] = text_of(w.subspan(2));
            if (i.op == kMemberName) member_names[{w[1], w[2]}] = text_of(w.subspan(3));
            if (i.op == kConstant) constants[w[2]] = w[3];
            const bool type = (i.op >= kTypeVector && i.op <= kTypePointer);
            if (type) types.insert_or_assign(w[1], i);
            const bool pointer_made = i.op == kVariable || i.op == kFunctionParameter || i.op == kAccessChain ||
                                      i.op == kInBoundsAccessChain || i.op == kLoad || i.op == kConvertUToPtr ||
                                      i.op == kBitcast || i.op == kPhi || i.op == kSelect;
            if (pointer_made) type_of[w[2]] = w[1];
        }
    }

    std::string member(std::uint32_t structure, std::uint32_t index) const {
        const auto owner = names.find(structure);
        const auto name = member_names.find({structure, index});
        return fmt::format("{}.{}", owner == names.end() ? "?" : owner->second,
                           name == member_names.end() ? std::to_string(index) : name->second);
    }

    /// Adds all members of a type that is read as a whole.
    void add_whole(std::uint32_t type, std::set<std::string>& found) const {
        const auto at = types.find(type);
        if (at == types.end()) return;
        const auto& w = at->second.words;
        if (at->second.op == kTypeStruct) {
            for (std::uint32_t m = 0; m + 2 < w.size(); ++m) {
                found.insert(member(type, m));
                add_whole(w[m + 2], found);
            }
        }
        if (at->second.op == kTypeArray || at->second.op == kTypeRuntimeArray) add_whole(w[2], found);
    }
};

}  // namespace

std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> module, const gpu::Specialization& constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (const auto& [id, value] : constants)
        values[id] = {value};
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    std::string complaints;
    optimizer.SetMessageConsumer([&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR) complaints += std::string(text) + "; ";
    });
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPerformancePasses();
    std::vector<std::uint32_t> out;
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);  // the validation layer does this
    if (!optimizer.Run(module.data(), module.size(), &out, options)) fail("SPIR-V: {}", complaints);
    return out;
}

std::size_t instruction_count(std::span<const std::uint32_t> module) {
    bool inside = false;
    std::size_t count = 0;
    for (const Instruction& i : instructions_of(module)) {
        if (i.op == kFunction) inside = true;
        if (inside && i.op != kLabel) ++count;
        if (i.op == kFunctionEnd) inside = false;
    }
    return count;
}

std::set<std::string> members_read(std::span<const std::uint32_t> module) {
    const auto instructions = instructions_of(module);
    const Tables tables(instructions);
    std::set<std::string> found;
    for (const Instruction& i : instructions) {
        const auto& w = i.words;
        if (i.op == kLoad) tables.add_whole(w[1], found);
        if (i.op != kAccessChain && i.op != kInBoundsAccessChain) continue;
        const auto base = tables.type_of.find(w[3]);
        if (base == tables.type_of.end()) fail("SPIR-V: an access chain from {}, of no known type", w[3]);
        std::uint32_t type = tables.types.at(base->second).words[3];
        for (std::size_t at = 4; at < w.size(); ++at) {
            const Instruction& aggregate = tables.types.at(type);
            if (aggregate.op == kTypeStruct) {
                const std::uint32_t index = tables.constants.at(w[at]);
                found.insert(tables.member(type, index));
                type = aggregate.words[index + 2];
            } else {
                type = aggregate.words[2];  // of an array, a vector or a matrix
            }
        }
    }
    return found;
}

}  // namespace edgesplat::test
