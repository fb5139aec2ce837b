#include "engine/reference/splat_cloud.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/transfer_function.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

SplatCloud::SplatCloud(const PreparedVolume& prepared, const View& view, const Footprints& footprints)
    : field_(prepared.field()), splat_of_(field_.values.size(), -1), low_(INFINITY), high_(-INFINITY) {
    const Scene& scene = prepared.scene();
    const auto& transfer = prepared.scaled_scene().transfer;
    const auto add = [&](std::size_t at, int m, const VoxelEdge& edge, const double* classified) {
        SplatRecord record{static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(m), edge};
        record.classified = transfer.empty() ? labelled(field_, prepared.scaled_scene(), scene, at, m)
                                             : transfer_at(transfer, *classified);
        record.weight = border_weight(field_, prepared.scaled_scene(), prepared.settings(), field_.voxel(at), m);
        const double extinction = record.extinction(scene);
        const bool nothing = edge.has_edge && edge.D <= -kKernelRadius;
        if (!(extinction > 0) || nothing) return;
        ModelSplat splat;
        splat.center = glm::dvec3(field_.voxel(at));
        splat.reach = footprints.reach(edge);
        splat.extinction = extinction;
        splat.emission = extinction * payload_of(record, field_, scene, view, prepared.settings(), Payload::Color);
        splat.material = record.material;
        splat.edge = &edge;
        splat.record = record;
        if (splat_of_[at] < 0) splat_of_[at] = static_cast<std::int32_t>(splats_.size());
        splats_.push_back(splat);
        reach_ = std::max(reach_, splat.reach);
        low_ = glm::min(low_, splat.center - splat.reach);
        high_ = glm::max(high_, splat.center + splat.reach);
    };
    for (std::size_t at = 0; at < field_.values.size(); ++at) {
        const int m = prepared.scaled_scene().material(static_cast<double>(field_.values[at]));
        if (field_.has_data(at))
            add(at, m, prepared.edges()[at], transfer.empty() ? nullptr : &prepared.classified()[at]);
        for (const CarriedEdge& c : prepared.carried_by(at))
            add(at, c.material, c.edge, &c.value);
    }
    measure_emptiness();
}

void SplatCloud::measure_emptiness() {
    clearance_.assign(splat_of_.size(), 255);
    for (std::size_t at = 0; at < splat_of_.size(); ++at)
        if (splat_of_[at] >= 0) clearance_[at] = 0;
    // Two sweeps, over the preceding and over the following neighbours, give the exact Chebyshev distance.
    const auto take = [&](std::size_t at, bool before) {
        const glm::ivec3 i = field_.voxel(at);
        int best = clearance_[at];
        for (int n = 0; n < 13; ++n) {
            glm::ivec3 o(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            if (!before) o = -o;
            const glm::ivec3 j = i + o;
            if (field_.clamped(j) == j) best = std::min(best, clearance_[field_.offset(j)] + 1);
        }
        clearance_[at] = static_cast<std::uint8_t>(best);
    };
    for (std::size_t at = 0; at < clearance_.size(); ++at)
        take(at, true);
    for (std::size_t at = clearance_.size(); at-- > 0;)
        take(at, false);
}

bool SplatCloud::clip(const glm::dvec3& origin, const glm::dvec3& u, double& begin, double& end) const {
    if (splats_.empty()) return false;
    begin = 0;
    end = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        if (u[axis] == 0) {
            if (!(origin[axis] >= low_[axis] && origin[axis] <= high_[axis])) return false;
            continue;
        }
        const double a = (low_[axis] - origin[axis]) / u[axis];
        const double b = (high_[axis] - origin[axis]) / u[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin < end;
}

double SplatCloud::empty_distance(const glm::dvec3& p) const {
    const glm::dvec3 nearest = glm::clamp(glm::round(p), glm::dvec3(0), glm::dvec3(field_.dims - 1));
    const glm::dvec3 off = glm::abs(p - nearest);
    return clearance_[field_.offset(glm::ivec3(nearest))] - std::max({off.x, off.y, off.z}) - reach_;
}

void SplatCloud::gather(const glm::dvec3& a, const glm::dvec3& b, std::vector<const ModelSplat*>& found) const {
    found.clear();
    const glm::dvec3 along = b - a;
    const double length2 = glm::dot(along, along);
    const glm::dvec3 first = glm::min(a, b);
    const glm::dvec3 last = glm::max(a, b);
    const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil(first - reach_)), glm::ivec3(0));
    const glm::ivec3 high = glm::min(glm::ivec3(glm::floor(last + reach_)), field_.dims - 1);
    for (int k = low.z; k <= high.z; ++k) {
        const double dz = std::max({first.z - k, k - last.z, 0.0});
        for (int j = low.y; j <= high.y; ++j) {
            const double dy = std::max({first.y - j, j - last.y, 0.0});
            if (dy * dy + dz * dz >= reach_ * reach_) continue;
            const std::size_t row = field_.offset({0, j, k});
            for (int i = low.x; i <= high.x; ++i) {
                const std::size_t at = row + static_cast<std::size_t>(i);
                if (splat_of_[at] < 0) continue;
                const glm::dvec3 v = glm::dvec3(i, j, k) - a;
                const double t = length2 > 0 ? std::clamp(glm::dot(v, along) / length2, 0.0, 1.0) : 0.0;
                const glm::dvec3 d = v - t * along;
                for (auto id = static_cast<std::size_t>(splat_of_[at]);
                     id < splats_.size() && splats_[id].record.voxel == at; ++id)
                    if (glm::dot(d, d) < splats_[id].reach * splats_[id].reach) found.push_back(&splats_[id]);
            }
        }
    }
}

}  // namespace edgesplat::reference
