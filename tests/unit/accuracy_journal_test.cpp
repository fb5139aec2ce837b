// Journals that are truncated, damaged or of another measurement.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/accuracy/picture_store.h"
#include "engine/accuracy/work_list.h"

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;

class AccuracyJournal : public ::testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string text() const {
        std::ifstream file(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
    void fill() const {
        Journal journal(path_, identity_);
        journal.add("a", 1);
        journal.add("b", {{"x", 0.1}});
        journal.add("c", "three");
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("edgesplat_journal_" + std::to_string(getpid()));
    std::filesystem::path path_ = folder_ / "journal.jsonl";
    ordered_json identity_{{"volume", "v"}, {"size", 3}};
};

TEST_F(AccuracyJournal, KeepsFinishedPieces) {
    fill();
    const Journal journal(path_, identity_);
    EXPECT_EQ(journal.size(), 3U);
    EXPECT_EQ(journal.dropped(), 0);
    EXPECT_EQ((*journal.find("b"))["x"], 0.1);
    EXPECT_EQ(journal.find("d"), nullptr);
}

TEST_F(AccuracyJournal, RepeatsTruncatedLine) {
    fill();
    const std::string whole = text();
    write(whole.substr(0, whole.size() - 9));
    {
        Journal journal(path_, identity_);
        EXPECT_EQ(journal.dropped(), 1);
        EXPECT_EQ(journal.find("c"), nullptr);
        EXPECT_NE(journal.find("b"), nullptr);
        journal.add("c", "three");
    }
    EXPECT_EQ(text(), whole);
}

TEST_F(AccuracyJournal, DropsOnlyDamagedLine) {
    fill();
    std::string damaged = text();
    damaged.replace(damaged.find("0.1"), 3, "0.2");
    write(damaged);
    const Journal journal(path_, identity_);
    EXPECT_EQ(journal.dropped(), 1);
    EXPECT_EQ(journal.find("b"), nullptr);
    EXPECT_NE(journal.find("c"), nullptr);
}

TEST_F(AccuracyJournal, RejectsMalformedJournal) {
    write(std::string("\0\xff{}{{\n[1,2]\nnull\n", 17));
    const Journal journal(path_, identity_);
    EXPECT_EQ(journal.size(), 0U);
    EXPECT_EQ(journal.dropped(), 3);
}

TEST_F(AccuracyJournal, RefusesOtherMeasurement) {
    fill();
    ordered_json other = identity_;
    other["size"] = 4;
    try {
        const Journal journal(path_, other);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("size: 3 there, 4 asked for"));
        EXPECT_THAT(error.what(), HasSubstr("--restart"));
    }
    EXPECT_EQ(Journal(path_, other, true).size(), 0U);
    EXPECT_EQ(Journal(path_, other).size(), 0U);
}

TEST_F(AccuracyJournal, RefusesSecondWriter) {
    const Journal journal(path_, identity_);
    EXPECT_THROW(Journal(path_, identity_), Error);
}

TEST_F(AccuracyJournal, ResumesStoppedList) {
    std::vector<int> ran;
    const auto work = [&](Journal& journal, int stop_at) {
        WorkList list(journal, [&](const Progress& p) { return static_cast<int>(p.pieces_done) < stop_at; });
        for (int i = 0; i < 5; ++i)
            list.add({"kind", std::to_string(i), "piece", [&ran, i] {
                          ran.push_back(i);
                          return ordered_json(i);
                      }});
        list.run();
    };
    {
        Journal journal(path_, identity_);
        EXPECT_THROW(work(journal, 3), Interrupted);
    }
    Journal journal(path_, identity_);
    work(journal, 9);
    EXPECT_THAT(ran, ::testing::ElementsAre(0, 1, 2, 3, 4));
    work(journal, 9);
    EXPECT_EQ(ran.size(), 5U);
}

TEST_F(AccuracyJournal, RecomputesDamagedPicture) {
    Journal journal(path_, identity_);
    PictureStore store(folder_, journal);
    int made = 0;
    const auto make = [&] {
        ++made;
        Image image(2, 2, 4);
        image.at(1, 1, 2) = 0.1F;
        return ReferencePicture{image, 1e-5};
    };
    EXPECT_EQ(store.get("key", make).image.at(1, 1, 2), 0.1F);
    EXPECT_EQ(store.get("key", make).error_estimate, 1e-5);
    EXPECT_EQ(made, 1);
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (entry.path().extension() == ".float32") std::filesystem::resize_file(entry.path(), 7);
    EXPECT_EQ(store.get("key", make).image.at(1, 1, 2), 0.1F);
    EXPECT_EQ(made, 2);
}

}  // namespace
}  // namespace edgesplat::accuracy
