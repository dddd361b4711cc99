// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// What the README and the guides name exists: headers and other files, links and headings, tests, and the code of
// their snippets.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

const fs::path kit = sourceFolder() / "osg_nodes/osgGpuAnimation";

using Names = std::set<std::string>;

Names setOf(const std::vector<std::string>& names)
{
    return Names(names.begin(), names.end());
}

Names publicHeaders()
{
    Names headers;
    for (const char* folder : {"math", "animation", "authoring", "gpu", "scene", "looks", "mesh", "frame", "nodes"})
        for (const auto& entry : fs::directory_iterator(kit / folder))
            if (entry.path().extension() == ".h")
                headers.insert(std::string(folder) + "/" + entry.path().filename().string());
    return headers;
}

bool isPath(const std::string& path)
{
    for (const fs::path& folder : {sourceFolder(), kit})
        for (const char* ending : {"", ".h", ".cpp"})
            if (fs::exists(folder / (path + ending))) return true;
    return false;
}

TEST(FaceTest, theTableOfHeadersIsComplete)
{
    static const std::regex row(R"(\| `((?:math|animation|authoring|gpu|scene|looks|mesh|frame|nodes)/\w+\.h)` \|)");
    EXPECT_EQ(setOf(matches(fileText(sourceFolder() / "osg_nodes/doc/application.md"), row)), publicHeaders());
}

TEST(FaceTest, theUmbrellaHeaderIncludesAllPublicHeaders)
{
    static const std::regex include(R"(#include <osgGpuAnimation/([^>]+)>)");
    EXPECT_EQ(setOf(matches(fileText(kit / "osgGpuAnimation.h"), include)), publicHeaders());
}

// Paths between backticks: `tests/run.sh`, `animation/Pose` (a header with its source), `nodes/frame`.
TEST(FaceTest, everyPathInTheGuidesExists)
{
    static const std::regex path(
        R"(`((?:math|animation|authoring|gpu|scene|looks|mesh|frame|nodes|plugin|shaders|tests|scenes|osg_nodes)/[\w./-]*)`)");
    std::size_t count = 0;
    for (const fs::path& guide : guides())
        for (const std::string& named : matches(fileText(guide), path))
        {
            // Examples of new files: tests/FOLDER/NameTest.cpp, plugin/ReaderWriterName.cpp, plugin/name/.
            const bool isExample = std::regex_search(named, std::regex("FOLDER|Name|/name"));
            EXPECT_TRUE(isExample || isPath(named)) << guide << ": " << named;
            ++count;
        }
    EXPECT_GE(count, 30u);
}

/// The targets of [text](target) and ![text](target), such as "b.md#c". Addresses with a scheme are left out.
std::vector<std::string> links(const std::string& markdown)
{
    static const std::regex link(R"(\]\(([^)#:\s]*(?:#[^)\s]*)?)\))");
    return matches(markdown, link);
}

/// The anchor that GitHub gives to a heading: "What is supported" becomes "what-is-supported".
std::string anchorOf(const std::string& heading)
{
    std::string anchor;
    for (unsigned char c : heading)
        if (c == ' ')
            anchor += '-';
        else if (std::isalnum(c) != 0 || c == '-' || c == '_')
            anchor += static_cast<char>(std::tolower(c));
    return anchor;
}

bool hasAnchor(const std::string& markdown, const std::string& anchor)
{
    static const std::regex heading(R"((?:^|\n)#+ ([^\n]*))");
    const std::vector<std::string> headings = matches(markdown, heading);
    return std::any_of(headings.begin(), headings.end(),
                       [&](const std::string& text) { return anchorOf(text) == anchor; });
}

TEST(LinkTest, everyLinkOfTheGuidesLeadsToAFileAndAHeading)
{
    std::size_t count = 0;
    for (const fs::path& guide : guides())
        for (const std::string& link : links(fileText(guide)))
        {
            const std::size_t hash = link.find('#');
            const std::string file = link.substr(0, hash);
            const fs::path target = file.empty() ? guide : guide.parent_path() / file;
            EXPECT_TRUE(fs::exists(target)) << guide << ": " << link;
            EXPECT_TRUE(hash == std::string::npos || hasAnchor(fileText(target), link.substr(hash + 1)))
                << guide << ": " << link;
            ++count;
        }
    EXPECT_GE(count, 10u);
}

TEST(LinkTest, linksAndHeadingsAreFound)
{
    EXPECT_EQ(links("[a](b.md) ![c](d/e.png) [f](b.md#g) [h](https://i.org) [j](#k)"),
              (std::vector<std::string>{"b.md", "d/e.png", "b.md#g", "#k"}));
    EXPECT_TRUE(hasAnchor("# Axes\n\n## Where is …?\n", "where-is-"));
    EXPECT_FALSE(hasAnchor("# Axes\n", "axe"));
}

