// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The README names the tests that show what it says: they are there, and the tables of what is supported and of limits
// name one in each row.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

const fs::path sources = OSGGPUANIMATION_SOURCE_FOLDER;

/// "Suite" and "Suite.name" of all tests in a source.
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

/// What stands between backticks and is called ...Test or ...Test.something.
std::vector<std::string> named(const std::string& markdown)
{
    static const std::regex name(R"(`([A-Z]\w*Test(?:\.\w+)?)`)");
    std::vector<std::string> names;
    for (std::sregex_iterator found(markdown.begin(), markdown.end(), name), end; found != end; ++found)
        names.push_back((*found)[1]);
    return names;
}

/// Rows of the tables whose last column is headed "test", that name no test.
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

TEST(NamedTestsTest, everyTestThatTheReadmeNamesIsThere)
{
    const std::set<std::string> tests = allTests();
    const std::vector<std::string> names = named(fileText(sources / "README.md"));
    ASSERT_GE(names.size(), 100u);
    for (const std::string& name : names)
        EXPECT_EQ(tests.count(name), 1u) << name;
}

TEST(NamedTestsTest, everyRowOfTheTablesNamesATest)
{
    const std::string readme = fileText(sources / "README.md");
    ASSERT_NE(readme.find("| test |"), std::string::npos);
    for (const std::string& row : rowsWithout(readme))
        EXPECT_NE(row.find("| looked at |"), std::string::npos) << row;
}

TEST(NamedTestsTest, whatIsMissingIsSeen)
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
