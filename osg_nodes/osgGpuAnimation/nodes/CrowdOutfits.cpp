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

Result<void> CrowdOutfits::replace(const Outfit* outfit, Outfit* by)
{
    if (!_meshes) return noOutfit();
    const Result<void> replaced = _meshes->replace(_crowd, *_instances.set(), outfit, by);
    if (replaced) _changed();
    return replaced;
}

bool CrowdOutfits::remove(const Outfit* outfit)
{
    const OutfitMeshes::Number number = _meshes ? _meshes->numberOf(outfit) : OutfitMeshes::Number(0);
    if (number == 0) return false;
    _instances.removeOutfit(number);
    _meshes->remove(_crowd, outfit);
    _changed();
    return true;
}

std::vector<osg::ref_ptr<Outfit>> CrowdOutfits::getList() const
{
    return _meshes ? _meshes->all() : std::vector<osg::ref_ptr<Outfit>>();
}

Result<void> CrowdOutfits::wear(std::size_t instance, const Outfit* outfit)
{
    const OutfitMeshes::Number number = _meshes ? _meshes->numberOf(outfit) : OutfitMeshes::Number(0);
    if (outfit && number == 0) return noOutfit();
    _instances.setOutfit(instance, number);
    return {};
}

const Outfit* CrowdOutfits::wornBy(std::size_t instance) const
{
    return _meshes ? _meshes->outfit(_instances.outfit(instance)) : nullptr;
}

} // namespace osgGpuAnimation