/// Adds "Suite" and "Suite.name" of all tests in a source.
void addTests(const std::string& code, Names& tests)
{
    static const std::regex suite(R"(TEST(?:_F|_P)?\((\w+), \w+\))"), test(R"(TEST(?:_F|_P)?\((\w+, \w+)\))");
    for (const std::string& found : matches(code, suite))
        tests.insert(found);
    for (std::string found : matches(code, test))
        tests.insert(found.replace(found.find(", "), 2, "."));
}

/// The words between backticks of the form SomeTest or SomeTest.someName.
std::vector<std::string> namedTests(const std::string& markdown)
{
    static const std::regex name(R"(`([A-Z]\w*Test(?:\.\w+)?)`)");
    return matches(markdown, name);
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
        if (isBody && namedTests(line).empty() && line.find("Oracle") == std::string::npos) rows.push_back(line);
    }
    return rows;
}

TEST(NamedTestsTest, everyTestThatAGuideNamesExistsAndEveryRowOfTheTablesNamesOne)
{
    Names tests;
    for (const auto& entry : fs::recursive_directory_iterator(sourceFolder() / "tests"))
        if (entry.path().extension() == ".cpp") addTests(fileText(entry.path()), tests);
    std::size_t count = 0, tables = 0;
    for (const fs::path& guide : guides())
    {
        const std::string text = fileText(guide);
        for (const std::string& name : namedTests(text))
        {
            EXPECT_EQ(tests.count(name), 1u) << guide << ": " << name;
            ++count;
        }
        tables += text.find("| test |") != std::string::npos ? 1 : 0;
        for (const std::string& row : rowsWithout(text))
            ADD_FAILURE() << guide << ": " << row;
    }
    EXPECT_GE(count, 100u);
    EXPECT_GE(tables, 2u);
}

TEST(NamedTestsTest, aMissingTestIsSeen)
{
    Names tests;
    addTests("TEST(FoxTest, runs)\nTEST_F(FoxTest, hides) // TEST_P(NoTest)", tests);
    EXPECT_EQ(tests, (Names{"FoxTest", "FoxTest.runs", "FoxTest.hides"}));
    const std::string table =
        "| fox | test |\n| --- | --- |\n| runs | `FoxTest.runs` |\n| flies | surely |\n\n| x | y |\n";
    EXPECT_EQ(namedTests(table), std::vector<std::string>{"FoxTest.runs"});
    EXPECT_EQ(rowsWithout(table), std::vector<std::string>{"| flies | surely |"});
}

/// The statements of code, without comments and white space. (No snippet has // in a string.)
std::vector<std::string> statements(const std::string& code)
{
    static const std::regex noise(R"(//[^\n]*|\s)"), statement(R"(([^;{}]+))");
    return matches(std::regex_replace(code, noise, "") + ";", statement);
}

/// The texts between the fences ```cpp and ```.
std::vector<std::string> snippets(const std::string& markdown)
{
    std::vector<std::string> found;
    std::istringstream lines(markdown);
    bool isInside = false;
    for (std::string line; std::getline(lines, line);)
        if (isInside && line.rfind("```", 0) == 0)
            isInside = false;
        else if (isInside)
            found.back() += line + "\n";
        else if (line == "```cpp")
        {
            isInside = true;
            found.emplace_back();
        }
    return found;
}

std::vector<std::string> missing(const std::string& markdown, const Names& compiled)
{
    std::vector<std::string> found;
    for (const std::string& snippet : snippets(markdown))
        for (const std::string& statement : statements(snippet))
            if (compiled.count(statement) == 0) found.push_back(statement);
    return found;
}

// The tests in the files named Readme*Test.cpp compile and run each C++ snippet, statement by statement. Only white
// space and comments may differ, so that the snippets give no warning about an unused Result.
TEST(SnippetTest, everyStatementOfTheGuidesIsCompiledByATest)
{
    Names compiled;
    for (const auto& entry : fs::recursive_directory_iterator(sourceFolder() / "tests"))
    {
        const std::string name = entry.path().filename().string();
        if (name.rfind("Readme", 0) != 0 || entry.path().extension() != ".cpp") continue;
        for (const std::string& statement : statements(fileText(entry.path())))
            compiled.insert(statement);
    }
    std::size_t count = 0;
    for (const fs::path& guide : guides())
    {
        const std::string text = fileText(guide);
        count += snippets(text).size();
        for (const std::string& statement : missing(text, compiled))
            ADD_FAILURE() << guide << ", in no test: " << statement;
    }
    EXPECT_GE(count, 16u);
}

