// SPDX-License-Identifier: MIT
#include "gltf/import/ClipFiles.h"

#include "gltf/data/LoadDocument.h"
#include "gltf/document/JsonReader.h"
#include "gltf/file/Elements.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/file/Uri.h"
#include "gltf/import/Clips.h"
#include "gltf/import/Joints.h"
#include "gltf/import/NodeTree.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/authoring/retarget/JointNames.h>
#include <osgGpuAnimation/authoring/retarget/RigMatch.h>
#include <osgGpuAnimation/authoring/WithClipsOf.h>
#include <osgGpuAnimation/nodes/properties/PropertyPointer.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t maxNameBytes = std::size_t(1) << 20; // of a file of joint names

/// By its name or its first bytes. What is no regular file counts as one: reading it has the message.
bool isGltf(const std::string& path)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    const Result<RegularFile> file = RegularFile::open(path);
    char beginning[4] = {};
    if (extension == "gltf" || extension == "glb" || !file || !file.value().read(beginning, sizeof beginning))
        return true;
    return std::string_view(beginning, sizeof beginning) == "glTF" || beginning[0] == '{';
}

/// The file as glTF. subject: begins each warning.
Result<std::string> readAsGltf(const std::string& path, const ImportOptions& options, const std::string& subject,
                               Report& report)
{
    if (!options.otherFormats || isGltf(path)) return readModelFile(path, options);
    Messages messages;
    Report ownReport(messages);
    Result<std::string> bytes = options.otherFormats(path, options, ownReport);
    for (const std::string& warning : messages.warnings)
        if (warning.rfind("picture ", 0) != 0) report.warn(subject + ": " + warning); // clips need no pictures
    return bytes;
}

/// The names of the objects that have such properties, by number.
std::vector<std::string> objectNames(const tinygltf::Model& model, PropertyMember::Object object)
{
    using Object = PropertyMember::Object;
    return object == Object::Material ? namesIn(model.materials)
           : object == Object::Light  ? namesIn(model.lights)
           : object == Object::Camera ? namesIn(model.cameras)
                                      : namesIn(model.nodes);
}

/// The pointer to the same property of the model's object of the same name. If there is none, a text that names no
/// property. Objects without names are matched by number.
std::string pointerIn(const tinygltf::Model& model, const tinygltf::Model& file, const std::string& pointer)
{
    const std::optional<PropertyPointer> property = PropertyPointer::parse(pointer);
    if (!property) return pointer;
    const auto index = static_cast<std::size_t>(property->index);
    const std::vector<std::string> names = objectNames(file, property->member->object);
    const std::vector<std::string> others = objectNames(model, property->member->object);
    const int counterpart = findCounterparts(names, others, {})[index];
    if (counterpart >= 0) return PropertyPointer::text(*property->member, counterpart);
    if (!names[index].empty()) return pointer + " of " + names[index];
    return index < others.size() && others[index].empty() ? pointer : pointer + " without a name";
}

/// The joints, morphs and clips of a file. target: see readClipFiles(). subject: begins each of the file's warnings.
Result<std::shared_ptr<const AnimationSet>> readSet(const std::string& path, const ImportOptions& options,
                                                    const tinygltf::Model* target, const std::string& subject,
                                                    Report& report)
{
    ImportOptions own = options;
    own.scene.reset();
    const Result<std::string> bytes = readAsGltf(path, own, subject, report);
    if (!bytes) return bytes.error();
    Messages messages;
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
    Morphs morphs = readMorphs(model.value());
    MemoryBudget budget(own.maxDecodedBytes);
    const std::string fileName = osgDB::getStrippedName(path);
    Clips clips = readClips(model.value(), joints.value(), morphs, fileName, budget, ownReport);
    for (std::size_t clip = 0; clip < clips.clips.size(); ++clip)
        if (elementOf(model.value().animations, clips.animationOfClip[clip]).name.empty())
            clips.clips[clip] = clips.clips[clip].withName(fileName);
    for (MorphWeights& morph : morphs.weights)
        if (target && morph.isProperty()) morph.name = pointerIn(*target, model.value(), morph.name);
    for (const std::string& warning : messages.warnings)
        report.warn(subject + ": " + warning);
    if (clips.clips.empty()) return Error{"the file has no clips"};
    return AnimationSet::create({joints.value().skeleton, {}, {}, morphs.weights, std::move(clips.clips)});
}

