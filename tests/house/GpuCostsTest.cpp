// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

// gpu_costs.md computes frame times from counts of the field and from rates of cards. Its results follow from its
// tables by its formula, and its counts are those of RESULTS.md. A failure prints the row that the page should have.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

const fs::path root = OSGGPUANIMATION_SOURCE_FOLDER;

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
    const std::string _page = fileText(root / "osg_nodes/doc/gpu_costs.md");
};

} // namespace

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
    const std::string results = fileText(root / "tests/benchmark/RESULTS.md");
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

} // namespace osgGpuAnimation
