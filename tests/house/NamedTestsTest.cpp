// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The README and the guides name the tests that show their claims. Each named test must exist, and each row of a table
// whose last column is "test" must name one.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

const fs::path sources = OSGGPUANIMATION_SOURCE_FOLDER;

/// Adds "Suite" and "Suite.name" of all tests in a source.
void addTests(const std::string& code, std::set<std::string>& tests)
{
    static const std::regex test(R"(TEST(?:_F|_P)?\((\w+), (\w+)\))");
    for (std::sregex_iterator found(code.begin(), code.end(), test), end; found != end; ++found)
    {
        tests.insert((*found)[1]);
        tests.insert((*found)[1].str() + "." + (*found)[2].str());
    }
}

std::set<std::string> allTests()
{
    std::set<std::string> tests;
    for (const auto& entry : fs::recursive_directory_iterator(sources / "tests"))
        if (entry.path().extension() == ".cpp") addTests(fileText(entry.path()), tests);
    return tests;
}

/// The words between backticks of the form SomeTest or SomeTest.someName.
std::vector<std::string> named(const std::string& markdown)
{
    static const std::regex name(R"(`([A-Z]\w*Test(?:\.\w+)?)`)");
    std::vector<std::string> names;
    for (std::sregex_iterator found(markdown.begin(), markdown.end(), name), end; found != end; ++found)
        names.push_back((*found)[1]);
    return names;
}

/// The rows that name no test, of the tables whose last column is "test".
std::vector<std::string> rowsWithout(const std::string& markdown)
{
    std::vector<std::string> rows;
    std::istringstream lines(markdown);
    bool isInside = false;
    for (std::string line; std::getline(lines, line);)
    {
        const bool isHead = line.size() > 8 && line.compare(line.size() - 8, 8, "| test |") == 0;
        isInside = isHead || (isInside && !line.empty() && line[0] == '|');
        const bool isBody = isInside && !isHead && line.rfind("| ---", 0) != 0;
        if (isBody && named(line).empty() && line.find("Oracle") == std::string::npos) rows.push_back(line);
    }
    return rows;
}

} // namespace

TEST(NamedTestsTest, everyTestThatAGuideNamesExists)
{
    const std::set<std::string> tests = allTests();
    std::size_t count = 0;
    for (const fs::path& guide : guides())
        for (const std::string& name : named(fileText(guide)))
        {
            EXPECT_EQ(tests.count(name), 1u) << guide << ": " << name;
            ++count;
        }
    EXPECT_GE(count, 100u);
}

TEST(NamedTestsTest, everyRowOfTheTablesNamesATest)
{
    std::size_t tables = 0;
    for (const fs::path& guide : guides())
    {
        const std::string text = fileText(guide);
        tables += text.find("| test |") != std::string::npos ? 1 : 0;
        for (const std::string& row : rowsWithout(text))
            ADD_FAILURE() << guide << ": " << row;
    }
    EXPECT_GE(tables, 2u);
}

TEST(NamedTestsTest, aMissingTestIsSeen)
{
    std::set<std::string> tests;
    addTests("TEST(FoxTest, runs)\nTEST_F(FoxTest, hides) // TEST_P(NoTest)", tests);
    EXPECT_EQ(tests, (std::set<std::string>{"FoxTest", "FoxTest.runs", "FoxTest.hides"}));
    const std::string table =
        "| fox | test |\n| --- | --- |\n| runs | `FoxTest.runs` |\n| flies | surely |\n\n| x | y |\n";
    EXPECT_EQ(named(table), std::vector<std::string>{"FoxTest.runs"});
    EXPECT_EQ(rowsWithout(table), std::vector<std::string>{"| flies | surely |"});
}

} // namespace osgGpuAnimation