/// Those of the names that the set's skins use; if it has no skins, all that are not empty.
std::vector<std::string> namesInSkins(const AnimationSet& set, const std::vector<std::string>& names)
{
    const bool isSkinned = !set.skins().empty();
    std::unordered_set<std::string> inSkins;
    for (const Skin& skin : set.skins())
        for (const int joint : skin.joints)
            inSkins.insert(set.skeleton().joint(static_cast<std::size_t>(joint)).name);
    std::vector<std::string> chosen;
    std::copy_if(names.begin(), names.end(), std::back_inserter(chosen),
                 [&](const std::string& name) { return isSkinned ? inSkins.count(name) > 0 : !name.empty(); });
    return chosen;
}

/// The joints of the clips that are given for joints of the model.
std::map<std::string, std::string> givenFor(const std::vector<std::string>& names, const Skeleton& clips,
                                            const ClipJoints& joints)
{
    std::vector<std::string> own, wanted;
    for (const std::string& name : names)
    {
        const auto given = joints.counterparts.find(bareJointName(name));
        if (given == joints.counterparts.end() || name.empty()) continue;
        own.push_back(name);
        wanted.push_back(given->second);
    }
    const std::vector<int> found = findCounterparts(wanted, namesIn(clips.joints()), {});
    std::map<std::string, std::string> counterparts;
    for (std::size_t i = 0; i < own.size(); ++i)
        if (found[i] >= 0 || wanted[i].empty())
            counterparts[own[i]] = found[i] < 0 ? "" : clips.joint(static_cast<std::size_t>(found[i])).name;
    return counterparts;
}

void removeJoints(std::vector<std::string>& names, const Skeleton& skeleton)
{
    const std::vector<int> found = findCounterparts(names, namesIn(skeleton.joints()), {});
    std::size_t kept = 0;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (found[i] < 0) std::swap(names[kept++], names[i]);
    names.resize(kept);
}

void noteMatch(const std::string& name, const RetargetedSet& result, Report& report)
{
    const auto differ = [&](std::size_t joints)
    { return name + ": the rest pose differs from the model's (" + std::to_string(joints) + " joints); "; };
    if (result.byName > 0)
        report.note(differ(result.byName) +
                    "it is the first frame of a clip, so the joints move as they do in the file: "
                    "clipMatch=byName");
    if (result.retargeted > 0)
        report.note(differ(result.retargeted) + "the joints keep their difference from it: clipMatch=retarget");
}

Result<JsonTree> readNames(const ModelFolder& folder, const ImportOptions& options, Report& report)
{
    const Result<std::string> path = folder.find(options.clipJoints);
    if (!path) return path.error();
    ImportOptions own = options;
    own.maxJsonBytes = std::min(own.maxJsonBytes, maxNameBytes);
    const Result<std::string> bytes = readModelFile(path.value(), own);
    return bytes ? readJson(bytes.value(), own, report) : bytes.error();
}

} // namespace

ClipJoints readClipJoints(const std::string& modelFile, const ImportOptions& options, Report& report)
{
    ClipJoints joints;
    if (options.clipJoints.empty()) return joints;
    joints.name = "clipJoints " + quoted(options.clipJoints);
    const ModelFolder folder(modelFile, options.allowOutsideFiles || options.allowOutsideClips);
    Result<JsonTree> read = readNames(folder, options, report);
    if (!read)
    {
        report.unmet(joints.name + ": " + read.error().message, "joints are matched by their names");
        return joints;
    }
    JsonTree tree = std::move(read).value();
    for (const JsonValue& member : tree.root())
    {
        const bool isNone = member.is(JsonTree::Type::Null);
        if (isNone || member.is(JsonTree::Type::String))
            joints.counterparts[bareJointName(std::string(member.key()))] = isNone ? "" : member.text();
        else
            report.warn(
                fault(joints.name + ": " + quoted(member.key()), "the name of a joint or null", member.description())
                    .message +
                "; left out");
    }
    return joints;
}

void warnOfUnknownJoints(const ClipJoints& joints, const Skeleton& model, const std::vector<ClipFile>& files,
                         Report& report)
{
    std::unordered_set<std::string> own;
    for (const Joint& joint : model.joints())
        own.insert(bareJointName(joint.name));
    std::vector<std::string> notOwn, notOthers;
    for (const auto& [name, counterpart] : joints.counterparts)
    {
        if (own.count(name) == 0) notOwn.push_back(name);
        if (!counterpart.empty()) notOthers.push_back(counterpart);
    }
    for (const ClipFile& file : files)
        removeJoints(notOthers, file.set->skeleton());
    if (!notOwn.empty()) report.warn(joints.name + ": the model has no joint " + namesText(notOwn));
    if (!notOthers.empty()) report.warn(joints.name + ": no file of clips has a joint " + namesText(notOthers));
}

