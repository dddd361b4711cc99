// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateCondition.h>

#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Test = StateCondition::Test;

std::optional<double> toNumber(const std::string& word)
{
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<Test> toComparison(const std::string& word)
{
    static const std::pair<const char*, Test> comparisons[] = {{">", Test::Greater}, {">=", Test::AtLeast},
                                                               {"<", Test::Less},    {"<=", Test::AtMost},
                                                               {"==", Test::Equal},  {"!=", Test::NotEqual}};
    for (const auto& [name, test] : comparisons)
        if (word == name) return test;
    return std::nullopt;
}

} // namespace

Result<StateCondition> StateCondition::parse(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; words.size() < 4 && stream >> word;)
        words.push_back(word);
    if (words.size() == 1 && words[0] == "finished") return StateCondition{Test::Finished, "", 0.0};
    if (words.size() == 2 && words[0] == "after")
        if (const auto seconds = toNumber(words[1]); seconds && *seconds >= 0.0)
            return StateCondition{Test::After, "", *seconds};
    if (words.size() == 3)
        if (const auto test = toComparison(words[1]))
            if (const auto value = toNumber(words[2])) return StateCondition{*test, words[0], *value};
    if (words.size() == 1 && !toComparison(words[0]) && !toNumber(words[0]) && words[0] != "after")
        return StateCondition{Test::Fired, words[0], 0.0};
    return Error{"\"" + text +
                 "\" is not a condition: expected \"PARAMETER > NUMBER\" (or >= < <= == !=), "
                 "\"TRIGGER\", \"finished\" or \"after SECONDS\""};
}

} // namespace osgGpuAnimation
