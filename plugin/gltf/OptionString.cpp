// SPDX-License-Identifier: MIT
#include "gltf/OptionString.h"

#include "gltf/ElementName.h"
#include "gltf/OptionWord.h"
#include "gltf/ParsedNumber.h"

#include <osgGpuAnimation/nodes/DetailRange.h>

#include <cmath>
#include <optional>

namespace osgGpuAnimation::gltf
{

namespace
{

/// False where the text is not a whole number from 0 to what Number holds.
template <typename Number>
bool readNumber(const std::string& text, Number& out)
{
    const std::optional<Number> number = parsedNumber<Number>(text);
    if (!number || !(*number >= 0)) return false;
    out = *number;
    return true;
}

/// False where the text is not a finite number.
bool readFinite(const std::string& text, double& out)
{
    const std::optional<double> number = parsedNumber<double>(text);
    if (!number || !std::isfinite(*number)) return false;
    out = *number;
    return true;
}

bool readLoopMode(const std::string& text, LoopMode& out)
{
    const std::pair<const char*, LoopMode> modes[] = {
        {"once", LoopMode::Once}, {"loop", LoopMode::Loop}, {"pingpong", LoopMode::PingPong}};
    for (const auto& [name, mode] : modes)
    {
        if (text != name) continue;
        out = mode;
        return true;
    }
    return false;
}

/// Of those that say how the first clip plays. Nothing where the word is none of them.
std::optional<bool> applyPlaying(const std::string& name, const std::string& value, ImportOptions& options)
{
    if (name == "speed") return readFinite(value, options.speed);
    if (name == "start") return readFinite(value, options.start.emplace()) && *options.start >= 0.0;
    if (name == "loop") return readLoopMode(value, options.loopMode);
    if (name == "fade") return readFinite(value, options.fadeSeconds) && options.fadeSeconds >= 0.0;
    return std::nullopt;
}

/// What a value of the option must be.
std::string wanted(const std::string& name)
{
    if (name == "compact") return "a number above 0, at most 1";
    if (name == "pixelError") return DetailRange::pixelErrorsTaken();
    if (name == "speed") return "a number";
    if (name == "start" || name == "fade") return "a number of seconds, 0 or more";
    if (name == "loop") return "once, loop or pingpong";
    return name == "clip" ? "a name or a number" : "a whole number that is not too large";
}

/// False where the value does not fit the option.
bool apply(const OptionWord& word, ImportOptions& options)
{
    const std::string value = word.value.value_or("");
    if (const std::optional<bool> fits = applyPlaying(word.name, value, options)) return *fits;
    if (word.name == "compact")
        return readFinite(value, options.compact.emplace()) && *options.compact > 0.0 && *options.compact <= 1.0;
    if (word.name == "pixelError")
        return readFinite(value, options.pixelError) && DetailRange::isPixelError(options.pixelError);
    if (word.name == "noRotation")
        options.noRotation = true;
    else if (word.name == "noKeys")
        options.noKeys = true;
    else if (word.name == "allowOutsideFiles")
        options.allowOutsideFiles = true;
    else if (word.name == "clip")
        options.clip = value;
    else if (word.name == "scene")
        return readNumber(value, options.scene.emplace());
    else if (word.name == "maxJsonBytes")
        return readNumber(value, options.maxJsonBytes);
    else if (word.name == "maxJsonDepth")
        return readNumber(value, options.maxJsonDepth);
    else if (word.name == "maxNodeDepth")
        return readNumber(value, options.maxNodeDepth);
    else if (word.name == "maxElements")
        return readNumber(value, options.maxElements);
    else if (word.name == "maxDocumentBytes")
        return readNumber(value, options.maxDocumentBytes);
    else if (word.name == "maxDecodedBytes")
        return readNumber(value, options.maxDecodedBytes);
    return word.name != "clip" || !value.empty();
}

} // namespace

const std::vector<OptionHelp>& optionHelp()
{
    static const std::vector<OptionHelp> help = {
        {"clip=NAME|INDEX", "the clip that plays at first, by name or by number; default: the first"},
        {"start=SECONDS", "where in that clip to begin; beyond its end: at its end"},
        {"speed=NUMBER", "how fast it plays; negative: backwards; default: 1"},
        {"loop=once|loop|pingpong", "what it does at its end; default: loop"},
        {"fade=SECONDS", "how long the keys' crossfades take; default: 0.3"},
        {"compact=FRACTION", "smaller clips, off by at most that fraction of the model's longest side; default: exact"},
        {"pixelError=PIXELS", "fewer triangles where that hides how far they are off; default: 0, all triangles"},
        {"noKeys", "no keys for viewers on the character; default: n N k . , - + r j"},
        {"scene=INDEX", "the scene to show; default: the file's own"},
        {"noRotation", "keep glTF's +Y up; default: +Z up"},
        {"allowOutsideFiles", "let a model read files outside its own folder"},
        {"maxJsonBytes=N", "bytes of the JSON text, data URIs and all; default: 512 MiB"},
        {"maxJsonDepth=N", "how deep JSON may nest; default: 256"},
        {"maxNodeDepth=N", "nodes from a root to a leaf; default: 4096"},
        {"maxElements=N", "elements of any one array; default: 16777216"},
        {"maxDocumentBytes=N", "bytes of nodes, materials, channels ... in memory; default: 448 MiB"},
        {"maxDecodedBytes=N", "bytes of buffers, arrays and pictures, all together; default: 2 GiB"},
    };
    return help;
}

Result<ImportOptions> parseOptions(const std::string& text)
{
    ImportOptions options;
    for (const OptionWord& word : splitOptions(text))
    {
        if (!apply(word, options))
            return Error{"option " + word.name + ": " + quoted(word.value.value_or("")) + " is not " +
                         wanted(word.name)};
    }
    return options;
}

} // namespace osgGpuAnimation::gltf
