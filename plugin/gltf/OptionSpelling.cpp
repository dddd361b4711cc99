// SPDX-License-Identifier: MIT
#include "gltf/OptionSpelling.h"

#include "gltf/ElementName.h"
#include "gltf/OptionWord.h"

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

std::string lowered(std::string word)
{
    for (char& letter : word)
        if (letter >= 'A' && letter <= 'Z') letter = char(letter - 'A' + 'a');
    return word;
}

/// Is b what is left of a where at most one letter is dropped, and nothing else differs?
bool hasOneLetterMore(const std::string& a, const std::string& b)
{
    if (a.size() != b.size() + 1) return false;
    const auto differs = std::mismatch(b.begin(), b.end(), a.begin());
    return std::equal(differs.first, b.end(), differs.second + 1);
}

/// Of words of one length.
bool hasOneWrongOrTwoSwapped(const std::string& a, const std::string& b)
{
    const auto [inA, inB] = std::mismatch(a.begin(), a.end(), b.begin());
    if (inA == a.end() || std::equal(inA + 1, a.end(), inB + 1)) return true;
    return inA + 1 != a.end() && inA[0] == inB[1] && inA[1] == inB[0] && std::equal(inA + 2, a.end(), inB + 2);
}

bool isNearly(const std::string& word, const std::string& option)
{
    const std::string a = lowered(word), b = lowered(option);
    return a.size() == b.size() ? hasOneWrongOrTwoSwapped(a, b) : hasOneLetterMore(a, b) || hasOneLetterMore(b, a);
}

bool isAmong(const std::string& word, const std::vector<OptionHelp>& options)
{
    return std::any_of(options.begin(), options.end(),
                       [&](const OptionHelp& option) { return optionName(option) == word; });
}

} // namespace

std::string optionName(const OptionHelp& help)
{
    const std::string usage = help.first;
    return usage.substr(0, usage.find('='));
}

std::vector<std::string> misspeltOptions(const std::string& text, const std::vector<OptionHelp>& known,
                                         const std::vector<OptionHelp>& others)
{
    std::vector<std::string> hints;
    for (const OptionWord& word : splitOptions(text))
    {
        if (isAmong(word.name, known) || isAmong(word.name, others)) continue;
        const auto meant =
            std::find_if(known.begin(), known.end(),
                         [&](const OptionHelp& option) { return isNearly(word.name, optionName(option)); });
        if (meant != known.end())
            hints.push_back(quoted(word.name) + " is unknown; is " + quoted(optionName(*meant)) + " meant?");
    }
    return hints;
}

} // namespace osgGpuAnimation::gltf
