// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The tests in the files named Readme*Test.cpp compile and run each C++ snippet of the README and the guides, statement
// by statement. Only white space and comments may differ, so that the snippets give no warning about an unused Result.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

/// The code without comments and white space. (No snippet has // in a string.)
std::string bare(const std::string& code)
{
    static const std::regex comment(R"(//[^\n]*)");
    std::string text = std::regex_replace(code, comment, "");
    text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) != 0; }),
               text.end());
    return text;
}

std::vector<std::string> statements(const std::string& code)
{
    std::vector<std::string> found;
    std::string statement;
    for (char c : bare(code))
        if (c == ';' || c == '{' || c == '}')
        {
            if (!statement.empty()) found.push_back(statement);
            statement.clear();
        }
        else
            statement += c;
    return found;
}

/// The texts between the fences ```cpp and ```.
std::vector<std::string> snippets(const std::string& markdown)
{
    std::vector<std::string> found;
    std::istringstream lines(markdown);
    bool isInside = false;
    for (std::string line; std::getline(lines, line);)
    {
        if (isInside && line.rfind("```", 0) == 0)
            isInside = false;
        else if (isInside)
            found.back() += line + "\n";
        else if (line == "```cpp")
        {
            isInside = true;
            found.emplace_back();
        }
    }
    return found;
}

/// The statements of all Readme*Test.cpp.
std::set<std::string> compiledStatements()
{
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / "tests"))
    {
        const std::string name = entry.path().filename().string();
        if (name.rfind("Readme", 0) != 0 || entry.path().extension() != ".cpp") continue;
        for (const std::string& statement : statements(fileText(entry.path())))
            found.insert(statement);
    }
    return found;
}

std::vector<std::string> missing(const std::string& markdown, const std::set<std::string>& compiled)
{
    std::vector<std::string> found;
    for (const std::string& snippet : snippets(markdown))
        for (const std::string& statement : statements(snippet))
            if (compiled.count(statement) == 0) found.push_back(statement);
    return found;
}

} // namespace

TEST(SnippetTest, everyStatementOfTheGuidesIsCompiledByATest)
{
    const std::set<std::string> compiled = compiledStatements();
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

} // namespace osgGpuAnimation
