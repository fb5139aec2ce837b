#include "engine/passes/2_collect_splats.h"

#include "engine/culling/brick_runs.h"

namespace edgesplat::passes {
namespace {

void dispatch_collect(gpu::Commands& commands, const CollectSplats& in, bool write) {
    const std::uint64_t runs = in.bricks > 0 ? std::uint64_t{in.bricks} * shader::BRICK : collect_runs(in.core_size);
    commands.dispatch("2_collect_splats.comp", collect_constants(in), write ? 1U : 0U, commands.groups_for(runs, 64));
    commands.barrier();
}

}  // namespace

gpu::Specialization collect_constants(const CollectSplats& in) {
    return {{shader::SPEC_ISO_COUNT, in.iso_count},     {shader::SPEC_EDGES, in.edges ? 1 : 0},
            {shader::SPEC_BURIED, in.buried ? 1 : 0},   {shader::SPEC_CLIP_KEEP, in.clip.keep},
            {shader::SPEC_CLIP_REMOVE, in.clip.remove}, {shader::SPEC_TRANSFER, in.transfer ? 1 : 0},
            {shader::SPEC_LABELS, in.labels},           {shader::SPEC_SURFACES, in.surfaces ? 1 : 0}};
}

gpu::Specialization finish_constants(const CollectSplats& in) {
    return {{shader::SPEC_ISO_COUNT, in.iso_count},
            {shader::SPEC_ESTIMATOR, static_cast<std::uint32_t>(in.estimator)},
            {shader::SPEC_FACES, in.faces ? 1 : 0},
            {shader::SPEC_SURFACES, in.surfaces ? 1 : 0},
            {shader::SPEC_TWO_VALUES, in.two_values ? 1 : 0}};
}

std::uint64_t collect_runs(const glm::ivec3& core_size) {
    return BrickRuns(core_size).count();
}

void count_splats(gpu::Commands& commands, const CollectSplats& in) {
    dispatch_collect(commands, in, false);
}

void write_splats(gpu::Commands& commands, const CollectSplats& in) {
    dispatch_collect(commands, in, true);
}

void finish_splats(gpu::Commands& commands, const CollectSplats& in, std::uint64_t count) {
    if (!in.edges || count == 0) return;
    commands.dispatch("2a_finish_splats.comp", finish_constants(in), 0, commands.groups_for(count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes
