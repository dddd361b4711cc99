// SPDX-License-Identifier: MIT
#include "tool/ConvertCommand.h"

#include "gltf/Export.h"
#include "gltf/file/ProgressLine.h"
#include "gltf/scene/ClipFiles.h"
#include "tool/ModelFile.h"

#include <osgGpuAnimation/nodes/mesh/SceneVisitor.h>

#include <osgDB/FileNameUtils>
#include <osgDB/WriteFile>

#include <fstream>
#include <iostream>

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
    CharacterFinder() : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::MatrixTransform& node) override
    {
        if (auto* const character = dynamic_cast<AnimatedCharacter*>(&node)) characters.push_back(character);
        traverse(node);
    }
    std::vector<AnimatedCharacter*> characters;
};

/// What the import does to its own characters.
Result<bool> addClips(osg::Node& scene, const std::string& file, const gltf::ImportOptions& options,
                      gltf::Report& report)
{
    CharacterFinder finder;
    scene.accept(finder);
    const std::vector<gltf::ClipFile> clipFiles = gltf::readClipFiles(file, options, report);
    const gltf::ClipJoints joints = gltf::readClipJoints(file, options, report);
    if (finder.characters.empty() && (!clipFiles.empty() || options.compact))
        report.warn("there is no character; clips stay as they are");
    for (AnimatedCharacter* const character : finder.characters)
    {
        gltf::MemoryBudget budget(options.maxDecodedBytes);
        std::shared_ptr<const AnimationSet> set = character->getController().sharedSet();
        gltf::warnOfUnknownJoints(joints, set->skeleton(), clipFiles, report);
        for (const gltf::ClipFile& each : clipFiles)
            set = gltf::withClipsOf(set, each, joints, budget, report);
        if (!clipFiles.empty())
            if (const Result<bool> changed = character->setAnimationSet(set); !changed) return changed;
        if (!options.compact) continue;
        const Result<CompactedCharacter> compacted = compactClipsOf(*character, *options.compact);
        if (!compacted) return compacted.error();
    }
    return true;
}

/// A scene stays what it is: readModel() would export it to glTF.
Result<Scene> readWithClips(const std::string& file, const gltf::ImportOptions& options)
{
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<Scene> scene = readScene(file, report);
    if (!scene) return scene;
    const Result<bool> added = addClips(*scene.value(), file, options, report);
    printWarnings(file, messages);
    if (!added) return added.error();
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

Result<bool> writeGlb(const osg::Node& scene, const std::string& file)
{
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<std::string> bytes = gltf::exportModel(scene, report);
    printWarnings(file, messages);
    if (!bytes) return bytes.error();
    std::ofstream stream(file, std::ios::binary);
    if (!(stream << bytes.value() << std::flush)) return Error{"cannot be written"};
    return true;
}

} // namespace

Result<bool> ConvertCommand::run() const
{
    const Result<gltf::ImportOptions> given = importOptions(clips, clipJoints);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    if (compact > 0.0) options.compact = compact;
    const bool isGlb = osgDB::getLowerCaseFileExtension(output) == "glb";
    options.keepEncoded = isGlb;
    const Result<Scene> scene = read(file, options);
    if (!scene) return Error{file + ": " + scene.error().message};
    const gltf::ProgressLine progress("writing " + osgDB::getSimpleFileName(output));
    const Result<bool> written = isGlb ? writeGlb(*scene.value(), output)
                                 : osgDB::writeNodeFile(*scene.value(), output)
                                     ? Result<bool>(true)
                                     : Result<bool>(Error{"cannot be written"});
    if (!written) return Error{output + ": " + written.error().message};
    return true;
}

} // namespace osgGpuAnimation::tool
