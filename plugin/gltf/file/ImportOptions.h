// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/LoopMode.h>
#include <osgGpuAnimation/authoring/RetargetOptions.h>
#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/CompactedCharacter.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

class Report;
struct ImportOptions;

/// Reads a file of another format as glTF; report: warnings about it. Errors: it cannot.
using OtherFormats = Result<std::string> (*)(const std::string& path, const ImportOptions& options, Report& report);

/// The words for clipMatch, of the plugin's option and the tool's.
constexpr std::pair<const char*, ClipMatch> clipMatches[] = {
    {"auto", ClipMatch::Automatic}, {"byName", ClipMatch::ByName}, {"retarget", ClipMatch::Retarget}};

/// The caller's choices for an import, and the limits that keep a file from any origin harmless.
struct ImportOptions
{
    std::optional<std::string> clip; ///< name, or index where no clip has that name; default: the first
    std::optional<double> start;     ///< seconds, clamped to that clip's duration; default: 0, or its end if speed < 0
    /// Each load starts at another time of the clip; the same seed and order of loads give the same times.
    std::optional<std::uint32_t> randomStart;
    double speed = 1.0; ///< of that clip, see AnimationLayer::setSpeed
    LoopMode loopMode = LoopMode::Loop;
    double fadeSeconds = 0.3;      ///< of the keys' crossfades, see CharacterKeys
    std::optional<double> compact; ///< largest error of compact clips, see CompactedCharacter; above 0; none: exact
    double pixelError = 0.0;       ///< see CharacterMeshes::setPixelError; 0 or more
    /// Files whose clips follow the model's own, see readClipFiles(): relative to the model's folder, else to the
    /// current one; in or below the model's folder, or anywhere with allowOutsideFiles.
    std::vector<std::string> clipsFiles;
    /// A JSON file of joint names for clipsFiles, see readClipFiles(); found as those are. Empty: none.
    std::string clipJoints;
    ClipMatch clipMatch = ClipMatch::Automatic; ///< how the clips of clipsFiles fit the model
    OtherFormats otherFormats = nullptr;        ///< for clipsFiles that are no glTF; null: there is no such reader
    bool allowOutsideClips = false;             ///< clipsFiles and clipJoints alone may be anywhere
    bool noKeys = false;                        ///< no CharacterKeys on the character
    std::optional<int> scene;                   ///< default: the file's own, else 0
    /// Meshes that do not move are part of the character of a file that has one, so that crowds show them.
    bool wholeModel = false;
    bool noLights = false;  ///< leave the file's lights out
    bool noCameras = false; ///< leave the file's cameras out
    /// The camera of a viewer's first view: name, or index where none has that name; default: the viewer's own view
    std::optional<std::string> camera;
    /// The material variant shown at first: name, or index where none has that name; default: none
    std::optional<std::string> variant;
    bool noRotation = false;        ///< keep glTF's +Y up; default: turn to OSG's +Z up at the root
    bool fixedLighting = false;     ///< the fixed pipeline's look: base colours in display space, no other maps
    bool keepEncoded = false;       ///< images keep their PNG or JPEG, for a writer; see keepEncoded()
    bool allowOutsideFiles = false; ///< URIs may name files outside the model's folder

    std::size_t maxJsonBytes = std::size_t(512) << 20; ///< of the JSON text, data URIs included
    std::size_t maxJsonDepth = 256;
    std::size_t maxNodeDepth = osgGpuAnimation::maxNodeDepth; ///< nodes from a root to a leaf
    std::size_t maxElements = 1u << 24;                       ///< of any one array of the document
    std::size_t maxDocumentBytes = std::size_t(448) << 20;    ///< memory for the JSON, without the data it points to
    std::size_t maxDecodedBytes = std::size_t(2) << 30;       ///< see MemoryBudget
};

/// An option for supportsOption(), like `clip=NAME`, and a line of help.
using OptionHelp = std::pair<const char*, const char*>;

/// All options that parseOptions() knows.
const std::vector<OptionHelp>& optionHelp();
/// The option's name: `clip` of `clip=NAME`.
std::string optionName(const OptionHelp& help);

/// Reads osgDB's option string, see splitOptions(). Words with other names belong to other readers and are ignored.
/// Errors: an option without its value, or with a value that it does not accept.
Result<ImportOptions> parseOptions(const std::string& text);

/// One option of osgDB's option string.
struct OptionWord
{
    std::string name;
    std::optional<std::string> value; ///< the text after the first `=`
};

/// The options of a string: words separated by spaces, `name` or `name=value`, a value with spaces in quotation marks
/// (`clip="Walk fast"`).
std::vector<OptionWord> splitOptions(const std::string& text);

/// A string that splitOptions() splits into the same words.
std::string joinOptions(const std::vector<OptionWord>& words);

/// A hint for each word that differs from a known option by its case or by one letter that is wrong, missing, extra or
/// swapped with the next: `"cliq" is unknown; is "clip" meant?`. osgDB passes all options to all readers, so all other
/// words, and the options in `others`, are ignored.
std::vector<std::string> misspeltOptions(const std::string& text, const std::vector<OptionHelp>& known,
                                         const std::vector<OptionHelp>& others = {});

} // namespace osgGpuAnimation::gltf