std::vector<ClipFile> readClipFiles(const std::string& modelFile, const ImportOptions& options, Report& report,
                                    const tinygltf::Model* target)
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
            set = readSet(path.value(), options, target, name, report);
        if (set)
            files.push_back({name, set.value()});
        else
            report.unmet(name + ": " + set.error().message, leftOutText);
    }
    return files;
}

std::vector<bool> nodesMovedBy(const std::vector<ClipFile>& files, const ClipJoints& joints,
                               const tinygltf::Model& model)
{
    std::vector<bool> nodes(model.nodes.size(), false);
    const std::vector<std::string> names = namesIn(model.nodes);
    for (const ClipFile& file : files)
    {
        const Skeleton& skeleton = file.set->skeleton();
        const std::vector<std::string> others = namesIn(skeleton.joints());
        const std::vector<bool> isMoved = movedJoints(skeleton, file.set->clips());
        std::unordered_set<std::string> moved; // which of several nodes with one name is a joint is not known yet
        for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
            if (isMoved[joint]) moved.insert(caselessJointName(others[joint]));
        const std::vector<int> found = findCounterparts(names, others, givenFor(names, skeleton, joints), true);
        for (std::size_t node = 0; node < nodes.size(); ++node)
            if (found[node] >= 0 && moved.count(caselessJointName(others[static_cast<std::size_t>(found[node])])) > 0)
                nodes[node] = true;
    }
    return nodes;
}

Result<std::shared_ptr<const AnimationSet>> withClipsOf(const std::shared_ptr<const AnimationSet>& set,
                                                        const ClipFile& file, const ClipJoints& joints, ClipMatch match,
                                                        MemoryBudget& budget, Report& report)
{
    const auto refuse = [&](const std::string& why) { return Error{file.name + ": " + why}; };
    std::size_t bytes = 0;
    for (const Clip& clip : file.set->clips())
        bytes += clip.keyframeCount() * clip.transformsPerTrack() * set->trackCount() * sizeof(JointTransform);
    if (!budget.take(bytes))
        return refuse("its clips would take " + std::to_string(bytes) + " bytes, " + budget.limitText());
    RetargetOptions options;
    options.counterparts = givenFor(namesIn(set->skeleton().joints()), file.set->skeleton(), joints);
    options.match = match;
    const Result<RetargetedSet> result = osgGpuAnimation::withClipsOf(*set, *file.set, options);
    if (!result) return refuse(result.error().message);
    if (match == ClipMatch::Automatic) noteMatch(file.name, result.value(), report);

    const std::vector<std::string> atRest = namesInSkins(*set, result.value().atRest);
    const std::vector<std::string>& leftOut = result.value().leftOut;
    std::vector<Clip> clips = set->clips();
    const auto& all = result.value().set->clips();
    const auto firstAdded = all.begin() + static_cast<std::ptrdiff_t>(clips.size());
    if (!set->skins().empty() && (set->morphs().empty() || file.set->morphs().empty()) &&
        atRest.size() == namesInSkins(*set, namesIn(set->skeleton().joints())).size() &&
        movedJoints(set->skeleton(), {firstAdded, all.end()}) == std::vector<bool>(set->skeleton().jointCount()))
        return refuse("no joint of a skin has a counterpart: they are " + namesText(atRest) +
                      "; those of the clips are " + namesText(leftOut) +
                      "; clipJoints=FILE (--clip-joints) names counterparts");
    if (!atRest.empty())
        report.warn(file.name + ": they have no counterpart for " + namesText(atRest) + "; kept at rest");
    if (!leftOut.empty()) report.warn(file.name + ": the model has no counterpart for " + namesText(leftOut));
    for (auto made = firstAdded; made != all.end(); ++made)
        if (fits(set->skeleton(), *made))
            clips.push_back(*made);
        else
            report.warn(file.name + ": clip " + quoted(made->name()) + " takes joints or weights " + outOfRangeText() +
                        "; clip skipped");
    if (clips.size() == all.size()) return result.value().set;
    if (clips.size() == set->clips().size()) return refuse("none of its clips can be played");
    Result<std::shared_ptr<const AnimationSet>> rest = set->withClips(std::move(clips));
    return rest ? rest : refuse(rest.error().message);
}

} // namespace osgGpuAnimation::gltf
