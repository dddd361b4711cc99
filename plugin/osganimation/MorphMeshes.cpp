// SPDX-License-Identifier: MIT
#include "osganimation/MorphMeshes.h"

#include "osganimation/BoneMotion.h"

#include <osgGpuAnimation/authoring/keyframes/SampledTrack.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace osgGpuAnimation::osganimation
{

namespace
{

/// The number of the weight that a channel drives, as UpdateMorph::link() finds it: the callback has the name of the
/// channel's target, and the channel's own name is the number. -1: none.
int weightOf(const osgAnimation::Channel& channel, osgAnimation::UpdateMorph& update, std::size_t count)
{
    const std::vector<std::string>& names = update.getTargetNames();
    if (std::find(names.begin(), names.end(), channel.getTargetName()) == names.end()) return -1;
    char* end = nullptr;
    const long number = std::strtol(channel.getName().c_str(), &end, 10);
    const bool isWeight = end != channel.getName().c_str() && number >= 0 && static_cast<std::size_t>(number) < count;
    return isWeight ? static_cast<int>(number) : -1;
}

osg::ref_ptr<osg::Vec3Array> difference(const osg::Array* target, const osg::Vec3Array* base)
{
    const auto* const values = dynamic_cast<const osg::Vec3Array*>(target);
    if (!values) return nullptr;
    osg::ref_ptr<osg::Vec3Array> made = new osg::Vec3Array(values->begin(), values->end());
    for (std::size_t i = 0; base && i < made->size(); ++i)
        (*made)[i] -= (*base)[i];
    return made;
}

} // namespace

MorphMotion::MorphMotion(std::vector<float> rest, osgAnimation::UpdateMorph* update,
                         const osgAnimation::Animation& animation)
    : _rest(std::move(rest)), _targets(_rest.size())
{
    if (!update) return;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : animation.getChannels())
    {
        const int index = channel->getSampler() ? weightOf(*channel, *update, _targets.size()) : -1;
        if (index < 0) continue;
        osg::ref_ptr<osgAnimation::FloatTarget>& target = _targets[static_cast<std::size_t>(index)];
        osg::ref_ptr<osgAnimation::FloatTarget> driven = target;
        if (!driven) driven = new osgAnimation::FloatTarget(0.0f);
        const osg::ref_ptr<osgAnimation::Channel> copy = channel->clone();
        if (!copy->setTarget(driven)) continue;
        target = driven;
        _channels.push_back(copy);
    }
}

std::vector<float> MorphMotion::at(double seconds)
{
    for (const osg::ref_ptr<osgAnimation::FloatTarget>& target : _targets)
        if (target) target->reset();
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _channels)
        channel->update(seconds, 1.0f, 0);
    std::vector<float> weights = _rest;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (_targets[i]) weights[i] = std::max(_targets[i]->getValue(), 0.0f);
    return weights;
}

Channel MorphMotion::channel(int target)
{
    Channel made;
    made.path = Channel::Path::Weights;
    made.target = target;
    const auto function = [this](double time, bool before) { return at(before ? justBefore(time) : time); };
    const auto inTolerances = [](const std::vector<float>& a, const std::vector<float>& b)
    { return largestDifference(a, b) / tolerance; };
    for (const auto& [time, weights] :
         sampledTrack(keyTimesOf(_channels), function, mixedNumbers<float>, inTolerances, minJump))
    {
        made.times.push_back(time);
        made.values.insert(made.values.end(), weights.begin(), weights.end());
    }
    return made;
}

std::vector<float> restWeights(const osgAnimation::MorphGeometry& mesh, osgAnimation::UpdateMorph* update,
                               const osgAnimation::AnimationList& animations)
{
    std::vector<float> rest;
    for (const osgAnimation::MorphGeometry::MorphTarget& target : mesh.getMorphTargetList())
        rest.push_back(std::max(target.getWeight(), 0.0f));
    for (const osg::ref_ptr<osgAnimation::Animation>& animation : animations)
    {
        const MorphMotion motion(rest, update, *animation);
        for (std::size_t i = 0; i < rest.size(); ++i)
            if (motion.drives(i)) rest[i] = 0.0f;
    }
    return rest;
}

osg::Vec3Array* morphSource(const osgAnimation::MorphGeometry& mesh, bool normals)
{
    osg::Vec3Array* const kept = normals ? mesh.getNormalSource() : mesh.getVertexSource();
    if (kept && !kept->empty()) return kept;
    const osg::Array* const array = normals ? mesh.getNormalArray() : mesh.getVertexArray();
    return dynamic_cast<osg::Vec3Array*>(const_cast<osg::Array*>(array));
}

std::optional<std::vector<MorphTarget>> morphTargetsOf(const osgAnimation::MorphGeometry& mesh)
{
    const osg::Vec3Array* const vertices = morphSource(mesh, false);
    const osg::Vec3Array* const normals = mesh.getMorphNormals() ? morphSource(mesh, true) : nullptr;
    const bool isRelative = mesh.getMethod() == osgAnimation::MorphGeometry::RELATIVE;
    std::vector<MorphTarget> targets;
    for (const osgAnimation::MorphGeometry::MorphTarget& source : mesh.getMorphTargetList())
    {
        const osg::Geometry* const shape = source.getGeometry();
        MorphTarget& target = targets.emplace_back();
        if (!vertices || !shape) return std::nullopt;
        const osg::Array* const moved = shape->getVertexArray();
        if (!dynamic_cast<const osg::Vec3Array*>(moved) || moved->getNumElements() != vertices->size())
            return std::nullopt;
        target.positions = difference(moved, isRelative ? nullptr : vertices);
        const osg::Array* const turned = shape->getNormalArray();
        if (normals && turned && turned->getNumElements() == normals->size())
            target.normals = difference(turned, isRelative ? nullptr : normals);
    }
    return targets;
}

} // namespace osgGpuAnimation::osganimation
