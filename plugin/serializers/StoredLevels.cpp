// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/Notify>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::uint32_t checksumStart = 2166136261u;

/// FNV-1a.
template <typename Number>
void addTo(std::uint32_t& checksum, const Number* values, std::size_t count)
{
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(Number); ++i)
        checksum = (checksum ^ bytes[i]) * 16777619u;
}

/// Of what levels are made from: the vertices and the indices.
void addMesh(std::uint32_t& checksum, const osg::Geometry& mesh)
{
    if (const auto* vertices = dynamic_cast<const osg::Vec3Array*>(mesh.getVertexArray()))
        addTo(checksum, vertices->asVector().data(), vertices->size());
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
    {
        const osg::DrawElements* elements = primitives ? primitives->getDrawElements() : nullptr;
        const std::uint32_t mode = primitives ? primitives->getMode() : 0;
        addTo(checksum, &mode, 1);
        for (unsigned int i = 0; elements && i < elements->getNumIndices(); ++i)
        {
            const std::uint32_t index = elements->index(i);
            addTo(checksum, &index, 1);
        }
    }
}

template <typename Number, typename Elements>
void transferIndices(ValueStream& stream, osg::ref_ptr<osg::DrawElements>& elements)
{
    if (stream.isReading()) elements = new Elements(GL_TRIANGLES);
    stream.block<Number>("Indices", static_cast<Elements&>(*elements).asVector(), 24);
}

void transferStep(ValueStream& stream, LodLevels::Step& step)
{
    bool isWide = dynamic_cast<const osg::DrawElementsUInt*>(step.elements.get()) != nullptr;
    stream.property("Step").values(step.level, step.error).floats(&step.outset, 1).value(isWide).endLine();
    if (isWide)
        transferIndices<std::uint32_t, osg::DrawElementsUInt>(stream, step.elements);
    else
        transferIndices<std::uint16_t, osg::DrawElementsUShort>(stream, step.elements);
}

void transferMerged(ValueStream& stream, CharacterLevels::Merged& merged)
{
    stream.list("Parts", merged.parts, [&](std::size_t& part) { stream.value(part); });
    stream.list("Steps", merged.steps,
                [&](CharacterLevels::Step& step)
                {
                    stream.property("Step").values(step.level, step.error).endLine();
                    stream.open("Mesh", 1);
                    stream.object(step.mesh);
                    stream.close();
                });
}

/// Of a mesh in place of parts.
std::optional<std::string> findFault(const std::vector<CharacterLevels::Merged>& levels, const AnimationSet& set)
{
    for (std::size_t i = 0; i < levels.size(); ++i)
        for (std::size_t step = 0; step < levels[i].steps.size(); ++step)
        {
            const SkinnedGeometry* mesh = levels[i].steps[step].mesh;
            const std::optional<std::string> fault = mesh ? serializers::findFault(*mesh, set) : "no mesh";
            if (fault) return "merged parts " + std::to_string(i) + ", step " + std::to_string(step) + ": " + *fault;
        }
    return std::nullopt;
}

void warn(const osg::Object& object, const char* kind, const std::string& message)
{
    OSG_WARN << "osgGpuAnimation: the levels of detail of " << kind << " \"" << object.getName()
             << "\" are made anew: " << message << std::endl;
}

} // namespace

void transferLodLevels(ValueStream& stream, SkinnedGeometry& mesh)
{
    std::uint32_t checksum = checksumStart;
    addMesh(checksum, mesh);
    auto sum = static_cast<std::int32_t>(checksum);
    std::vector<LodLevels::Steps> levels;
    if (!stream.isReading())
        for (unsigned int i = 0; i < mesh.getNumPrimitiveSets(); ++i)
            levels.push_back(MeshDetail::findLevels(mesh)->steps(i));
    stream.begin();
    stream.property("Checksum").value(sum).endLine();
    stream.list("Levels", levels,
                [&](LodLevels::Steps& steps)
                { stream.list("Steps", steps, [&](LodLevels::Step& step) { transferStep(stream, step); }); });
    stream.close();
    if (!stream.hasRead()) return;
    if (sum != static_cast<std::int32_t>(checksum))
        return warn(mesh, "mesh", "its vertices or primitives have changed");
    const Result<std::shared_ptr<const LodLevels>> restored = LodLevels::restored(mesh, std::move(levels));
    if (!restored) return warn(mesh, "mesh", restored.error().message);
    MeshDetail::setLevels(mesh, restored.value());
}

void transferCharacterLevels(ValueStream& stream, AnimatedCrowd& crowd)
{
    std::uint32_t checksum = checksumStart;
    forEachMesh(CrowdDetail::drawnMeshes(crowd), [&](const SkinnedGeometry& mesh) { addMesh(checksum, mesh); });
    auto sum = static_cast<std::int32_t>(checksum);
    std::vector<CharacterLevels::Merged> levels;
    if (!stream.isReading()) levels = CrowdDetail::levels(crowd)->merged();
    stream.property("Checksum").value(sum).endLine();
    stream.list("Merged", levels, [&](CharacterLevels::Merged& merged) { transferMerged(stream, merged); });
    if (!stream.hasRead()) return;
    if (sum != static_cast<std::int32_t>(checksum)) return warn(crowd, "crowd", "its meshes have changed");
    if (const auto fault = findFault(levels, crowd.getAnimationSet())) return warn(crowd, "crowd", *fault);
    const auto restored =
        CharacterLevels::restored(CrowdDetail::drawnMeshes(crowd), crowd.getAnimationSet(), std::move(levels));
    if (!restored) return warn(crowd, "crowd", restored.error().message);
    CrowdDetail::setLevels(crowd, restored.value());
}

} // namespace osgGpuAnimation::serializers
