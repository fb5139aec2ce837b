// Pictures with divided sheets: the host's arithmetic, and several renderers against one.
#include "engine/distribute/parts.h"

#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "engine/image/image_compare.h"
#include "engine/renderer.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

/// A premultiplied pixel.
glm::vec4 random_pixel(std::mt19937& random, float opaque = 0.6F) {
    std::uniform_real_distribution<float> unit(0, 1);
    const float alpha = opaque * unit(random);
    return {alpha * unit(random), alpha * unit(random), alpha * unit(random), alpha};
}

float distance_of(const glm::vec4& a, const glm::vec4& b) {
    const glm::vec4 d = glm::abs(a - b);
    return std::max({d.r, d.g, d.b, d.a});
}

TEST(Over, IsAssociativeButNotCommutative) {
    std::mt19937 random(7);
    float worst = 0, least_turned = 1;
    for (int i = 0; i < 10000; ++i) {
        const glm::vec4 a = random_pixel(random), b = random_pixel(random, 1), c = random_pixel(random);
        worst = std::max(worst, distance_of(over(over(a, b), c), over(a, over(b, c))));
    }
    EXPECT_LE(worst, 3e-7F);
    const glm::vec4 red(0.5F, 0, 0, 0.5F), blue(0, 0, 0.5F, 0.5F);
    least_turned = std::min(least_turned, distance_of(over(red, blue), over(blue, red)));
    EXPECT_EQ(least_turned, 0.25F);
    EXPECT_EQ(over(glm::vec4(0), red), red);
    EXPECT_EQ(over(red, glm::vec4(0)), red);
}

TEST(SheetParts, CoverAllSheetsOnceInSimilarShares) {
    std::mt19937 random(3);
    for (const std::size_t sheets : {0U, 1U, 3U, 50U, 400U}) {
        std::vector<std::uint32_t> pairs(sheets);
        for (auto& p : pairs)
            p = random() % 100;
        for (const int count : {1, 2, 3, 7}) {
            std::uint32_t end = 0;
            std::uint64_t all = 0, most = 0;
            for (int i = 0; i < count; ++i) {
                const glm::uvec2 part = sheets_of_part(pairs, {i, count});
                EXPECT_EQ(part.x, end);
                EXPECT_LE(part.x, part.y);
                end = part.y;
                std::uint64_t sum = 0;
                for (std::uint32_t s = part.x; s < part.y; ++s)
                    sum += pairs[s];
                all += sum;
                most = std::max(most, sum);
            }
            EXPECT_EQ(end, sheets);
            EXPECT_LE(most, all / static_cast<std::uint64_t>(count) + 101);
        }
    }
}

/// A volume of 300^3 in blocks; the blocks around the middle are empty.
std::vector<CollectionBlock> blocks_of(const VolumeGeometry& geometry) {
    std::vector<CollectionBlock> blocks;
    for (int i = 0; i < 27; ++i) {
        CollectionBlock block;
        block.core_low = 128 * glm::ivec3(i % 3, i / 3 % 3, i / 9);
        block.core_size = glm::min(glm::ivec3(128), geometry.dims - block.core_low);
        if (i != 13) blocks.push_back(block);
    }
    return blocks;
}

