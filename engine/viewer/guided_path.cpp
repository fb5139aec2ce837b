#include "engine/viewer/guided_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/error.h"

namespace edgesplat::viewer {
namespace {

constexpr double kMaxRoom = 16;     // voxels: more room does not lower the cost
constexpr double kLeastRoom = 0.3;  // voxels: added to all rooms to limit the cost of a step
constexpr int kEndReach = 5;        // voxels by which an end may be moved
constexpr int kRounds = 24;         // of smoothing
constexpr std::size_t kMostKeys = 256;

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool free_between(const Walls& walls, const glm::dvec3& a, const glm::dvec3& b) {
    const int parts = std::clamp(static_cast<int>(std::ceil(4 * glm::length(b - a) / walls.voxel())), 1, 4096);
    for (int k = 1; k < parts; ++k)
        if (walls.solid(glm::mix(a, b, static_cast<double>(k) / parts))) return false;
    return true;
}

/// Queue of nodes by cost, in buckets as wide as the cheapest step. Within a bucket no node can make another cheaper,
/// so their order does not matter (Dial 1969, Dinitz 1978). Its costs differ by at most the most expensive step.
class BucketQueue {
  public:
    BucketQueue(float cheapest, float dearest)
        : width_(cheapest), buckets_(static_cast<std::size_t>(dearest / cheapest) + 3) {}

    bool empty() const { return count_ == 0; }
    /// A lower bound of the costs in the queue.
    float least() const { return static_cast<float>(current_) * width_; }
    void push(float cost, std::size_t node) {
        const auto at = std::max(static_cast<std::size_t>(cost / width_), current_);
        buckets_[at % buckets_.size()].push_back(static_cast<std::uint32_t>(node));
        ++count_;
    }
    std::size_t pop() {
        while (buckets_[current_ % buckets_.size()].empty())
            ++current_;
        auto& bucket = buckets_[current_ % buckets_.size()];
        const std::size_t node = bucket.back();
        bucket.pop_back();
        --count_;
        return node;
    }

  private:
    float width_;
    std::vector<std::vector<std::uint32_t>> buckets_;
    std::size_t current_ = 0, count_ = 0;
};

/// The voxels of the walls' grid as a graph.
class Grid {
  public:
    explicit Grid(const Walls& walls) : walls_(walls), dims_(walls.dims()) {
        const glm::u64vec3 n(dims_);
        weights_.resize(n.x * n.y * n.z);
        const double voxel = walls.voxel();
        std::size_t at = 0;
        glm::ivec3 i;
        for (i.z = 0; i.z < dims_.z; ++i.z)
            for (i.y = 0; i.y < dims_.y; ++i.y)
                for (i.x = 0; i.x < dims_.x; ++i.x)
                    weights_[at++] = weight(walls.distance_at(i) / voxel);
        for (int k = 0; k < 27; ++k) {
            const glm::ivec3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (step == glm::ivec3(0)) continue;
            const auto offset = (static_cast<std::int64_t>(step.z) * dims_.y + step.y) * dims_.x + step.x;
            const double length = glm::length(walls.geometry().index_to_world_axes * glm::dvec3(step));
            steps_.push_back({step, offset, static_cast<float>(length)});
        }
    }

    glm::dvec3 world(std::size_t node) const { return walls_.geometry().to_world(glm::dvec3(voxel(node))); }

