// SPDX-License-Identifier: MIT
#include "osganimation/SkeletonConversion.h"

#include "osganimation/BoneMotion.h"
#include "osganimation/MorphMeshes.h"
#include "osganimation/RigMeshes.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/Skeleton>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace osgGpuAnimation::osganimation
{

namespace
{

/// A manager and the node whose update callback it is.
struct Manager
{
    osg::Node* owner;
    osgAnimation::AnimationManagerBase* manager;
};

template <class Callback>
Callback* callbackOf(osg::Node& node)
{
    for (osg::Callback* callback = node.getUpdateCallback(); callback; callback = callback->getNestedCallback())
        if (auto* const found = dynamic_cast<Callback*>(callback)) return found;
    return nullptr;
}

/// For messages: the target's name and the channel's own.
std::string nameOf(const osgAnimation::Channel& channel)
{
    return channel.getTargetName() + (channel.getName().empty() ? "" : '.' + channel.getName());
}

/// What the conversion looks for in a scene.
class SceneParts : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    SceneParts() : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override
    {
        if (auto* const manager = callbackOf<osgAnimation::AnimationManagerBase>(node))
            managers.push_back({&node, manager});
        if (auto* const skeleton = dynamic_cast<osgAnimation::Skeleton*>(&node))
            if (std::find(skeletons.begin(), skeletons.end(), skeleton) == skeletons.end())
                skeletons.push_back(skeleton);
        traverse(node);
    }

    std::vector<Manager> managers;
    std::vector<osg::ref_ptr<osgAnimation::Skeleton>> skeletons;
};

/// Takes the update callbacks (as osgAnimation's UpdateMaterial) from the attributes below a node, and gives them back
/// in the end. StateSet's merge() and its copies do not count them for the update traversal; setUpdateCallback() does.
class AttributeCallbacks : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    explicit AttributeCallbacks(osg::Node& node) : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN)
    {
        node.accept(*this);
        for (const auto& [attribute, callback] : _callbacks)
            attribute->setUpdateCallback(nullptr);
    }
    ~AttributeCallbacks() override
    {
        for (const auto& [attribute, callback] : _callbacks)
            attribute->setUpdateCallback(callback);
    }
    void apply(osg::Node& node) override
    {
        if (osg::StateSet* const state = node.getStateSet())
            for (const auto& [type, attribute] : state->getAttributeList())
                if (attribute.first->getUpdateCallback())
                    _callbacks[attribute.first] = attribute.first->getUpdateCallback();
        traverse(node);
    }

private:
    std::map<osg::ref_ptr<osg::StateAttribute>, osg::ref_ptr<osg::StateAttributeCallback>> _callbacks;
};

/// What a bone or skeleton carries besides bones, after the meshes are gone.
std::vector<osg::Node*> remainingChildren(osg::Group& group)
{
    std::vector<osg::Node*> children;
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
        if (!dynamic_cast<osgAnimation::Bone*>(group.getChild(i)) && !isEmpty(*group.getChild(i)))
            children.push_back(group.getChild(i));
    return children;
}

/// Turns one skeleton into a character.
class SkeletonConverter
{
public:
    SkeletonConverter(osgAnimation::Skeleton& skeleton, std::vector<std::string>& warnings)
        : _skeleton(skeleton), _warnings(warnings)
    {
    }

    /// Null, with a warning, if the skeleton has to stay.
    osg::ref_ptr<AnimatedCharacter> character(const std::vector<Manager>& managers);
    /// Names of the channels that the clips have.
    const std::set<std::string>& channels() const { return _channels; }

private:
    bool findBones();
    Result<std::shared_ptr<const AnimationSet>> makeSet(const std::vector<Manager>& managers);
    void addClips(const std::vector<Manager>& managers, AnimationParts& parts);
    bool addWeights(const osgAnimation::Animation& animation, const AnimationParts& parts, ClipBuilder& builder);
    void addChildren(AnimatedCharacter& character);
    void take(const osgAnimation::ChannelList& channels)
    {
        for (const osg::ref_ptr<osgAnimation::Channel>& channel : channels)
            _channels.insert(nameOf(*channel));
    }
    bool stay(const std::string& reason)
    {
        _warnings.push_back("skeleton \"" + _skeleton.getName() + "\": " + reason + "; it stays as it is");
        return false;
    }

