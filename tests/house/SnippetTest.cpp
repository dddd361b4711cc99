// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

// What the README shows as C++ is compiled and run by the tests in the files named Readme*Test.cpp: statement for
// statement, but for white space, comments and an EXPECT_TRUE around what returns a result.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

/// Without comments and white space. (A text with // in a string would lose its line's end: there is none.)
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

/// The text between the fences ```cpp and ```.
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

/// All that the README's tests compile, without the EXPECT_TRUE( and (void) before some of it.
std::string compiledText()
{
    std::string text;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / "tests"))
    {
        const std::string name = entry.path().filename().string();
        if (name.rfind("Readme", 0) == 0 && entry.path().extension() == ".cpp") text += bare(fileText(entry.path()));
    }
    static const std::regex expectation(R"(EXPECT_TRUE\(|\(void\))");
    return std::regex_replace(text, expectation, "");
}

std::vector<std::string> missing(const std::string& markdown, const std::string& compiled)
{
    std::vector<std::string> found;
    for (const std::string& snippet : snippets(markdown))
        for (const std::string& statement : statements(snippet))
            if (compiled.find(statement) == std::string::npos) found.push_back(statement);
    return found;
}

} // namespace

TEST(SnippetTest, everyStatementOfTheReadmeIsCompiledByATest)
{
    const std::string readme = fileText(fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / "README.md");
    ASSERT_GE(snippets(readme).size(), 8u);
    for (const std::string& statement : missing(readme, compiledText()))
        ADD_FAILURE() << "in no test: " << statement;
}

TEST(SnippetTest, aStatementThatNobodyCompilesIsSeen)
{
    const std::string readme = "```cpp\nfox->walk();   // on\nfox->fly(1, 2);\n```\n```sh\nls;\n```\n";
    EXPECT_EQ(missing(readme, bare("EXPECT_TRUE(fox->walk());")), std::vector<std::string>{"fox->fly(1,2)"});
}

} // namespace osgGpuAnimation
