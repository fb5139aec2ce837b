// One picture by several renderers, each in a process or on a device of its own: each draws some of the sheets, and the
// partial pictures are folded front to back.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace edgesplat {

/// The sheets of part `index` of `count`; part 0 is in front.
struct SheetPart {
    int index = 0, count = 1;
};

/// What is in front over what is behind, both premultiplied. Associative but for rounding; not commutative.
inline glm::vec4 over(const glm::vec4& front, const glm::vec4& behind) {
    return front + (1.0F - front.a) * behind;
}

/// How the renderers of one picture hear of each other. All of them draw the same pictures and so call the same
/// functions in the same order; each returns where all have called it.
class PartExchange {
  public:
    virtual ~PartExchange() = default;
    virtual SheetPart part() const = 0;

    virtual void wait() = 0;
    /// The largest of the parts' values.
    virtual int largest(int value) = 0;
    /// In: what each pixel of this part lets through. Out: what the parts in front let through; of part 0 undefined.
    virtual void pass_back(std::span<float> transmittance) = 0;
    /// The parts' pixels folded with `over` in their order, left with part 0.
    virtual void fold(std::span<glm::vec4> pixels) = 0;
    /// Likewise their sum.
    virtual void add(std::span<glm::vec4> pixels) = 0;
    /// Part 0's words, for all.
    virtual void share(std::span<std::uint32_t> words) = 0;
};

/// Which sheets of a picture were drawn here, and the time of all its samples.
struct SheetShare {
    std::uint32_t first_sheet = 0, end_sheet = 0;  ///< half open
    std::uint64_t splats = 0;                      ///< that were looked at; more than are in the sheets
    std::uint64_t pairs = 0;            ///< of a splat and a tile that it touches: what sheets are divided by
    double draw_milliseconds = 0;       ///< selection, sort and drawing
    double redraw_milliseconds = 0;     ///< drawing again the pixels that what is in front closes
    double processor_milliseconds = 0;  ///< of all threads, for both
    double wait_milliseconds = 0;       ///< for the others
    double composite_milliseconds = 0;  ///< exchanging and folding
};

}  // namespace edgesplat