TEST(Slabs, CoverAllSheetsOnceAndContainTheirBlocks) {
    constexpr double kReach = 3.6;
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(300);
    geometry.index_to_world_axes = glm::dmat3({0.5, 0.1, 0}, {0, 0.7, 0}, {0, -0.2, 2});
    const std::vector<CollectionBlock> blocks = blocks_of(geometry);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int view = 0; view < 20; ++view) {
        const glm::dvec3 away = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)) + 1e-3);
        // From outside, from the edge, and from inside.
        const double distance = view % 3 == 0 ? 2000 : view % 3 == 1 ? 150 : 5;
        const Camera camera{.eye = geometry.center() + distance * away, .direction = -away};
        const CameraFrame frame = camera_frame(camera);
        const double thickness = sheet_thickness(geometry, camera, {});
        for (const int count : {1, 2, 5}) {
            SCOPED_TRACE(testing::Message() << "view " << view << ", " << count << " parts");
            std::vector<glm::ivec2> slabs;
            for (int i = 0; i < count; ++i)
                slabs.push_back(slab_of_part(geometry, camera, thickness, blocks, {i, count}));
            EXPECT_EQ(slabs.front().x, 0);
            EXPECT_EQ(slabs.back().y, std::numeric_limits<int>::max());
            for (std::size_t i = 1; i < slabs.size(); ++i)
                ASSERT_EQ(slabs[i].x, slabs[i - 1].y);
            std::vector<double> voxels(slabs.size());
            double all = 0;
            for (const CollectionBlock& block : blocks) {
                const glm::ivec2 sheets = sheets_of_block(geometry, camera, thickness, kReach, block);
                for (int n = 0; n < 400; ++n) {
                    const glm::dvec3 place(unit(random), unit(random), unit(random));
                    const glm::dvec3 at =
                        glm::dvec3(block.core_low) + (0.5 + 0.5 * place) * glm::dvec3(block.core_size - 1);
                    const glm::dvec3 kernel = kReach * glm::normalize(glm::dvec3(unit(random), unit(random), 1));
                    const double depth = glm::dot(frame.forward, geometry.to_world(at) - frame.eye);
                    const double end = glm::dot(frame.forward, geometry.to_world(at + kernel) - frame.eye);
                    for (const double z : {depth, end}) {
                        if (z <= 0) continue;
                        const int sheet = static_cast<int>(std::floor(z / thickness));
                        EXPECT_TRUE(sheet >= sheets.x && sheet < sheets.y);
                    }
                    if (depth <= 0) continue;
                    const int sheet = static_cast<int>(std::floor(depth / thickness));
                    const glm::dvec3 core(block.core_size);
                    const double weight = core.x * core.y * core.z;
                    for (std::size_t i = 0; i < slabs.size(); ++i)
                        if (sheet >= slabs[i].x && sheet < slabs[i].y) voxels[i] += weight;
                    all += weight;
                }
            }
            for (const double share : voxels)
                EXPECT_NEAR(share / all, 1.0 / count, 0.5 / count);
            EXPECT_NEAR(std::accumulate(voxels.begin(), voxels.end(), 0.0) / all, 1, 1e-12);
        }
    }
}

TEST(Slabs, CountFromThePicturesFirstSheet) {
    const std::vector<std::uint32_t> pairs(10, 1);
    const auto sheets = [&](int from, int to, int base) {
        return Division{.part = {1, 3}, .slab = glm::ivec2(from, to)}.sheets(pairs, base);
    };
    EXPECT_EQ(sheets(103, 105, 100), glm::uvec2(3, 5));
    EXPECT_EQ(sheets(0, 104, 100), glm::uvec2(0, 4));
    EXPECT_EQ(sheets(104, std::numeric_limits<int>::max(), 100), glm::uvec2(4, 10));
    EXPECT_EQ(sheets(0, 50, 100), glm::uvec2(0, 0));
    EXPECT_EQ(sheets(200, 300, 100), glm::uvec2(10, 10));
    EXPECT_EQ((Division{.part = {}, .slab = {}}.sheets(pairs, 100)), glm::uvec2(0, 10));
}

/// Composites sheets until a pixel is saturated.
glm::vec4 folded(const glm::vec4& before, std::span<const glm::vec4> sheets, float saturation) {
    glm::vec4 sum = before;
    for (const glm::vec4& sheet : sheets)
        if (sum.a < saturation) sum = over(sum, sheet);
    return sum;
}

TEST(PixelsBehind, SaturateWhereTheWholePictureSaturates) {
    constexpr float kSaturation = 0.9F;
    constexpr std::size_t kSheets = 12, kParts = 3, kEach = kSheets / kParts;
    const glm::ivec2 size(37, 20), tiles(3, 2);
    const auto count = static_cast<std::size_t>(size.x * size.y);
    std::mt19937 random(5);
    std::vector<std::vector<glm::vec4>> sheets(count);
    for (auto& pixel : sheets)
        for (std::size_t s = 0; s < kSheets; ++s)
            pixel.push_back(random_pixel(random, random() % 2 == 0 ? 0.1F : 0.7F));
    std::vector<float> in_front(count, 1.0F);
    std::vector<glm::vec4> whole(count, glm::vec4(0)), unclosed = whole;
    std::size_t drawn_again = 0;
    for (std::size_t p = 0; p < kParts; ++p) {
        const auto own = [&](std::size_t i) { return std::span(sheets[i]).subspan(p * kEach, kEach); };
        std::vector<glm::vec4> part(count), pixels(count);
        for (std::size_t i = 0; i < count; ++i)
            part[i] = folded(glm::vec4(0), own(i), kSaturation);
        const std::vector<glm::vec4> alone = part;
        const PixelsBehind behind(in_front, kSaturation, part, pixels);
        EXPECT_EQ(behind.any(), p > 0);
        std::size_t open = 0, closed = 0;
        for (std::size_t i = 0; i < count; ++i) {
            open += pixels[i].a < kSaturation ? 1U : 0U;
            pixels[i] = folded(pixels[i], own(i), kSaturation);
        }
        const std::vector<std::uint32_t> drawn{256, 256, 80, 64, 64, 20};  // pixels of the tiles
        for (const std::uint32_t tile : behind.closed_pixels(size, tiles, drawn))
            closed += tile;
        EXPECT_EQ(open + closed, count);
        drawn_again += open;
        behind.take(in_front, pixels, part);
        for (std::size_t i = 0; i < count; ++i) {
            whole[i] = over(whole[i], part[i]);
            unclosed[i] = over(unclosed[i], alone[i]);
            in_front[i] *= 1 - alone[i].a;
        }
    }
    EXPECT_GT(drawn_again, count / 10);
    float worst = 0, without = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4 want = folded(glm::vec4(0), sheets[i], kSaturation);
        worst = std::max(worst, distance_of(want, whole[i]));
        without = std::max(without, distance_of(want, unclosed[i]));
    }
    EXPECT_LE(worst, 2e-6F);
    EXPECT_GT(without, 0.05F) << "saturation changes nothing here";
}