    /// The node where a path to a place enters the grid: the nearest free voxel, and from a free place one in straight
    /// sight.
    std::optional<std::size_t> entrance(const glm::dvec3& place) const {
        const VolumeGeometry& g = walls_.geometry();
        const glm::dvec3 index = glm::clamp(g.to_index(place), glm::dvec3(0), glm::dvec3(dims_ - 1));
        const glm::dvec3 base = g.to_world(index);
        const double reach = kEndReach * walls_.voxel();
        const glm::ivec3 span(glm::ceil(reach / g.spacing()) + 1.0);
        const glm::ivec3 low = glm::max(glm::ivec3(glm::round(index)) - span, glm::ivec3(0));
        const glm::ivec3 high = glm::min(glm::ivec3(glm::round(index)) + span, dims_ - 1);
        std::vector<std::pair<double, std::size_t>> near;
        glm::ivec3 i;
        for (i.z = low.z; i.z <= high.z; ++i.z)
            for (i.y = low.y; i.y <= high.y; ++i.y)
                for (i.x = low.x; i.x <= high.x; ++i.x) {
                    const double apart = glm::length(g.to_world(glm::dvec3(i)) - base);
                    // The voxel that contains the place counts, however wide voxels are along an axis.
                    if (apart > reach && i != glm::ivec3(glm::round(index))) continue;
                    if (weights_[node(i)] > 0) near.emplace_back(apart, node(i));
                }
        std::sort(near.begin(), near.end());
        const bool inside = walls_.solid(place);
        for (const auto& [apart, candidate] : near)
            if (inside || free_between(walls_, place, world(candidate))) return candidate;
        return std::nullopt;
    }

    /// Nodes of the cheapest path, both ends included; empty if there is none. Dijkstra's search alternates between
    /// both ends until they meet: if a cavity is open, only its small side is searched and not all the air around it.
    std::vector<std::size_t> way(std::size_t from, std::size_t to) const {
        const auto [shortest, longest] = std::minmax_element(
            steps_.begin(), steps_.end(), [](const Step& a, const Step& b) { return a.length < b.length; });
        const BucketQueue none(shortest->length * weight(kMaxRoom), longest->length * kDearest);
        Search forward(weights_.size(), from, none), backward(weights_.size(), to, none);
        float best = from == to ? 0 : kFar;
        std::size_t meeting = from;
        while (!forward.open.empty() && !backward.open.empty() && forward.open.least() + backward.open.least() < best) {
            expand(forward, backward, best, meeting);
            if (!backward.open.empty()) expand(backward, forward, best, meeting);
        }
        if (!(best < kFar)) return {};
        std::vector<std::size_t> nodes = chain(forward, meeting);
        std::reverse(nodes.begin(), nodes.end());
        const std::vector<std::size_t> rest = chain(backward, meeting);
        nodes.insert(nodes.end(), rest.begin() + 1, rest.end());
        return nodes;
    }

  private:
    struct Step {
        glm::ivec3 step;
        std::int64_t offset;
        float length;  ///< mm
    };
    static constexpr float kFar = std::numeric_limits<float>::infinity();
    static constexpr std::uint8_t kStart = 255;
    static constexpr float kDearest = 1 / (kLeastRoom * kLeastRoom);  ///< per mm

    /// State of the search from one end.
    struct Search {
        std::vector<float> cost;
        std::vector<std::uint8_t> by;  ///< the step that led to a node
        std::vector<bool> done;
        BucketQueue open;

        Search(std::size_t nodes, std::size_t start, const BucketQueue& none)
            : cost(nodes, kFar), by(nodes, kStart), done(nodes), open(none) {
            cost[start] = 0;
            open.push(0, start);
        }
    };

    /// Expands the cheapest node of a search; updates where the two searches meet.
    void expand(Search& search, const Search& other, float& best, std::size_t& meeting) const {
        const std::size_t at = search.open.pop();
        if (search.done[at]) return;
        search.done[at] = true;
        const glm::ivec3 here = voxel(at);
        const bool inner = glm::all(glm::greaterThan(here, glm::ivec3(0))) && glm::all(glm::lessThan(here, dims_ - 1));
        const float cost = search.cost[at], weight = weights_[at];
        for (std::size_t k = 0; k < steps_.size(); ++k) {
            const auto& [step, offset, length] = steps_[k];
            if (!inner && (glm::any(glm::lessThan(here + step, glm::ivec3(0))) ||
                           glm::any(glm::greaterThanEqual(here + step, dims_))))
                continue;
            const auto next = static_cast<std::size_t>(static_cast<std::int64_t>(at) + offset);
            const float there = weights_[next], sum = cost + length * (weight + there) / 2;
            if (!(there > 0) || !(sum < search.cost[next]) || !passable(at, next, length)) continue;
            search.cost[next] = sum;
            search.by[next] = static_cast<std::uint8_t>(k);
            search.open.push(sum, next);
            if (!(sum + other.cost[next] < best)) continue;
            best = sum + other.cost[next];
            meeting = next;
        }
    }