    osgAnimation::Skeleton& _skeleton;
    std::vector<std::string>& _warnings;
    std::vector<BoneJoint> _bones;
    std::vector<RigMesh> _meshes;
    std::set<std::string> _channels;
};

/// False, with a warning, if the skeleton has to stay.
bool SkeletonConverter::findBones()
{
    struct Place
    {
        osg::Node* node;
        int bone; ///< the nearest one above
        std::size_t depth;
    };
    SceneGuard guard(SceneGuard::Shared::EachPath);
    std::vector<Place> open{{&_skeleton, -1, 0}}; // the next one last
    while (!open.empty())
    {
        Place place = open.back();
        open.pop_back();
        if (auto* const bone = dynamic_cast<osgAnimation::Bone*>(place.node))
        {
            const int parent = bone->getBoneParent() ? place.bone : -1;
            place.bone = static_cast<int>(_bones.size());
            _bones.push_back({bone, callbackOf<osgAnimation::UpdateBone>(*bone), parent});
            if (!hasNoShear(BoneMotion(*bone, _bones.back().update, nullptr).at(0.0)))
                return stay("bone \"" + bone->getName() + "\" is sheared");
        }
        osg::Group* const group = place.node->asGroup();
        if (group && !guard.enter(*group, place.depth)) return stay(guard.fault());
        for (unsigned int i = group ? group->getNumChildren() : 0; i-- > 0;)
            open.push_back({group->getChild(i), place.bone, place.depth + 1});
    }
    return !_bones.empty() || stay("it has no bones");
}

void SkeletonConverter::addClips(const std::vector<Manager>& managers, AnimationParts& parts)
{
    ClipBuilder builder(parts.skeleton, parts.morphs);
    for (const Manager& each : managers)
        for (const osg::ref_ptr<osgAnimation::Animation>& animation : each.manager->getAnimationList())
        {
            bool isMoving = false;
            for (std::size_t i = 0; i < _bones.size(); ++i)
            {
                BoneMotion motion(*_bones[i].bone, _bones[i].update, animation);
                if (motion.linkedChannels().empty()) continue;
                isMoving = true;
                take(motion.linkedChannels());
                for (Channel& channel : motion.channels(parts.skeleton.jointOfInput(i)))
                    if (const Result<void> added = builder.add(std::move(channel)); !added)
                        _warnings.push_back("animation \"" + animation->getName() + "\", bone \"" +
                                            _bones[i].bone->getName() + "\": " + added.error().message);
            }
            isMoving = addWeights(*animation, parts, builder) || isMoving;
            if (isMoving) parts.clips.push_back(builder.build(animation->getName()));
        }
}

/// True if the animation moves weights of morph targets.
bool SkeletonConverter::addWeights(const osgAnimation::Animation& animation, const AnimationParts& parts,
                                   ClipBuilder& builder)
{
    bool isMoving = false;
    int morph = 0;
    for (const RigMesh& mesh : _meshes)
    {
        if (!mesh.morph) continue;
        const int target = morph++;
        MorphMotion motion(parts.morphs[static_cast<std::size_t>(target)].defaults, mesh.weights, animation);
        if (motion.linkedChannels().empty()) continue;
        isMoving = true;
        take(motion.linkedChannels());
        if (const Result<void> added = builder.add(motion.channel(target)); !added)
            _warnings.push_back("animation \"" + animation.getName() + "\", mesh \"" + mesh.geometry->getName() +
                                "\": " + added.error().message);
    }
    return isMoving;
}

Result<std::shared_ptr<const AnimationSet>> SkeletonConverter::makeSet(const std::vector<Manager>& managers)
{
    std::vector<Joint> joints;
    for (const BoneJoint& each : _bones)
        joints.push_back({each.bone->getName(), each.parent,
                          transformOf(BoneMotion(*each.bone, each.update, nullptr).at(0.0)),
                          static_cast<int>(joints.size())});
    Result<Skeleton> skeleton = Skeleton::create(std::move(joints));
    if (!skeleton) return skeleton.error();
    AnimationParts parts{skeleton.value(), {}, {}, {}, {}};
    for (const RigMesh& mesh : _meshes)
    {
        Skin skin{mesh.geometry->getName(), {}, mesh.inverseBinds};
        for (const int bone : mesh.bones)
            skin.joints.push_back(parts.skeleton.jointOfInput(static_cast<std::size_t>(bone)));
        parts.skins.push_back(std::move(skin));
        if (!mesh.morph) continue;
        osgAnimation::AnimationList animations;
        for (const Manager& each : managers)
            animations.insert(animations.end(), each.manager->getAnimationList().begin(),
                              each.manager->getAnimationList().end());
        parts.morphs.push_back({mesh.geometry->getName(), -1, restWeights(*mesh.morph, mesh.weights, animations)});
    }
    addClips(managers, parts);
    return AnimationSet::create(std::move(parts));
}