/// Renderers in threads of one process. With `turned`, the parts are composited in reverse order.
class ThreadExchange : public PartExchange {
  public:
    struct Table {
        explicit Table(int parts)
            : all(parts),
              values(static_cast<std::size_t>(parts)),
              floats(values.size()),
              pixels(values.size()),
              words(values.size()) {}
        std::barrier<> all;
        std::vector<int> values;
        std::vector<std::span<float>> floats;
        std::vector<std::span<glm::vec4>> pixels;
        std::vector<std::span<std::uint32_t>> words;
    };
    ThreadExchange(Table& table, const SheetPart& part, bool turned) : table_(&table), part_(part), turned_(turned) {}

    SheetPart part() const override { return part_; }
    void wait() override { table_->all.arrive_and_wait(); }
    int largest(int value) override {
        table_->values[own()] = value;
        wait();
        const int most = std::ranges::max(table_->values);
        wait();
        return most;
    }
    void pass_back(std::span<float> transmittance) override {
        table_->floats[own()] = transmittance;
        wait();
        std::vector<float> product(transmittance.size(), 1.0F);
        for (std::size_t p = 0; p < own(); ++p)
            std::ranges::transform(product, table_->floats[p], product.begin(), std::multiplies<>());
        wait();
        std::ranges::copy(product, transmittance.begin());
    }
    void fold(std::span<glm::vec4> pixels) override {
        collect(pixels, [this](const glm::vec4& a, const glm::vec4& b) { return turned_ ? over(b, a) : over(a, b); });
    }
    void add(std::span<glm::vec4> pixels) override { collect(pixels, std::plus<>()); }
    void share(std::span<std::uint32_t> words) override {
        table_->words[own()] = words;
        wait();
        if (part_.index > 0) std::ranges::copy(table_->words[0], words.begin());
        wait();
    }

  private:
    std::size_t own() const { return static_cast<std::size_t>(part_.index); }
    template <typename Fold>
    void collect(std::span<glm::vec4> pixels, const Fold& fold) {
        table_->pixels[own()] = pixels;
        wait();
        if (part_.index == 0)
            for (std::size_t p = 1; p < table_->pixels.size(); ++p)
                std::ranges::transform(pixels, table_->pixels[p], pixels.begin(), fold);
        wait();
    }
    Table* table_;
    SheetPart part_;
    bool turned_;
};

constexpr AovRequest kAllOutputs{.tau = true, .depth = true, .normal = true, .distance = true};

std::vector<RenderResult> in_parts(std::vector<Renderer>& renderers, const PassScene& s, const Settings& settings,
                                   bool turned = false, const glm::ivec2& size = {48, 32}) {
    const int count = static_cast<int>(renderers.size());
    ThreadExchange::Table table(count);
    std::vector<RenderResult> results(renderers.size());
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i) {
        threads.emplace_back([&, i] {
            const auto own = static_cast<std::size_t>(i);
            ThreadExchange exchange(table, {i, count}, turned);
            renderers[own].divide_sheets(&exchange);
            results[own] = renderers[own].render(s.scene, s.camera, settings, size.x, size.y, kAllOutputs);
            renderers[own].divide_sheets(nullptr);
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    return results;
}

/// Largest error of a mean, weighted by opacity, since the rim of a footprint may be empty.
double worst_of_mean(const Image& a, const Image& b, const Image& color) {
    double worst = 0, peak = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const double alpha = static_cast<double>(color.pixels[4 * (i / static_cast<std::size_t>(a.channels)) + 3]);
        worst = std::max(worst, alpha * std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i])));
        peak = std::max(peak, std::abs(static_cast<double>(a.pixels[i])));
    }
    return worst / peak;
}

