// SPDX-License-Identifier: MIT
#include "tool/Commands.h"

#include "gltf/Export.h"
#include "gltf/file/SavedFile.h"
#include "gltf/import/ClipFiles.h"

#include <osgGpuAnimation/nodes/CompactedCharacter.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>
#include <osgDB/XmlParser>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace osgGpuAnimation::tool
{

namespace
{

using Scene = osg::ref_ptr<osg::Node>;

/// Hidden ones, too.
std::vector<AnimatedCharacter*> charactersIn(osg::Node& scene)
{
    std::vector<AnimatedCharacter*> characters;
    const auto take = [&](osg::Node& node)
    {
        if (auto* const character = dynamic_cast<AnimatedCharacter*>(&node)) characters.push_back(character);
        return false;
    };
    visitUntil(scene, take, ~0u);
    return characters;
}

/// What the import does to its own characters. Error: what was asked for is not done, for example no character takes
/// the clips of a file.
Result<void> addClips(osg::Node& scene, const std::string& file, const gltf::ImportOptions& options,
                      gltf::Messages& messages)
{
    gltf::Report report(messages);
    const std::vector<AnimatedCharacter*> characters = charactersIn(scene);
    const std::vector<gltf::ClipFile> clipFiles = gltf::readClipFiles(file, options, report);
    const gltf::ClipJoints joints = gltf::readClipJoints(file, options, report);
    if (!messages.unmet.empty()) return Error{messages.unmet.front()};
    if (characters.empty() && (!clipFiles.empty() || options.compact))
        return Error{"there is no character whose clips could be changed"};
    std::vector<bool> isAdded(clipFiles.size(), false);  // to one of the characters, at least
    std::vector<std::string> refusals(clipFiles.size()); // by the first character that refuses
    for (AnimatedCharacter* const character : characters)
    {
        gltf::MemoryBudget budget(options.maxDecodedBytes);
        std::shared_ptr<const AnimationSet> set = character->getController().sharedSet();
        gltf::warnOfUnknownJoints(joints, set->skeleton(), clipFiles, report);
        for (std::size_t i = 0; i < clipFiles.size(); ++i)
        {
            const auto with = gltf::withClipsOf(set, clipFiles[i], joints, options.clipMatch, budget, report);
            if (with)
            {
                set = with.value();
                isAdded[i] = true;
                continue;
            }
            report.warn(with.error().message + "; " + gltf::leftOutText);
            if (refusals[i].empty()) refusals[i] = with.error().message;
        }
        if (!clipFiles.empty())
            if (const Result<void> changed = character->setAnimationSet(set); !changed) return changed;
        if (!options.compact) continue;
        const Result<CompactedCharacter> compacted = compactClipsOf(*character, *options.compact);
        if (!compacted) return compacted.error();
    }
    for (std::size_t i = 0; i < clipFiles.size(); ++i)
        if (!isAdded[i]) return Error{refusals[i]};
    return {};
}

Result<Scene> read(const std::string& file, const gltf::ImportOptions& options)
{
    if (isModelFormat(file))
    {
        const Result<gltf::ImportedModel> model = readModel(file, options);
        if (!model) return model.error();
        printWarnings(file, model.value().messages);
        return Scene(model.value().root);
    }
    // A scene stays what it is: readModel() would export it to glTF.
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<Scene> scene = readScene(file, report);
    if (!scene) return scene;
    const Result<void> added = addClips(*scene.value(), file, options, messages);
    printWarnings(file, messages, added ? "" : added.error().message);
    return added ? scene : Result<Scene>(added.error());
}

Result<std::string> glbOf(const osg::Node& scene, const std::string& file, const std::string& output)
{
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<std::string> bytes = exportScene(scene, file, report);
    printWarnings(output, messages);
    return bytes;
}

/// Collects the warnings of OSG's writers, which leave something out, warn, and succeed.
class WriterWarnings : public osg::NotifyHandler
{
public:
    void notify(osg::NotifySeverity severity, const char* text) override
    {
        if (severity != osg::WARN && severity != osg::FATAL) return before->notify(severity, text);
        const std::string warning = osgDB::trimEnclosingSpaces(text);
        if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
    }

    /// One at least: an error of them.
    Error error() const
    {
        const std::string unsupported = "Unsupported wrapper class ";
        if (const std::size_t place = warnings.front().find(unsupported); place != std::string::npos)
        {
            const std::string name = warnings.front().substr(place + unsupported.size());
            return {"OSG cannot write " + name + ": is osgdb_serializers_" +
                    osgDB::convertToLowerCase(name.substr(0, name.find(':'))) +
                    " in the library path (OSG_LIBRARY_PATH)?"};
        }
        std::string text = "OSG's writer warns";
        for (std::size_t i = 0; i < std::min<std::size_t>(warnings.size(), 3); ++i)
            text += (i == 0 ? ": " : "; ") + warnings[i];
        return {text};
    }

    const osg::ref_ptr<osg::NotifyHandler> before = osg::getNotifyHandler();
    std::vector<std::string> warnings; ///< each once
};

/// The scene in the format of OSG's with that extension. Errors: there is no such writer, it fails, or it warns.
Result<std::string> osgFileOf(const osg::Node& scene, const std::string& extension)
{
    osgDB::ReaderWriter* const format = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (!format) return Error{"OSG's plugin for ." + extension + " is not found"};
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("fileType", extension == "osgb" ? "Binary" : extension == "osgt" ? "Ascii" : "XML");
    const osg::NotifySeverity level = osg::getNotifyLevel();
    const osg::ref_ptr<WriterWarnings> warned = new WriterWarnings;
    osg::setNotifyLevel(std::max(level, osg::WARN));
    osg::setNotifyHandler(warned);
    std::ostringstream stream;
    const osgDB::ReaderWriter::WriteResult written = format->writeNode(scene, stream, options);
    osg::setNotifyHandler(warned->before);
    osg::setNotifyLevel(level);
    if (!written.success()) return Error{"OSG cannot write it: " + written.message()};
    if (!warned->warnings.empty()) return warned->error();
    return stream.str();
}

} // namespace

Result<void> ConvertCommand::run() const
{
    std::error_code missing;
    if (std::filesystem::equivalent(file, output, missing))
        return Error{output + ": it is the file to convert, which would be lost; name another output"};
    const Result<gltf::ImportOptions> given = importOptions(*this);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    const std::string extension = osgDB::getLowerCaseFileExtension(output);
    options.keepEncoded = extension == "glb";
    const Result<Scene> scene = read(file, options);
    if (!scene) return Error{file + ": " + scene.error().message};
    const Result<std::string> bytes =
        extension == "glb" ? glbOf(*scene.value(), file, output) : osgFileOf(*scene.value(), extension);
    if (!bytes) return Error{output + ": " + bytes.error().message};
    const Result<void> saved = gltf::saveFile(output, bytes.value());
    if (!saved) return Error{output + ": " + saved.error().message};
    return {};
}

} // namespace osgGpuAnimation::tool
