// SPDX-License-Identifier: MIT
#include "tool/ConvertCommand.h"

#include "gltf/Export.h"
#include "gltf/file/ProgressLine.h"
#include "gltf/file/SavedFile.h"
#include "gltf/scene/ClipFiles.h"
#include "tool/ModelFile.h"

#include <osgGpuAnimation/nodes/mesh/SceneVisitor.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>
#include <osgDB/XmlParser>

#include <algorithm>
#include <iostream>
#include <sstream>

namespace osgGpuAnimation::tool
{

namespace
{

using Scene = osg::ref_ptr<osg::Node>;

void printWarnings(const std::string& file, const gltf::Messages& messages)
{
    for (const std::string& warning : messages.warnings)
        std::cerr << "osggpuanim: " << file << ": " << warning << std::endl;
}

class CharacterFinder : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    CharacterFinder() : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::MatrixTransform& node) override
    {
        if (auto* const character = dynamic_cast<AnimatedCharacter*>(&node)) characters.push_back(character);
        traverse(node);
    }
    std::vector<AnimatedCharacter*> characters;
};

/// What the import does to its own characters. Error: what was asked for is not done.
Result<bool> addClips(osg::Node& scene, const std::string& file, const gltf::ImportOptions& options,
                      gltf::Messages& messages)
{
    gltf::Report report(messages);
    CharacterFinder finder;
    scene.accept(finder);
    const std::vector<gltf::ClipFile> clipFiles = gltf::readClipFiles(file, options, report);
    const gltf::ClipJoints joints = gltf::readClipJoints(file, options, report);
    if (!messages.unmet.empty()) return Error{messages.unmet.front()};
    if (finder.characters.empty() && (!clipFiles.empty() || options.compact))
        return Error{"there is no character whose clips could be changed"};
    std::vector<bool> isAdded(clipFiles.size(), false); // to one of the characters, at least
    for (AnimatedCharacter* const character : finder.characters)
    {
        gltf::MemoryBudget budget(options.maxDecodedBytes);
        std::shared_ptr<const AnimationSet> set = character->getController().sharedSet();
        gltf::warnOfUnknownJoints(joints, set->skeleton(), clipFiles, report);
        for (std::size_t i = 0; i < clipFiles.size(); ++i)
        {
            const std::shared_ptr<const AnimationSet> before = set;
            set = gltf::withClipsOf(before, clipFiles[i], joints, budget, report);
            if (set != before) isAdded[i] = true;
        }
        if (!clipFiles.empty())
            if (const Result<bool> changed = character->setAnimationSet(set); !changed) return changed;
        if (!options.compact) continue;
        const Result<CompactedCharacter> compacted = compactClipsOf(*character, *options.compact);
        if (!compacted) return compacted.error();
    }
    if (std::find(isAdded.begin(), isAdded.end(), false) != isAdded.end()) return Error{messages.unmet.front()};
    return true;
}

/// A scene stays what it is: readModel() would export it to glTF.
Result<Scene> readWithClips(const std::string& file, const gltf::ImportOptions& options)
{
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<Scene> scene = readScene(file, report);
    if (!scene) return scene;
    const Result<bool> added = addClips(*scene.value(), file, options, messages);
    if (!added) return added.error();
    printWarnings(file, messages);
    return scene;
}

Result<Scene> read(const std::string& file, const gltf::ImportOptions& options)
{
    if (!isModelFormat(file)) return readWithClips(file, options);
    const Result<gltf::ImportedModel> model = readModel(file, options);
    if (!model) return model.error();
    printWarnings(file, model.value().messages);
    return Scene(model.value().root);
}

Result<std::string> glbOf(const osg::Node& scene, const std::string& file)
{
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<std::string> bytes = gltf::exportModel(scene, report);
    printWarnings(file, messages);
    return bytes;
}

/// Collects the classes that OSG's writers leave out: they warn and succeed.
class LostClasses : public osg::NotifyHandler
{
public:
    void notify(osg::NotifySeverity severity, const char* text) override
    {
        const std::string message = osgDB::trimEnclosingSpaces(text);
        if (message.find("Unsupported") == std::string::npos) // "...: Unsupported wrapper class NAME"
            before->notify(severity, text);
        else
            names.push_back(message.substr(message.rfind(' ') + 1));
    }

    const osg::ref_ptr<osg::NotifyHandler> before = osg::getNotifyHandler();
    std::vector<std::string> names; ///< `osgGpuAnimation::AnimatedCharacter`
};

/// The scene in the format of OSG's with that extension. Errors: there is no such writer, it fails, or it leaves
/// something out.
Result<std::string> osgFileOf(const osg::Node& scene, const std::string& extension)
{
    osgDB::ReaderWriter* const format = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (!format) return Error{"OSG's plugin for ." + extension + " is not found"};
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("fileType", extension == "osgb" ? "Binary" : extension == "osgt" ? "Ascii" : "XML");
    const osg::NotifySeverity level = osg::getNotifyLevel();
    const osg::ref_ptr<LostClasses> lost = new LostClasses;
    osg::setNotifyLevel(std::max(level, osg::WARN));
    osg::setNotifyHandler(lost);
    std::ostringstream stream;
    const osgDB::ReaderWriter::WriteResult written = format->writeNode(scene, stream, options);
    osg::setNotifyHandler(lost->before);
    osg::setNotifyLevel(level);
    if (!written.success()) return Error{"OSG cannot write it: " + written.message()};
    if (lost->names.empty()) return stream.str();
    const std::string& name = lost->names.front();
    return Error{"OSG cannot write " + name + "; expected the plugin osgdb_serializers_" +
                 osgDB::convertToLowerCase(name.substr(0, name.find(':'))) +
                 " in the library path (OSG_LIBRARY_PATH), found none"};
}

} // namespace

Result<bool> ConvertCommand::run() const
{
    const Result<gltf::ImportOptions> given = importOptions(clips, clipJoints);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    if (compact > 0.0) options.compact = compact;
    const std::string extension = osgDB::getLowerCaseFileExtension(output);
    options.keepEncoded = extension == "glb";
    const Result<Scene> scene = read(file, options);
    if (!scene) return Error{file + ": " + scene.error().message};
    const gltf::ProgressLine progress("writing " + osgDB::getSimpleFileName(output));
    const Result<std::string> bytes =
        extension == "glb" ? glbOf(*scene.value(), output) : osgFileOf(*scene.value(), extension);
    if (!bytes) return Error{output + ": " + bytes.error().message};
    const Result<bool> saved = gltf::saveFile(output, bytes.value());
    if (!saved) return Error{output + ": " + saved.error().message};
    return true;
}

} // namespace osgGpuAnimation::tool