    /// From a node back to the start of its search.
    std::vector<std::size_t> chain(const Search& search, std::size_t at) const {
        std::vector<std::size_t> nodes{at};
        for (std::uint8_t k = search.by[at]; k != kStart; k = search.by[nodes.back()])
            nodes.push_back(static_cast<std::size_t>(static_cast<std::int64_t>(nodes.back()) - steps_[k].offset));
        return nodes;
    }

    /// 1 / room^2, per mm of path; 0 without room.
    static float weight(double room) {
        if (!(room > 0)) return 0;
        const double counted = std::min(room, kMaxRoom) + kLeastRoom;
        return static_cast<float>(1 / (counted * counted));
    }

    /// Whether a step is free: walls may be thinner than the grid, or cross between its nodes.
    bool passable(std::size_t a, std::size_t b, float length) const {
        const auto room = [&](std::size_t at) { return 1 / std::sqrt(weights_[at]) - static_cast<float>(kLeastRoom); };
        if ((room(a) + room(b)) * static_cast<float>(walls_.voxel()) > 1.2F * length) return true;
        return free_between(walls_, world(a), world(b));
    }

    std::size_t node(const glm::ivec3& i) const {
        return (static_cast<std::size_t>(i.z) * static_cast<std::size_t>(dims_.y) + static_cast<std::size_t>(i.y)) *
                   static_cast<std::size_t>(dims_.x) +
               static_cast<std::size_t>(i.x);
    }
    glm::ivec3 voxel(std::size_t node) const {
        const auto at = static_cast<std::uint32_t>(node);  // walls have fewer voxels than 2^32
        const glm::uvec3 n(dims_);
        return {at % n.x, at / n.x % n.y, at / (n.x * n.y)};
    }

    const Walls& walls_;
    glm::ivec3 dims_;
    std::vector<float> weights_;
    std::vector<Step> steps_;
};

double length_of(const std::vector<glm::dvec3>& points) {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        length += glm::length(points[i] - points[i - 1]);
    return length;
}

/// The same polyline, divided into `parts` equal lengths.
std::vector<glm::dvec3> evenly(const std::vector<glm::dvec3>& points, std::size_t parts) {
    const double part = length_of(points) / static_cast<double>(parts);
    std::vector<glm::dvec3> out{points.front()};
    double before = 0;
    std::size_t i = 1;
    while (out.size() < parts) {
        const double wanted = static_cast<double>(out.size()) * part;
        double side = glm::length(points[i] - points[i - 1]);
        while (i + 1 < points.size() && before + side < wanted) {
            before += side;
            ++i;
            side = glm::length(points[i] - points[i - 1]);
        }
        out.push_back(glm::mix(points[i - 1], points[i], side > 0 ? std::min((wanted - before) / side, 1.0) : 1.0));
    }
    out.push_back(points.back());
    return out;
}

std::size_t parts_of(const std::vector<glm::dvec3>& points, double voxel) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(length_of(points) / voxel)));
}

