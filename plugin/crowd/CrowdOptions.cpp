// SPDX-License-Identifier: MIT
#include "crowd/CrowdOptions.h"

#include "gltf/file/Elements.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace osgGpuAnimation::crowd
{

namespace
{

constexpr const char* ofCrowdsAlone[] = {"clips", "spacing", "seed", "outfits"};
constexpr const char* ofSinglesAlone[] = {"clip", "start", "randomStart", "speed", "loop", "fade"};

/// False if the whole text is not a number.
template <typename Number>
bool readNumber(const std::string& text, Number& out)
{
    const std::optional<Number> number = gltf::parsedNumber<Number>(text);
    if (number) out = *number;
    return number.has_value();
}

Result<void> readSize(const std::string& size, CrowdOptions& out)
{
    const std::size_t cross = size.find_first_of("xX");
    if (cross == std::string::npos || !readNumber(size.substr(0, cross), out.columns) ||
        !readNumber(size.substr(cross + 1), out.rows))
        return Error{gltf::quoted(size) + " is not a size like 40x40 (columns x rows)"};
    if (out.columns == 0 || out.rows == 0) return Error{"a crowd of " + size + " is empty"};
    if (out.rows > AnimatedCrowd::maxInstances / out.columns)
        return Error{"a crowd of " + size + " exceeds the limit of " + std::to_string(AnimatedCrowd::maxInstances) +
                     " instances"};
    return {};
}

/// True for `clips=FILE`, the model's option: the value ends in the extension of a format that has characters. Others
/// are names of clips, with dots, too: `mixamo.com`.
bool namesClipsFile(const gltf::OptionWord& word)
{
    static const std::set<std::string> formats{"glb", "gltf", "fbx",     "bvh",     "dae",  "x",
                                               "smd", "b3d",  "md5mesh", "md5anim", "ms3d", "ogex"};
    return word.name == "clips" && formats.count(osgDB::getLowerCaseFileExtension(word.value.value_or(""))) > 0;
}

/// The values that the option accepts, for messages.
std::string wanted(const std::string& name)
{
    if (name == "seed") return "a whole number from 0 to 4294967295";
    if (name == "spacing") return "a number of units above 0";
    if (name == "pixelError") return LodRange::describePixelErrors();
    if (name == "outfits") return "random or the name of a JSON file";
    return "names or numbers of clips separated by commas";
}

/// False if the option does not accept the value.
bool apply(const gltf::OptionWord& word, CrowdOptions& out)
{
    const std::string value = word.value.value_or("");
    if (word.name == "noRotation") out.isYUp = true;
    if (word.name == "seed") return readNumber(value, out.seed);
    if (word.name == "outfits") return !(out.outfits = value).empty();
    if (word.name == "pixelError")
        return readNumber(value, out.pixelError.emplace()) && LodRange::isPixelError(*out.pixelError);
    if (word.name == "spacing")
        return readNumber(value, out.spacing.emplace()) && std::isfinite(*out.spacing) && *out.spacing > 0.0;
    if (word.name != "clips" || namesClipsFile(word)) return true;
    out.clips.clear();
    std::istringstream clips(value + ',');
    while (std::getline(clips, out.clips.emplace_back(), ','))
        if (out.clips.back().empty()) return false;
    out.clips.pop_back();
    return true;
}

} // namespace

const std::vector<gltf::OptionHelp>& optionHelp()
{
    static const std::vector<gltf::OptionHelp> help = {
        {"clips=NAME|INDEX,...", "the clips to choose from; default: all"},
        {"spacing=UNITS", "distance between neighbours; default: by the bounds"},
        {"pixelError=PIXELS",
         "fewer triangles while the error stays below that size on screen; default: 0, all triangles"},
        {"outfits=FILE.json|random", "the outfits of the instances, see readOutfitsFile(); default: none"},
        {"seed=NUMBER", "seed of the random clips, times and outfits; default: 1"},
        {"noRotation", "keep glTF's +Y up; default: +Z up"},
    };
    return help;
}

std::string modelOptions(const std::string& options)
{
    std::vector<gltf::OptionWord> words = gltf::splitOptions(options);
    const auto isNotTheModels = [](const gltf::OptionWord& word)
    {
        return (gltf::contains(ofCrowdsAlone, word.name) && !namesClipsFile(word)) ||
               gltf::contains(ofSinglesAlone, word.name);
    };
    words.erase(std::remove_if(words.begin(), words.end(), isNotTheModels), words.end());
    return gltf::joinOptions(words);
}

std::vector<std::string> optionHints(const std::string& options)
{
    // The model's reader gives the hints for the options that it shares.
    std::vector<gltf::OptionHelp> own = optionHelp();
    own.erase(std::remove_if(own.begin(), own.end(),
                             [](const gltf::OptionHelp& help)
                             { return !gltf::contains(ofCrowdsAlone, gltf::optionName(help)); }),
              own.end());
    std::vector<std::string> hints = gltf::misspeltOptions(options, own, gltf::optionHelp());
    for (const gltf::OptionWord& word : gltf::splitOptions(options))
        if (gltf::contains(ofSinglesAlone, word.name))
            hints.push_back(gltf::quoted(word.name) +
                            " applies to single characters only and has no effect on a crowd");
    return hints;
}

Result<CrowdOptions> parseCrowd(const std::string& name, const std::string& options)
{
    CrowdOptions crowd;
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0)
        return Error{gltf::quoted(name) + " is not a model's file with a size, like fox.glb.40x40.crowd"};
    crowd.modelFile = name.substr(0, dot);
    const Result<void> size = readSize(name.substr(dot + 1), crowd);
    if (!size) return size.error();
    for (const gltf::OptionWord& word : gltf::splitOptions(options))
        if (!apply(word, crowd))
            return Error{"option " + word.name + ": " + gltf::quoted(word.value.value_or("")) + " is not " +
                         wanted(word.name)};
    return crowd;
}

} // namespace osgGpuAnimation::crowd
