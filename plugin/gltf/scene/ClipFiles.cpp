// SPDX-License-Identifier: MIT
#include "gltf/scene/ClipFiles.h"

#include "gltf/document/LoadDocument.h"
#include "gltf/file/Uri.h"
#include "gltf/scene/Clips.h"
#include "gltf/scene/Joints.h"
#include "gltf/scene/NodeTree.h"
#include "gltf/scene/TransformBound.h"

#include <osgGpuAnimation/animation/retarget/ClipRetargeter.h>
#include <osgGpuAnimation/animation/retarget/JointNames.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <iterator>
#include <unordered_set>

namespace osgGpuAnimation::gltf
{

namespace
{

bool saysNothing(const std::string& clipName)
{
    return clipName.empty() || clipName.find("mixamo.com") != std::string::npos || clipName == "Take 001";
}

/// The joints, morphs and clips of a file. subject: begins each of its warnings.
Result<std::shared_ptr<const AnimationSet>> readSet(const std::string& path, const ImportOptions& options,
                                                    const std::string& subject, Report& report)
{
    ImportOptions own = options;
    own.scene.reset();
    Messages messages;
    const Result<std::string> bytes =
        own.readClipsFile ? own.readClipsFile(path, own, messages) : readModelFile(path, own);
    if (!bytes) return bytes.error();
    Report ownReport(messages);
    const Result<tinygltf::Model> model = loadDocument(bytes.value(), path, own, messages);
    if (!model) return model.error();
    const Result<NodeTree> tree = buildNodeTree(model.value(), own);
    if (!tree) return tree.error();
    // A joint that no clip moves is a joint nevertheless: without skins, nothing but its name tells.
    std::vector<bool> isPlain;
    for (const tinygltf::Node& node : model.value().nodes)
        isPlain.push_back(node.mesh < 0);
    const Result<Joints> joints = buildJoints(model.value(), tree.value(), isPlain);
    if (!joints) return joints.error();
    const Morphs morphs = readMorphs(model.value());
    MemoryBudget budget(own.maxDecodedBytes);
    Clips clips = readClips(model.value(), joints.value(), morphs, budget, ownReport);
    for (std::size_t clip = 0; clip < clips.clips.size(); ++clip)
        if (saysNothing(model.value().animations[static_cast<std::size_t>(clips.animationOfClip[clip])].name))
            clips.clips[clip] = clips.clips[clip].withName(osgDB::getStrippedName(path));
    for (const std::string& warning : messages.warnings)
        report.warn(subject + ": " + warning);
    if (clips.clips.empty()) return Error{"the file has no clips"};
    return AnimationSet::create({joints.value().skeleton, {}, {}, morphs.weights, std::move(clips.clips)});
}

/// Those of the names that the set's skins use; all, if it has no skins.
std::vector<std::string> namesInSkins(const AnimationSet& set, const std::vector<std::string>& names)
{
    if (set.skins().empty()) return names;
    std::unordered_set<std::string> inSkins;
    for (const Skin& skin : set.skins())
        for (const int joint : skin.joints)
            inSkins.insert(set.skeleton().joint(static_cast<std::size_t>(joint)).name);
    std::vector<std::string> chosen;
    std::copy_if(names.begin(), names.end(), std::back_inserter(chosen),
                 [&](const std::string& name) { return inSkins.count(name) > 0; });
    return chosen;
}

std::string namesText(const std::vector<std::string>& names)
{
    return quotedNames(names, [](const std::string& name) { return printable(name); });
}

} // namespace

std::vector<ClipFile> readClipFiles(const std::string& modelFile, const ImportOptions& options, Report& report)
{
    const ModelFolder folder(modelFile, options.allowOutsideFiles || options.allowOutsideClips);
    std::vector<ClipFile> files;
    std::unordered_set<std::string> known;
    for (const std::string& given : options.clipsFiles)
    {
        const std::string name = "clips " + quoted(given);
        const Result<std::string> path = folder.find(given);
        Result<std::shared_ptr<const AnimationSet>> set = Error{"the file is named twice"};
        if (!path)
            set = path.error();
        else if (known.insert(path.value()).second)
            set = readSet(path.value(), options, name, report);
        if (set)
            files.push_back({name, set.value()});
        else
            report.warn(name + ": " + set.error().message + "; its clips are left out");
    }
    return files;
}

std::vector<bool> nodesMovedBy(const std::vector<ClipFile>& files, const tinygltf::Model& model)
{
    std::unordered_set<std::string> moved;
    for (const ClipFile& file : files)
    {
        const Skeleton& skeleton = file.set->skeleton();
        const std::vector<bool> isMoved = JointMoves::inAnyOf(RestPlaces(skeleton), skeleton, file.set->clips());
        for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
            if (isMoved[joint]) moved.insert(bareJointName(skeleton.joint(joint).name));
    }
    std::vector<bool> nodes(model.nodes.size(), false);
    for (std::size_t node = 0; node < nodes.size(); ++node)
        nodes[node] = !model.nodes[node].name.empty() && moved.count(bareJointName(model.nodes[node].name)) > 0;
    return nodes;
}

std::shared_ptr<const AnimationSet> withClipsOf(const std::shared_ptr<const AnimationSet>& set, const ClipFile& file,
                                                MemoryBudget& budget, Report& report)
{
    const auto refuse = [&](const std::string& why)
    {
        report.warn(file.name + ": " + why + "; its clips are left out");
        return set;
    };
    std::size_t bytes = 0;
    for (const Clip& clip : file.set->clips())
        bytes += clip.keyframeCount() * clip.transformsPerTrack() * set->trackCount() * sizeof(JointTransform);
    if (!budget.take(bytes))
        return refuse("its clips would take " + std::to_string(bytes) + " bytes, " + budget.limitText());
    const Result<RetargetedSet> result = set->withClipsOf(*file.set);
    if (!result) return refuse(result.error().message);

    const std::vector<std::string> atRest = namesInSkins(*set, result.value().atRest);
    const std::vector<std::string>& leftOut = result.value().leftOut;
    if (!atRest.empty()) report.warn(file.name + ": has no counterpart for " + namesText(atRest) + "; kept at rest");
    if (!leftOut.empty()) report.warn(file.name + ": the model has no counterpart for " + namesText(leftOut));
    std::vector<Clip> clips = set->clips();
    for (std::size_t clip = clips.size(); clip < result.value().set->clips().size(); ++clip)
    {
        const Clip& made = result.value().set->clips()[clip];
        if (fits(set->skeleton(), made))
            clips.push_back(made);
        else
            report.warn(file.name + ": clip " + quoted(made.name()) + " takes joints or weights " + beyondFarthest() +
                        "; clip skipped");
    }
    if (clips.size() == result.value().set->clips().size()) return result.value().set;
    Result<std::shared_ptr<const AnimationSet>> rest = set->withClips(std::move(clips));
    return rest ? rest.value() : set;
}

} // namespace osgGpuAnimation::gltf
