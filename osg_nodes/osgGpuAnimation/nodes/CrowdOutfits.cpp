// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdOutfits.h>

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

} // namespace

Result<void> CrowdOutfits::add(Outfit* outfit)
{
    std::unique_ptr<OutfitMeshes> first = _meshes ? nullptr : std::make_unique<OutfitMeshes>();
    const Result<void> added = (_meshes ? *_meshes : *first).add(_crowd, *_instances.set(), outfit);
    if (!added) return added;
    if (first) _meshes = std::move(first);
    _changed();
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
    if (replaced) _changed();
    return replaced;
}

bool CrowdOutfits::remove(const Outfit* outfit)
{
    const std::uint16_t number = numberOf(outfit);
    if (number == 0) return false;
    _instances.removeOutfit(number);
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
    return {};
}

const Outfit* CrowdOutfits::wornBy(std::size_t instance) const
{
    return _meshes ? _meshes->outfit(_instances.outfit(instance)) : nullptr;
}

} // namespace osgGpuAnimation