void SkeletonConverter::addChildren(AnimatedCharacter& character)
{
    int morphs = 0;
    for (std::size_t skin = 0; skin < _meshes.size(); ++skin)
        character.addChild(skinnedMesh(_meshes[skin], character.getAnimationSet(), skin,
                                       _meshes[skin].morph ? morphs++ : -1, _warnings));
    for (const RigMesh& mesh : _meshes)
        while (mesh.geometry->getNumParents() > 0)
            mesh.geometry->getParent(0)->removeChild(mesh.geometry);
    for (const BoneJoint& each : _bones)
        for (osg::Node* child : remainingChildren(*each.bone))
        {
            osg::ref_ptr<JointAttachment> attachment = new JointAttachment(each.bone->getName());
            attachment->addChild(child);
            character.addChild(attachment);
        }
    for (osg::Node* child : remainingChildren(_skeleton))
        character.addChild(child);
}

osg::ref_ptr<AnimatedCharacter> SkeletonConverter::character(const std::vector<Manager>& managers)
{
    if (!findBones()) return nullptr;
    const AttributeCallbacks held(_skeleton);
    _meshes = findMeshes(_skeleton, _bones, _warnings);
    const Result<std::shared_ptr<const AnimationSet>> set = makeSet(managers);
    if (!set)
    {
        stay(set.error().message);
        return nullptr;
    }
    osg::ref_ptr<AnimatedCharacter> made = new AnimatedCharacter(set.value());
    made->setName(_skeleton.getName());
    made->setMatrix(_skeleton.getMatrix());
    made->setNodeMask(_skeleton.getNodeMask());
    made->setStateSet(_skeleton.getStateSet());
    made->setUserDataContainer(_skeleton.getUserDataContainer());
    addChildren(*made);
    made->computeClipBounds();
    if (!set.value()->clips().empty()) static_cast<void>(made->getController().play(0));
    return made;
}

} // namespace

Conversion convertOsgAnimation(osg::Node& node)
{
    Conversion result;
    result.node = &node;
    SceneParts scene;
    node.accept(scene);
    if (!scene.guard().fault().empty()) result.warnings.push_back(scene.guard().fault() + "; not visited");
    std::set<std::string> taken;
    for (const osg::ref_ptr<osgAnimation::Skeleton>& skeleton : scene.skeletons)
    {
        SkeletonConverter converter(*skeleton, result.warnings);
        const osg::ref_ptr<AnimatedCharacter> character = converter.character(scene.managers);
        if (!character) continue;
        taken.insert(converter.channels().begin(), converter.channels().end());
        const std::vector<osg::Group*> parents = skeleton->getParents();
        for (osg::Group* parent : parents)
            parent->replaceChild(skeleton, character);
        if (skeleton == &node) result.node = character;
        result.characters.push_back(character);
    }
    const auto isMorph = [](osg::Node& node) { return dynamic_cast<osgAnimation::MorphGeometry*>(&node) != nullptr; };
    if (visitUntil(*result.node, isMorph))
        result.warnings.push_back("MorphGeometry that no bone carries stays as it is");
    for (const Manager& each : scene.managers)
    {
        std::set<std::string> left; // channels that no clip has
        for (const osg::ref_ptr<osgAnimation::Animation>& animation : each.manager->getAnimationList())
            for (const osg::ref_ptr<osgAnimation::Channel>& channel : animation->getChannels())
                if (channel->getSampler() && taken.count(nameOf(*channel)) == 0) left.insert(nameOf(*channel));
        if (left.empty()) each.owner->removeUpdateCallback(each.manager);
        if (left.empty() || result.characters.empty()) continue;
        result.warnings.push_back("the animation manager stays, for channels that move no bone: " +
                                  quotedNames(std::vector<std::string>(left.begin(), left.end())));
    }
    return result;
}

} // namespace osgGpuAnimation::osganimation
