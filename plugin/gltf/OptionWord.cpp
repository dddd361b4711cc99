// SPDX-License-Identifier: MIT
#include "gltf/OptionWord.h"

namespace osgGpuAnimation::gltf
{

std::vector<OptionWord> splitOptions(const std::string& text)
{
    std::vector<OptionWord> words;
    bool quotes = false;
    bool inWord = false;
    for (const char letter : text)
    {
        if (letter == '"')
            quotes = !quotes;
        else if (letter == ' ' && !quotes)
        {
            inWord = false;
            continue;
        }
        if (!inWord) words.emplace_back();
        inWord = true;
        OptionWord& word = words.back();
        if (letter == '=' && !word.value)
            word.value.emplace();
        else if (letter != '"')
            (word.value ? *word.value : word.name) += letter;
    }
    return words;
}

std::string joinOptions(const std::vector<OptionWord>& words)
{
    std::string text;
    for (const OptionWord& word : words)
    {
        if (!text.empty()) text += ' ';
        const std::string whole = word.name + (word.value ? "=" + *word.value : "");
        const bool needsQuotes = whole.find(' ') != std::string::npos; // OSG's own readers know none
        text += needsQuotes ? '"' + whole + '"' : whole;
    }
    return text;
}

} // namespace osgGpuAnimation::gltf
