// SPDX-License-Identifier: MIT
#include "gltf/file/ImportOptions.h"

#include "gltf/file/Report.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <type_traits>

namespace osgGpuAnimation::gltf
{

namespace
{

/// False if the text is not a whole number from 0 to the largest Number, or not a finite number.
template <typename Number>
bool read(const std::string& text, Number& out)
{
    const std::optional<Number> number = parsedNumber<Number>(text);
    if (number) out = *number;
    if constexpr (std::is_floating_point_v<Number>)
        return number && std::isfinite(*number);
    else
        return number && *number >= 0;
}

/// A flag, whatever the text.
bool read(const std::string&, bool& out)
{
    return out = true;
}

bool read(const std::string& text, std::string& out)
{
    return !(out = text).empty();
}

bool read(const std::string& text, std::vector<std::string>& out)
{
    return read(text, out.emplace_back());
}

template <typename Value>
bool read(const std::string& text, std::optional<Value>& out)
{
    return read(text, out.emplace());
}

/// False if the text is none of the words.
template <typename Words, typename Value>
bool choose(const Words& words, const std::string& text, Value& out)
{
    for (const auto& [word, value] : words)
        if (text == word)
        {
            out = value;
            return true;
        }
    return false;
}

bool read(const std::string& text, LoopMode& out)
{
    constexpr std::pair<const char*, LoopMode> loopModes[] = {
        {"once", LoopMode::Once}, {"loop", LoopMode::Loop}, {"pingpong", LoopMode::PingPong}};
    return choose(loopModes, text, out);
}

bool read(const std::string& text, ClipMatch& out)
{
    return choose(clipMatches, text, out);
}

struct Option
{
    const char* usage; ///< and help: see OptionHelp
    const char* help;
    std::string wanted; ///< the values that the option takes, for messages
    /// False if the value does not fit the option.
    bool (*set)(const std::string& value, ImportOptions& options);
};

template <auto member>
bool set(const std::string& value, ImportOptions& options)
{
    return read(value, options.*member);
}

const std::vector<Option>& allOptions()
{
    static const char* const number = "a whole number that is not too large";
    static const char* const seconds = "a number of seconds, 0 or more";
    static const std::vector<Option> all = {
        {"clip=NAME|INDEX", "the clip that plays at first, by name or by number; default: the first",
         "a name or a number", set<&ImportOptions::clip>},
        {"clips=FILE",
         "adds the clips of another file of any format with a reader, for the joints of the same names; "
         "may be repeated",
         "the name of a file", set<&ImportOptions::clipsFiles>},
        {"clipJoints=FILE", "joints of the model and their counterparts in clips=FILE, as JSON: {\"Hips\": \"pelvis\"}",
         "the name of a file", set<&ImportOptions::clipJoints>},
        {"clipMatch=auto|byName|retarget",
         "byName: joints take the transforms of clips=FILE as they are; retarget: their difference from rest; default: "
         "auto",
         "auto, byName or retarget", set<&ImportOptions::clipMatch>},
        {"start=SECONDS", "start time in that clip; beyond its end: its end", seconds,
         [](const std::string& value, ImportOptions& options)
         { return read(value, options.start) && *options.start >= 0.0; }},
        {"randomStart=SEED", "each load starts at another time of the clip, unless start is given; default: all at 0",
         number, set<&ImportOptions::randomStart>},
        {"speed=NUMBER", "playback speed; negative: backwards; default: 1", "a number", set<&ImportOptions::speed>},
        {"loop=once|loop|pingpong", "behaviour at the clip's end; default: loop", "once, loop or pingpong",
         set<&ImportOptions::loopMode>},
        {"fade=SECONDS", "duration of the keys' crossfades; default: 0.3", seconds,
         [](const std::string& value, ImportOptions& options)
         { return read(value, options.fadeSeconds) && options.fadeSeconds >= 0.0; }},
        {"compact=FRACTION",
         "compact clips with an error of at most that fraction of the model's longest side; default: exact",
         "a number above 0, at most 1",
         [](const std::string& value, ImportOptions& options)
         { return read(value, options.compact) && *options.compact > 0.0 && *options.compact <= 1.0; }},
        {"pixelError=PIXELS",
         "fewer triangles while the error stays below that size on screen; default: 0, all triangles",
         LodRange::describePixelErrors(),
         [](const std::string& value, ImportOptions& options)
         { return read(value, options.pixelError) && LodRange::isPixelError(options.pixelError); }},
        {"noKeys", "no keys for viewers on the character; default: n N k . , - + r j", "", set<&ImportOptions::noKeys>},
        {"scene=INDEX", "the scene to show; default: the file's own", number, set<&ImportOptions::scene>},
        {"lighting=pbr|fixed", "the materials' own look, or that of the fixed pipeline; default: pbr", "pbr or fixed",
         [](const std::string& value, ImportOptions& options)
         { return (options.fixedLighting = value == "fixed") || value == "pbr"; }},
        {"variant=NAME|INDEX", "the variant of the file's materials, by name or by number; default: none",
         "a name or a number", set<&ImportOptions::variant>},
        {"camera=NAME|INDEX", "the camera that a viewer looks through at first; default: the viewer's own view",
         "a name or a number", set<&ImportOptions::camera>},
        {"wholeModel", "meshes that do not move are part of the animated character, too, so that crowds show them", "",
         set<&ImportOptions::wholeModel>},
        {"noCameras", "leave the file's cameras out", "", set<&ImportOptions::noCameras>},
        {"noLights", "leave the file's lights out; default: GL's lights 1 to 7", "", set<&ImportOptions::noLights>},
        {"noRotation", "keep glTF's +Y up; default: +Z up", "", set<&ImportOptions::noRotation>},
        {"allowOutsideFiles", "let a model read files outside its own folder, also for clips", "",
         set<&ImportOptions::allowOutsideFiles>},
        {"maxJsonBytes=N", "bytes of the JSON text, data URIs included; default: 512 MiB", number,
         set<&ImportOptions::maxJsonBytes>},
        {"maxJsonDepth=N", "nesting depth of the JSON; default: 256", number, set<&ImportOptions::maxJsonDepth>},
        {"maxNodeDepth=N",
         system::isWindows ? "nodes from a root to a leaf; default: 512" : "nodes from a root to a leaf; default: 4096",
         number, set<&ImportOptions::maxNodeDepth>},
        {"maxElements=N", "elements of any one array; default: 16777216", number, set<&ImportOptions::maxElements>},
        {"maxDocumentBytes=N", "bytes of nodes, materials, channels ... in memory; default: 448 MiB", number,
         set<&ImportOptions::maxDocumentBytes>},
        {"maxDecodedBytes=N", "bytes of buffers, arrays and pictures, all together; default: 2 GiB", number,
         set<&ImportOptions::maxDecodedBytes>},
    };
    return all;
}

/// True if no more than one letter is wrong, missing, extra or swapped with the next; case does not count.
bool isNearly(const std::string& word, const std::string& option)
{
    const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    auto [a, b] = std::mismatch(word.begin(), word.end(), option.begin(), option.end(), same);
    auto aEnd = word.end(), bEnd = option.end();
    while (aEnd != a && bEnd != b && same(aEnd[-1], bEnd[-1]))
        --aEnd, --bEnd;
    const auto left = aEnd - a, right = bEnd - b; // letters between the common beginning and end
    return (left <= 1 && right <= 1) || (left == 2 && right == 2 && same(a[0], b[1]) && same(a[1], b[0]));
}

} // namespace

const std::vector<OptionHelp>& optionHelp()
{
    static const std::vector<OptionHelp> help = []
    {
        std::vector<OptionHelp> all;
        for (const Option& option : allOptions())
            all.emplace_back(option.usage, option.help);
        return all;
    }();
    return help;
}

std::string optionName(const OptionHelp& help)
{
    const std::string usage = help.first;
    return usage.substr(0, usage.find('='));
}

Result<ImportOptions> parseOptions(const std::string& text)
{
    ImportOptions options;
    for (const OptionWord& word : splitOptions(text))
        for (const Option& option : allOptions())
            if (optionName({option.usage, option.help}) == word.name && !option.set(word.value.value_or(""), options))
                return Error{"option " + word.name + ": " + quoted(word.value.value_or("")) + " is not " +
                             option.wanted};
    return options;
}

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
        const bool needsQuotes = whole.find(' ') != std::string::npos; // OSG's own readers do not know quotation marks
        text += needsQuotes ? '"' + whole + '"' : whole;
    }
    return text;
}

std::vector<std::string> misspeltOptions(const std::string& text, const std::vector<OptionHelp>& known,
                                         const std::vector<OptionHelp>& others)
{
    std::vector<std::string> hints;
    for (const OptionWord& word : splitOptions(text))
    {
        const auto isIt = [&](const OptionHelp& option) { return optionName(option) == word.name; };
        if (std::any_of(known.begin(), known.end(), isIt) || std::any_of(others.begin(), others.end(), isIt)) continue;
        const auto meant =
            std::find_if(known.begin(), known.end(),
                         [&](const OptionHelp& option) { return isNearly(word.name, optionName(option)); });
        if (meant != known.end())
            hints.push_back(quoted(word.name) + " is unknown; is " + quoted(optionName(*meant)) + " meant?");
    }
    return hints;
}

} // namespace osgGpuAnimation::gltf
