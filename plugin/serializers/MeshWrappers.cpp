// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/shading/Mipmaps.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/geometry/PrimitiveRange.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/LOD>
#include <osg/Notify>

#include <algorithm>
#include <optional>

namespace osgGpuAnimation::serializers
{

namespace
{

/// OSG's wrappers transfer the influences as vertex attributes; this property tells the mesh to use them.
void transferInfluences(ValueStream& stream, SkinnedGeometry& mesh)
{
    std::int32_t rigidEntry = mesh.getRigidEntry();
    stream.limited("a rigid mesh's palette entry", rigidEntry, -1, 65535).endLine();
    if (!stream.hasRead()) return;
    if (rigidEntry >= 0) return mesh.setRigidEntry(static_cast<unsigned short>(rigidEntry));
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets && mesh.getEntries(i) && mesh.getWeights(i); ++i)
        mesh.setInfluences(i, const_cast<osg::Vec4usArray*>(mesh.getEntries(i)),
                           const_cast<osg::Vec4Array*>(mesh.getWeights(i)));
}

template <typename Array>
void transferArray(ValueStream& stream, const char* name, osg::ref_ptr<Array>& array)
{
    if (stream.open(name, array ? 1 : 0) > 0) stream.object(array);
    stream.close();
}

void transferMorphTargets(ValueStream& stream, SkinnedGeometry& mesh)
{
    std::int32_t morph = mesh.getMorph(), entry = mesh.getMorphEntry();
    std::vector<MorphTarget> targets = mesh.getMorphTargets();
    stream.values(morph, entry).endLine();
    const auto transferTarget = [&](MorphTarget& target)
    {
        transferArray(stream, "Positions", target.positions);
        transferArray(stream, "Normals", target.normals);
        transferArray(stream, "Colors", target.colors);
        transferArray(stream, "TextureCoordinates", target.textureCoordinates);
        transferArray(stream, "Tangents", target.tangents);
    };
    stream.list("Targets", targets, transferTarget);
    if (stream.hasRead()) mesh.setMorphTargets(morph, entry, std::move(targets));
}

/// Waits for the levels that characters and crowds with the mesh are making.
void waitForLevels(const osg::Node& mesh)
{
    for (osg::Group* parent : mesh.getParents())
    {
        if (auto* character = dynamic_cast<AnimatedCharacter*>(parent)) character->getMeshes().waitForLevels();
        if (auto* crowd = dynamic_cast<AnimatedCrowd*>(parent)) crowd->getMeshes().waitForLevels();
        if (dynamic_cast<const osg::LOD*>(parent)) waitForLevels(*parent);
    }
}

/// As the glTF reader does for the core profile; a texture does not store it.
struct MipmapsAfterReading : osgDB::FinishedObjectReadCallback
{
    void objectRead(osgDB::InputStream&, osg::Object& object) override
    {
        generateMipmaps(static_cast<SkinnedGeometry&>(object).getStateSet());
    }
};

void addMeshProperties(osgDB::ObjectWrapper* wrapper)
{
    addProperty(wrapper, "Influences", &transferInfluences);
    addProperty<SkinnedGeometry>(wrapper, "MorphTargets", &transferMorphTargets,
                                 [](const SkinnedGeometry& mesh) { return !mesh.getMorphTargets().empty(); });
    const auto hasLevels = [](const SkinnedGeometry& mesh)
    {
        waitForLevels(mesh);
        return MeshDetail::findLevels(mesh) != nullptr;
    };
    addProperty<SkinnedGeometry>(wrapper, "LodLevels", &transferLodLevels, hasLevels);
    wrapper->addFinishedObjectReadCallback(new MipmapsAfterReading);
}

const Wrapper<SkinnedGeometry>
    skinnedGeometry("SkinnedGeometry",
                    "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Drawable osg::Geometry",
                    &addMeshProperties);

// A file has no shaders: reading returns the program that all characters, or all other surfaces, share.
osgDB::RegisterWrapperProxy characterProgramWrapper([]() -> osg::Object* { return characterProgram().release(); },
                                                    "osgGpuAnimation::SurfaceProgram",
                                                    "osgGpuAnimation::SurfaceProgram", [](osgDB::ObjectWrapper*) {});

osgDB::RegisterWrapperProxy surfaceProgramWrapper([]() -> osg::Object* { return surfaceProgram().release(); },
                                                  "osgGpuAnimation::StillSurfaceProgram",
                                                  "osgGpuAnimation::ExactNumbers osgGpuAnimation::StillSurfaceProgram",
                                                  [](osgDB::ObjectWrapper*) {});

using Fault = std::optional<std::string>;

std::string counted(std::size_t found, const char* of, std::size_t wanted)
{
    return std::to_string(found) + " " + of + " of " + std::to_string(wanted);
}

Fault findFaultInArrays(const SkinnedGeometry& mesh, std::size_t vertices)
{
    osg::Geometry::ArrayList arrays;
    mesh.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (array->getBinding() == osg::Array::BIND_PER_VERTEX && array->getNumElements() < vertices)
            return counted(array->getNumElements(), "elements of an array", vertices);
    return std::nullopt;
}

Fault findFaultInEntries(const SkinnedGeometry& mesh, std::size_t paletteSize)
{
    const auto rigidEntry = static_cast<std::size_t>(std::max(mesh.getRigidEntry(), 0));
    if (rigidEntry >= paletteSize) return counted(rigidEntry, "as an entry", paletteSize);
    if (mesh.getRigidEntry() >= 0) return std::nullopt;
    if (!mesh.getEntries(0) || !mesh.getWeights(0)) return "no influences";
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets && mesh.getEntries(i); ++i)
        for (const osg::Vec4us& entries : *mesh.getEntries(i))
            for (const unsigned short entry : {entries.x(), entries.y(), entries.z(), entries.w()})
                if (entry >= paletteSize) return counted(entry, "as an entry", paletteSize);
    return std::nullopt;
}

