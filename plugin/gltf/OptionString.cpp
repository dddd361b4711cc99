// SPDX-License-Identifier: MIT
#include "gltf/OptionString.h"

#include "gltf/ElementName.h"
#include "gltf/OptionWord.h"

#include <charconv>

namespace osgGpuAnimation::gltf
{

namespace
{

/// False where the text is not a whole number from 0 to what Number holds.
template <typename Number>
bool readNumber(const std::string& text, Number& out)
{
    Number number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc() || end != text.data() + text.size() || !(number >= 0)) return false;
    out = number;
    return true;
}

/// False where the value does not fit the option.
bool apply(const OptionWord& word, ImportOptions& options)
{
    const std::string value = word.value.value_or("");
    if (word.name == "noRotation")
        options.noRotation = true;
    else if (word.name == "allowOutsideFiles")
        options.allowOutsideFiles = true;
    else if (word.name == "clip")
        options.clip = value;
    else if (word.name == "scene")
        return readNumber(value, options.scene.emplace());
    else if (word.name == "maxJsonDepth")
        return readNumber(value, options.maxJsonDepth);
    else if (word.name == "maxNodeDepth")
        return readNumber(value, options.maxNodeDepth);
    else if (word.name == "maxElements")
        return readNumber(value, options.maxElements);
    else if (word.name == "maxDecodedBytes")
        return readNumber(value, options.maxDecodedBytes);
    return word.name != "clip" || !value.empty();
}

} // namespace

const std::vector<OptionHelp>& optionHelp()
{
    static const std::vector<OptionHelp> help = {
        {"clip=NAME|INDEX", "the clip that plays at first, by name or by number; default: the first"},
        {"scene=INDEX", "the scene to show; default: the file's own"},
        {"noRotation", "keep glTF's +Y up; default: +Z up"},
        {"allowOutsideFiles", "let a model read files outside its own folder"},
        {"maxJsonDepth=N", "how deep JSON may nest; default: 256"},
        {"maxNodeDepth=N", "nodes from a root to a leaf; default: 4096"},
        {"maxElements=N", "elements of any one array; default: 16777216"},
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
            return Error{"option " + word.name + ": " + quoted(word.value.value_or("")) + " is not a value for it"};
    }
    return options;
}

} // namespace osgGpuAnimation::gltf
