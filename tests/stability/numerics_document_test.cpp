// docs/numerics.md names every case of this program, and no others.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace edgesplat::test {
namespace {

// NUMERICS_SUITE has another value in each program.
TEST(NUMERICS_SUITE, TheDocumentNamesEveryCase) {
    std::ifstream file(EDGESPLAT_SOURCE_DIR "/docs/numerics.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    ASSERT_FALSE(text.empty());
    std::set<std::string> suites, cases;
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    for (int s = 0; s < tests.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *tests.GetTestSuite(s);
        // Without the prefix and the parameters of parameterized suites.
        const std::string whole = suite.name(), name = whole.substr(whole.find('/') + 1);
        if (name.starts_with("Numerics") || name == "Renderer") continue;
        suites.insert(name);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const std::string test = suite.GetTestInfo(t)->name();
            cases.insert(name + "." + test.substr(0, test.find('/')));
        }
    }
    std::set<std::string> named;
    const std::regex pattern(R"(\b([A-Z][A-Za-z0-9]*)\.([A-Z][A-Za-z0-9]*)\b)");
    for (auto it = std::sregex_iterator(text.begin(), text.end(), pattern); it != std::sregex_iterator(); ++it)
        if (suites.contains((*it)[1])) named.insert(it->str());
    for (const std::string& name : cases)
        EXPECT_TRUE(named.contains(name)) << name << " is not in docs/numerics.md";
    for (const std::string& name : named)
        EXPECT_TRUE(cases.contains(name)) << name << " is in docs/numerics.md, but is no case";
}

}  // namespace
}  // namespace edgesplat::test