Fault findFaultInMorphs(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    if (mesh.getMorphTargets().empty()) return std::nullopt;
    const auto morph = static_cast<std::size_t>(mesh.getMorph()); // -1 becomes huge
    if (morph >= set.morphs().size()) return "a morph that the set does not have";
    const std::size_t weights = set.morphs()[morph].defaults.size();
    if (mesh.getMorphTargets().size() > weights)
        return counted(mesh.getMorphTargets().size(), "morph targets", weights);
    if (mesh.getMorphEntry() != set.entryOfMorph(morph)) return "a wrong morph entry";
    return std::nullopt;
}

} // namespace

std::optional<std::string> findFault(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    const osg::Array* positions = mesh.getVertexArray();
    if (!positions) return "no vertices";
    const std::size_t vertices = positions->getNumElements();
    if (const Fault fault = findFaultInArrays(mesh, vertices)) return fault;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
        if (!isWithin(primitives, vertices)) return "a primitive set that is missing or beyond its vertices";
    if (const Fault fault = findFaultInEntries(mesh, set.paletteSize())) return fault;
    return findFaultInMorphs(mesh, set);
}

void removeUnfitMeshes(osg::Group& group, const AnimationSet& set)
{
    std::vector<osg::ref_ptr<osg::Drawable>> unfit;
    const auto find = [&](SkinnedGeometry& mesh)
    {
        const std::optional<std::string> fault = findFault(mesh, set);
        if (!fault) return;
        OSG_WARN << "osgGpuAnimation: mesh \"" << mesh.getName() << "\" has " << *fault << "; it is not drawn"
                 << std::endl;
        unfit.push_back(&mesh);
    };
    forEachMeshBelow(group, find);
    for (const osg::ref_ptr<osg::Drawable>& mesh : unfit)
        while (mesh->getNumParents() > 0)
            mesh->getParent(0)->removeChild(mesh);
}

} // namespace osgGpuAnimation::serializers
