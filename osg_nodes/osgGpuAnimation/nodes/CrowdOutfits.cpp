// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdOutfits.h>

#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/properties/OutfitMeshes.h>

namespace osgGpuAnimation
{

namespace
{

Error noOutfit()
{
    return Error{"the crowd has no such outfit; add() adds it"};
}

/// Null: those of the clips.
std::shared_ptr<const JointPose> proportionsOf(const Outfit& outfit, const std::shared_ptr<const AnimationSet>& set)
{
    if (outfit.getJointScales().empty()) return nullptr;
    const auto pose = std::make_shared<JointPose>(set);
    for (const auto& [name, scale] : outfit.getJointScales())
    {
        const std::size_t joint = set->skeleton().jointNamed(name).value();
        pose->setScale(joint, glm::vec3(pose->transform(joint).scale) * glm::vec3(scale.x(), scale.y(), scale.z()));
    }
    return pose;
}

} // namespace

Result<void> CrowdOutfits::add(Outfit* outfit)
{
    std::unique_ptr<OutfitMeshes> first = _meshes ? nullptr : std::make_unique<OutfitMeshes>();
    const Result<void> added = (_meshes ? *_meshes : *first).add(_crowd, *_instances.set(), outfit);
    if (!added) return added;
    if (first) _meshes = std::move(first);
    show(outfit);
    return {};
}

std::uint16_t CrowdOutfits::numberOf(const Outfit* outfit) const
{
    return _meshes ? _meshes->numberOf(outfit) : OutfitMeshes::Number(0);
}

Result<void> CrowdOutfits::replace(const Outfit* outfit, Outfit* by)
{
    const std::uint16_t number = numberOf(outfit);
    if (number == 0) return noOutfit();
    const Result<void> replaced = _meshes->replace(_crowd, *_instances.set(), number, by);
    if (replaced) show(by);
    return replaced;
}

void CrowdOutfits::show(const Outfit* outfit)
{
    _instances.setProportions(numberOf(outfit), proportionsOf(*outfit, _instances.set()));
    _changed();
}

bool CrowdOutfits::remove(const Outfit* outfit)
{
    const std::uint16_t number = numberOf(outfit);
    if (number == 0) return false;
    _instances.removeOutfit(number);
    _instances.setProportions(number, nullptr);
    _meshes->remove(_crowd, number);
    _changed();
    return true;
}

std::vector<osg::ref_ptr<Outfit>> CrowdOutfits::getList() const
{
    return _meshes ? _meshes->all() : std::vector<osg::ref_ptr<Outfit>>();
}

Result<void> CrowdOutfits::wear(std::size_t instance, const Outfit* outfit)
{
    const std::uint16_t number = numberOf(outfit);
    if (outfit && number == 0) return noOutfit();
    _instances.setOutfit(instance, number);
    if (_instances.hasProportions()) _crowd.dirtyBound();
    return {};
}

const Outfit* CrowdOutfits::wornBy(std::size_t instance) const
{
    return _meshes ? _meshes->outfit(_instances.outfit(instance)) : nullptr;
}

} // namespace osgGpuAnimation
