// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

// Levels of detail as LevelsTask makes them, in the calling thread.

/// The levels that the mesh has, or new ones, which it has from now on.
inline std::shared_ptr<const LodLevels> madeLevels(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    if (std::shared_ptr<const LodLevels> known = MeshDetail::findLevels(mesh)) return known;
    const auto made = std::make_shared<LodLevels>(mesh);
    const auto skin = [&](const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& out)
    { mesh.computePositions(palette, out); };
    made->addSteps(mesh, set, skin, nullptr);
    MeshDetail::setLevels(const_cast<SkinnedGeometry&>(mesh), made);
    return made;
}

/// Those of a character as a whole.
inline std::shared_ptr<const CharacterLevels> madeLevels(const osg::Group& meshes, const AnimationSet& set)
{
    const std::shared_ptr<CharacterLevels> made = CharacterLevels::unmade(meshes, set);
    std::vector<CharacterLevels::Sources::Mesh> all;
    forEachMesh(meshes, [&](const SkinnedGeometry& mesh) { all.push_back({&mesh, &mesh}); });
    const CharacterLevels::Sources sources(all);
    if (sources.isEmpty()) return made;
    CharacterLevels::Sources::Levels levels;
    forEachMesh(meshes, [&](const SkinnedGeometry& mesh) { levels.push_back(madeLevels(mesh, set)); });
    made->includeMade(sources.make(set, levels, nullptr));
    return made;
}

} // namespace osgGpuAnimation
