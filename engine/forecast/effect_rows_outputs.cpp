// Extra outputs: each is the frame drawn once more with another quantity in place of colour.
#include "engine/forecast/effect_rows.h"
#include "shaders/shared/limits.h"

namespace edgesplat {

std::vector<Effect> output_effects() {
    std::vector<Effect> rows;
    const std::vector<EffectConstant> payload{{shader::SPEC_PAYLOAD, "SPEC_PAYLOAD"}};
    rows.push_back(
        {.name = "output tau",
         .help = "optical depth along each pixel's ray; no voxel is dropped for it",
         .call = "output.aovs holds \"tau\"; --aov tau",
         .reason = [](const FrameRequest& r) -> std::string { return r.outputs.tau ? "it is asked for" : ""; },
         .turn_on = [](FrameRequest& r) { r.outputs.tau = true; },
         .constants = payload});
    rows.push_back(
        {.name = "output depth",
         .help = "mean distance along the view axis",
         .call = "output.aovs holds \"depth\"; --aov depth",
         .reason = [](const FrameRequest& r) -> std::string { return r.outputs.depth ? "it is asked for" : ""; },
         .turn_on = [](FrameRequest& r) { r.outputs.depth = true; },
         .constants = payload});
    rows.push_back(
        {.name = "output normal",
         .help = "mean world normal of what is seen",
         .call = "output.aovs holds \"normal\"; --aov normal",
         .reason = [](const FrameRequest& r) -> std::string { return r.outputs.normal ? "it is asked for" : ""; },
         .turn_on = [](FrameRequest& r) { r.outputs.normal = true; },
         .constants = payload});
    rows.push_back(
        {.name = "output distance",
         .help = "mean signed distance of the seen voxels to their edge",
         .call = "output.aovs holds \"distance\"; --aov distance",
         .reason = [](const FrameRequest& r) -> std::string { return r.outputs.distance ? "it is asked for" : ""; },
         .turn_on = [](FrameRequest& r) { r.outputs.distance = true; },
         .constants = payload});
    return rows;
}

}  // namespace edgesplat