TEST(DividedSheets, MatchThePictureOfOneRenderer) {
    const DeviceChoice choice{.validation = true};
    std::vector<Renderer> renderers;
    for (int i = 0; i < 3; ++i)
        renderers.emplace_back(choice);
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        for (Renderer& renderer : renderers)
            renderer.set_volume(std::make_shared<const Volume>(s.volume));
        s.scene.background = {0.2, 0.3, 0.4};
        s.scene.effects.background_top = glm::dvec3(0.6, 0.1, 0.2);
        s.scene.effects.samples = s.name == "torus" ? 2 : 1;
        for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
            Settings settings = s.settings;
            settings.sheets = sheets;
            const RenderResult one = renderers[0].render(s.scene, s.camera, settings, 48, 32, kAllOutputs);
            const std::vector<RenderResult> parts = in_parts(renderers, s, settings);
            const double psnr = compare_images(one.color, parts[0].color).psnr;
            double redrawn = 0;
            for (const RenderResult& part : parts) {
                EXPECT_GT(part.stats.share->pairs, 0U);
                redrawn += part.stats.share->redraw_milliseconds;
                EXPECT_EQ(part.stats.validation_messages, 0U);
            }
            std::printf("%-18s %s: %.1f dB, %.2f ms redrawn\n", s.name.c_str(), std::string(name_of(sheets)).c_str(),
                        psnr, redrawn);
            EXPECT_GE(psnr, 90);
            double peak = 0;
            for (const float tau : one.tau->pixels)
                peak = std::max(peak, static_cast<double>(tau));
            EXPECT_LE(compare_images(*one.tau, *parts[0].tau).max, 1e-6 * peak);
            EXPECT_LE(worst_of_mean(*one.depth, *parts[0].depth, one.color), 1e-5);
            EXPECT_LE(worst_of_mean(*one.distance, *parts[0].distance, one.color), 1e-4);
            EXPECT_LE(worst_of_mean(*one.normal, *parts[0].normal, one.color), 1e-4);
            EXPECT_LT(compare_images(one.color, in_parts(renderers, s, settings, true)[0].color).psnr, 60);
            // Afterwards, a renderer alone draws the undivided picture.
            EXPECT_EQ(renderers[0].render(s.scene, s.camera, settings, 48, 32).color.pixels, one.color.pixels);
        }
    }
}

bool is_refined(const RenderResult& result) {
    return std::ranges::any_of(result.stats.passes,
                               [](const PassTime& pass) { return pass.name == "5_refine_pixels"; });
}

TEST(DividedSheets, MatchRefinedPictures) {
    if (!device_under_test().device().profile().refines) GTEST_SKIP() << "this device draws every pixel";
    const glm::ivec2 size(203, 154);
    std::vector<Renderer> renderers;
    for (int i = 0; i < 3; ++i)
        renderers.emplace_back(DeviceChoice{.validation = true});
    const PassScene s = pass_scenes()[2];
    for (Renderer& renderer : renderers)
        renderer.set_volume(std::make_shared<const Volume>(s.volume));
    for (const double extinction : {0.3, 2.0}) {  // saturates nothing, and much
        PassScene seen = s;
        seen.scene.materials[1].extinction = extinction;
        const RenderResult one = renderers[0].render(seen.scene, seen.camera, seen.settings, size.x, size.y);
        EXPECT_TRUE(is_refined(one));
        const RenderResult parts = in_parts(renderers, seen, seen.settings, false, size)[0];
        EXPECT_TRUE(is_refined(parts));
        const double psnr = compare_images(one.color, parts.color).psnr;
        std::printf("extinction %g: %.1f dB\n", extinction, psnr);
        EXPECT_GE(psnr, 90);
        EXPECT_EQ(parts.stats.validation_messages, 0U);
        Settings every = seen.settings;
        every.pixels = PixelChoice::Every;
        EXPECT_NE(renderers[0].render(seen.scene, seen.camera, every, size.x, size.y).color.pixels, one.color.pixels);
    }
}

}  // namespace
}  // namespace edgesplat::test
