// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateCondition.h>

#include <algorithm>
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

constexpr char signs[] = "<>=!"; // of comparisons; names do not contain them

std::optional<double> toNumber(const std::string& word)
{
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::vector<std::string> toWords(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; words.size() < 3 && stream >> word;)
        words.push_back(word);
    return words;
}

/// True for the reserved words, in upper or lower case: a trigger cannot have such a name.
bool isReserved(std::string word)
{
    for (char& letter : word)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return word == "finished" || word == "after";
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

/// Parses PARAMETER > NUMBER, with or without spaces. sign: index of the first character of the comparison.
std::optional<StateCondition> parseComparison(const std::string& text, std::size_t sign)
{
    const std::size_t end = std::min(text.find_first_not_of(signs, sign), text.size());
    const std::vector<std::string> names = toWords(text.substr(0, sign)), values = toWords(text.substr(end));
    const auto test = toComparison(text.substr(sign, end - sign));
    if (!test || names.size() != 1 || values.size() != 1) return std::nullopt;
    const auto value = toNumber(values[0]);
    if (!value) return std::nullopt;
    return StateCondition{*test, names[0], *value};
}

} // namespace

Result<StateCondition> StateCondition::parse(const std::string& text)
{
    const std::size_t sign = text.find_first_of(signs);
    const std::vector<std::string> words = sign == std::string::npos ? toWords(text) : std::vector<std::string>();
    if (sign != std::string::npos)
        if (const auto comparison = parseComparison(text, sign)) return *comparison;
    if (words.size() == 1 && words[0] == "finished") return StateCondition{Test::Finished, "", 0.0};
    if (words.size() == 2 && words[0] == "after")
        if (const auto seconds = toNumber(words[1]); seconds && *seconds >= 0.0)
            return StateCondition{Test::After, "", *seconds};
    if (words.size() == 1 && !toNumber(words[0]) && !isReserved(words[0]))
        return StateCondition{Test::Fired, words[0], 0.0};
    return Error{"\"" + text +
                 "\" is not a condition: expected \"PARAMETER > NUMBER\" (or >= < <= == !=), "
                 "\"TRIGGER\", \"finished\" or \"after SECONDS\""};
}

} // namespace osgGpuAnimation
