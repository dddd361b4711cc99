// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

// Links and pictures in the README and the guides lead to files of the repository, and anchors to headings.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

struct Link
{
    std::string file;   ///< empty: the file itself
    std::string anchor; ///< without the #; empty: none

    bool operator==(const Link& other) const { return file == other.file && anchor == other.anchor; }
};

/// The targets of [text](target) and ![text](target). Addresses with a scheme are left out.
std::vector<Link> links(const std::string& markdown)
{
    static const std::regex link(R"(\]\(([^)#:\s]*)(?:#([^)\s]*))?\))");
    std::vector<Link> found;
    for (std::sregex_iterator match(markdown.begin(), markdown.end(), link), end; match != end; ++match)
        found.push_back({(*match)[1], (*match)[2]});
    return found;
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
    for (std::sregex_iterator match(markdown.begin(), markdown.end(), heading), end; match != end; ++match)
        if (anchorOf((*match)[1]) == anchor) return true;
    return false;
}

} // namespace

TEST(LinkTest, everyLinkOfTheGuidesLeadsToAFileAndAHeading)
{
    std::size_t count = 0;
    for (const fs::path& guide : guides())
        for (const Link& link : links(fileText(guide)))
        {
            const fs::path target = link.file.empty() ? guide : guide.parent_path() / link.file;
            EXPECT_TRUE(fs::exists(target)) << guide << ": " << link.file;
            EXPECT_TRUE(link.anchor.empty() || hasAnchor(fileText(target), link.anchor))
                << guide << ": " << link.file << "#" << link.anchor;
            ++count;
        }
    EXPECT_GE(count, 10u);
}

TEST(LinkTest, linksAndHeadingsAreFound)
{
    EXPECT_EQ(links("[a](b.md) ![c](d/e.png) [f](b.md#g) [h](https://i.org) [j](#k)"),
              (std::vector<Link>{{"b.md", ""}, {"d/e.png", ""}, {"b.md", "g"}, {"", "k"}}));
    EXPECT_TRUE(hasAnchor("# Axes\n\n## Where is …?\n", "where-is-"));
    EXPECT_FALSE(hasAnchor("# Axes\n", "axe"));
}

} // namespace osgGpuAnimation