/// Alternately straightens the grid's steps and moves points towards the middle; the ends stay.
void smooth(std::vector<glm::dvec3>& points, const Walls& walls) {
    const double voxel = walls.voxel(), most = kMaxRoom * voxel;
    std::vector<double> room;
    for (const glm::dvec3& p : points)
        room.push_back(walls.distance(p));
    const auto accept = [&](std::size_t i, const glm::dvec3& p, double least) {
        const double there = walls.distance(p);
        if (!(there >= least)) return;
        if (there < voxel && !(free_between(walls, points[i - 1], p) && free_between(walls, p, points[i + 1]))) return;
        points[i] = p;
        room[i] = there;
    };
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 1; i + 1 < points.size(); ++i)
            accept(i, points[i] + ((points[i - 1] + points[i + 1]) / 2.0 - points[i]) * 0.5,
                   std::max(0.8 * std::min(room[i], most), std::min(room[i], 0.4 * voxel)));
        for (std::size_t i = 1; i + 1 < points.size(); ++i) {
            if (room[i] >= most) continue;
            const glm::dvec3 along = glm::normalize(points[i + 1] - points[i - 1]);
            glm::dvec3 out = walls.away(points[i]);
            out -= along * glm::dot(along, out);
            if (glm::length(out) > 0.1) accept(i, points[i] + out * (0.1 * voxel), room[i] + 1e-6 * voxel);
        }
    }
}

}  // namespace

glm::dvec3 GuidedPath::at(double millimetres) const {
    const std::size_t last = points.size() - 1;
    const double place = millimetres / length * static_cast<double>(last);
    const auto i = static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, static_cast<double>(last - 1)));
    return points[i] + (points[i + 1] - points[i]) * (place - static_cast<double>(i));
}

std::optional<GuidedPath> guided_path(const Walls& walls, const glm::dvec3& from, const glm::dvec3& to) {
    if (!finite(from) || !finite(to)) return std::nullopt;
    const Grid grid(walls);
    const auto first = grid.entrance(from), last = grid.entrance(to);
    if (!first || !last) return std::nullopt;
    const std::vector<std::size_t> nodes = grid.way(*first, *last);
    if (nodes.empty()) return std::nullopt;
    std::vector<glm::dvec3> line;
    if (!walls.solid(from)) line.push_back(from);
    for (const std::size_t node : nodes)
        line.push_back(grid.world(node));
    if (!walls.solid(to)) line.push_back(to);
    const double voxel = walls.voxel();
    if (!(length_of(line) > 1e-6 * voxel) || glm::length(line.back() - line.front()) < 1e-6 * voxel)
        return std::nullopt;

    GuidedPath path;
    path.points = evenly(line, parts_of(line, voxel));
    smooth(path.points, walls);
    path.points = evenly(path.points, parts_of(path.points, voxel));
    for (glm::dvec3& p : path.points) {
        for (int i = 0; i < 10 && walls.solid(p); ++i)
            p += walls.away(p) * (0.1 * voxel);
        path.room.push_back(walls.distance(p));
    }
    path.length = length_of(path.points);
    return path;
}

CameraPath camera_path_along(const GuidedPath& path, double seconds, double fov, const glm::dvec3& up) {
    if (path.points.size() < 2 || !(path.length > 0)) fail("guided path: the path has no length");
    if (!(seconds > 0 && std::isfinite(seconds))) fail("guided path seconds: {}, expected a number above 0", seconds);
    const double step = path.length / static_cast<double>(path.points.size() - 1);
    // In wide rooms the target is further ahead than in narrow ones.
    double room = 0;
    for (const double r : path.room)
        room += std::min(r, kMaxRoom * step) / static_cast<double>(path.room.size());
    const double look_ahead = std::clamp(2 * room, 4 * step, 15 * step);
    const std::size_t spans = std::clamp<std::size_t>(path.points.size() / 2, 1, kMostKeys - 1);
    CameraPath out;
    for (std::size_t k = 0; k <= spans; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(spans), at = share * path.length;
        out.keys.push_back({share * seconds, path.at(at), path.at(at + look_ahead), up, fov});
    }
    validate(out);
    return out;
}

Camera camera_along(const GuidedPath& path, double millimetres, double fov, const glm::dvec3& up) {
    const double at = std::isfinite(millimetres) ? std::clamp(millimetres, 0.0, path.length) : 0;
    return camera_at(camera_path_along(path, path.length, fov, up), at);
}

}  // namespace edgesplat::viewer
