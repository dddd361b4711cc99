// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/Outfit.h>

#include <osg/Group>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class CrowdInstances;
class OutfitMeshes;

/// The outfits of an AnimatedCrowd, up to 256. AnimatedCrowd::setOutfit() dresses an instance.
///
///     if (auto added = crowd->getOutfits().add(guard); !added) std::cerr << added.error().message << "\n";
///     crowd->setOutfit(instance, guard);
///
/// Changes belong in the update traversal or between frames, and not into the cull of the crowd.
class CrowdOutfits
{
public:
    CrowdOutfits(const CrowdOutfits&) = delete;
    CrowdOutfits& operator=(const CrowdOutfits&) = delete;

    /// Errors, which change nothing: outfit is null or was added before; it names a part, material, variant or joint
    /// that the crowd lacks, a colour beyond [0, 1], a scale beyond [0.1, 10] or an empty picture; the crowd has 256
    /// outfits.
    Result<void> add(Outfit* outfit);
    /// The instances of the outfit get another one, or, with by == outfit, what has changed in it. Errors: those of
    /// add(); the crowd has no such outfit.
    Result<void> replace(const Outfit* outfit, Outfit* by);
    /// Its instances show what the crowd shows. False: there is no such outfit.
    bool remove(const Outfit* outfit);
    std::vector<osg::ref_ptr<Outfit>> getList() const; ///< in the order of add(), but that add() fills gaps first

private:
    friend class AnimatedCrowd;

    /// meshes: of the crowd's CharacterMeshes; null: no outfits yet. changed: called after each change.
    CrowdOutfits(osg::Group& crowd, CrowdInstances& instances, std::unique_ptr<OutfitMeshes>& meshes,
                 std::function<void()> changed)
        : _crowd(crowd), _instances(instances), _meshes(meshes), _changed(std::move(changed))
    {
    }
    std::uint16_t numberOf(const Outfit* outfit) const; ///< 0: there is no such outfit
    void show(const Outfit* outfit);
    Result<void> wear(std::size_t instance, const Outfit* outfit);
    const Outfit* wornBy(std::size_t instance) const; ///< null: none

    osg::Group& _crowd;
    CrowdInstances& _instances;
    std::unique_ptr<OutfitMeshes>& _meshes;
    const std::function<void()> _changed;
};

} // namespace osgGpuAnimation