TEST(SnippetTest, aStatementInNoTestIsSeen)
{
    const std::string readme = "```cpp\nfox->walk();   // on\nfox->fly(1, 2);\n```\n```sh\nls;\n```\n";
    EXPECT_EQ(missing(readme, {"fox->walk()", "EXPECT_TRUE(fox->fly(1,2))"}),
              std::vector<std::string>{"fox->fly(1,2)"});
}

// gpu_costs.md computes frame times from counts of the field and from rates of cards. Its results follow from its
// tables by its formula, and its counts are those of RESULTS.md. A failure prints the row that the page should have.

using Row = std::vector<std::string>; ///< the cells

constexpr double fieldCount = 316.0 * 316.0;

/// "| a | b c |": "a", "b c".
Row cells(const std::string& line)
{
    Row found;
    for (std::size_t begin = 2, end; (end = line.find(" |", begin)) != std::string::npos; begin = end + 3)
        found.push_back(line.substr(std::min(begin, end), end - std::min(begin, end)));
    return found;
}

/// The rows below the row that begins so, to the end of its table.
std::vector<Row> rowsBelow(const std::string& text, const std::string& head)
{
    std::vector<Row> rows;
    std::istringstream lines(text.substr(std::min(text.find("\n" + head), text.size() - 1) + 1));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line) && line.rfind("| ", 0) == 0;)
        if (line.rfind("| ---", 0) != 0) rows.push_back(cells(line));
    return rows;
}

/// "4,055": 4055.
double number(std::string cell)
{
    cell.erase(std::remove(cell.begin(), cell.end(), ','), cell.end());
    return std::stod(cell);
}

/// The numbers of a row, in each column after the first.
std::vector<double> numbers(const Row& row)
{
    std::vector<double> found;
    for (std::size_t column = 1; column < row.size(); ++column)
        found.push_back(number(row[column]));
    return found;
}

std::string milliseconds(double seconds)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", 1e3 * seconds);
    return text;
}

/// The row of a card and a character. card: bandwidth, clock, triangles a clock, texture units.
Row computed(const std::string& cardName, const std::vector<double>& card, const std::string& character,
             const std::map<std::string, double>& count)
{
    const double memory = 1e9 * card[0], clock = 1e9 * card[1], entries = count.at("palette entries of a pose");
    const double poses = count.at("poses evaluated") * entries * 256.0 / memory;
    const double reads = (count.at("instances drawn") * (48.0 * entries + 56.0) +
                          2.0 * fieldCount * count.at("uploaded, bytes an instance")) /
                         memory;
    const double fetches = 17.0 * count.at("vertices shaded") / (card[3] / 4.0 * clock);
    const double triangles = count.at("triangles drawn") / (card[2] * clock);
    return {cardName,
            character,
            milliseconds(poses),
            milliseconds(reads),
            milliseconds(fetches),
            milliseconds(triangles),
            milliseconds(poses + reads + fetches + triangles)};
}

class GpuCostsTest : public ::testing::Test
{
protected:
    std::vector<Row> rowsOfPage(const std::string& head) const { return rowsBelow(_page, head); }

private:
    const std::string _page = fileText(sourceFolder() / "osg_nodes/doc/gpu_costs.md");
};

TEST_F(GpuCostsTest, theTimesFollowFromTheCounts)
{
    const Row characters{"Fox", "CesiumMan", "Knight"};
    const std::vector<Row> counts = rowsOfPage("| a frame |"), cards = rowsOfPage("| card | memory"),
                           times = rowsOfPage("| card | character");
    std::vector<Row> expected;
    for (const Row& card : cards)
        for (std::size_t character = 0; character < characters.size(); ++character)
        {
            std::map<std::string, double> count;
            for (const Row& row : counts)
                count[row.front()] = numbers(row).at(character);
            expected.push_back(computed(card.front(), numbers(card), characters[character], count));
        }
    ASSERT_GE(cards.size(), 3u);
    ASSERT_EQ(times.size(), expected.size());
    for (std::size_t row = 0; row < times.size(); ++row)
        EXPECT_EQ(times[row], expected[row]);
}

TEST_F(GpuCostsTest, theCountsAreThoseOfTheResults)
{
    const std::string results = fileText(sourceFolder() / "tests/benchmark/RESULTS.md");
    const std::vector<Row> measured = rowsBelow(results.substr(results.find("\n## The field")), "| | Fox |"),
                           counts = rowsOfPage("| a frame |");
    std::size_t compared = 0;
    for (const Row& count : counts)
    {
        const auto found = std::find_if(measured.begin(), measured.end(),
                                        [&](const Row& row) { return row.front() == count.front(); });
        if (found == measured.end()) continue;
        for (std::size_t column = 1; column < count.size(); ++column)
            EXPECT_EQ(count[column], found->at(column)) << count.front();
        ++compared;
    }
    EXPECT_EQ(compared, 5u); // all but the palette entries, which follow from the file
}

} // namespace

} // namespace osgGpuAnimation
