// Communication of several renderers (one per process or device) that draw one picture: each draws some of the sheets,
// and the partial pictures are composited front to back.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace edgesplat {

/// The sheets of part `index` of `count`; part 0 is in front.
struct SheetPart {
    int index = 0, count = 1;
};

/// The over operator on premultiplied colours. Associative up to rounding; not commutative.
inline glm::vec4 over(const glm::vec4& front, const glm::vec4& behind) {
    return front + (1.0F - front.a) * behind;
}

/// Collective operations of one picture's renderers. All draw the same pictures and therefore call the same functions
/// in the same order. Each function returns after all renderers called it.
class PartExchange {
  public:
    virtual ~PartExchange() = default;
    virtual SheetPart part() const = 0;

    virtual void wait() = 0;
    /// The largest of the parts' values.
    virtual int largest(int value) = 0;
    /// In: transmittance of each pixel of this part. Out: the product over the parts in front; undefined for part 0.
    virtual void pass_back(std::span<float> transmittance) = 0;
    /// Composites the parts' pixels with `over` in order; part 0 gets the result.
    virtual void fold(std::span<glm::vec4> pixels) = 0;
    /// Sums the parts' pixels; part 0 gets the result.
    virtual void add(std::span<glm::vec4> pixels) = 0;
    /// Copies part 0's words to all parts.
    virtual void share(std::span<std::uint32_t> words) = 0;
};

/// The sheets of a picture that this renderer drew, and times summed over all samples.
struct SheetShare {
    std::uint32_t first_sheet = 0, end_sheet = 0;  ///< half open
    std::uint64_t splats = 0;                      ///< splats examined; more than are in the sheets
    std::uint64_t pairs = 0;                       ///< (splat, tile) pairs: the parts get about equal numbers
    double draw_milliseconds = 0;                  ///< selection, sort and drawing
    double redraw_milliseconds = 0;                ///< redrawing pixels that saturate together with the parts in front
    double processor_milliseconds = 0;             ///< processor time of all threads for drawing and redrawing
    double wait_milliseconds = 0;                  ///< waiting for the other parts
    double composite_milliseconds = 0;             ///< exchange and compositing
};

}  // namespace edgesplat
