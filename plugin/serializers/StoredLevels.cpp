// SPDX-License-Identifier: MIT
#include "serializers/StoredLevels.h"

#include <osgGpuAnimation/nodes/lod/LodLevels.h>

#include <osg/Notify>

namespace osgGpuAnimation::serializers
{

namespace
{

/// FNV-1a.
class Checksum
{
public:
    template <typename Number>
    void add(const Number* values, std::size_t count)
    {
        const auto* bytes = reinterpret_cast<const unsigned char*>(values);
        for (std::size_t i = 0; i < count * sizeof(Number); ++i)
            _sum = (_sum ^ bytes[i]) * 16777619u;
    }
    void add(std::uint32_t value) { add(&value, 1); }
    std::int32_t value() const { return static_cast<std::int32_t>(_sum); }

private:
    std::uint32_t _sum = 2166136261u;
};

/// Of what levels are made from: the vertices and the indices.
void addMesh(Checksum& checksum, const osg::Geometry& mesh)
{
    if (const auto* vertices = dynamic_cast<const osg::Vec3Array*>(mesh.getVertexArray()))
        checksum.add(vertices->asVector().data(), vertices->size());
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
    {
        const osg::DrawElements* elements = primitives ? primitives->getDrawElements() : nullptr;
        checksum.add(primitives ? primitives->getMode() : 0);
        for (unsigned int i = 0; elements && i < elements->getNumIndices(); ++i)
            checksum.add(elements->index(i));
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

void warn(const osg::Object& object, const char* kind, const std::string& message)
{
    OSG_WARN << "osgGpuAnimation: the levels of detail of " << kind << " \"" << object.getName()
             << "\" are made anew: " << message << std::endl;
}

} // namespace

void transferLodLevels(ValueStream& stream, SkinnedGeometry& mesh)
{
    Checksum checksum;
    addMesh(checksum, mesh);
    std::int32_t sum = checksum.value();
    std::vector<LodLevels::Steps> levels;
    if (!stream.isReading())
        for (unsigned int i = 0; i < mesh.getNumPrimitiveSets(); ++i)
            levels.push_back(mesh.findLodLevels()->steps(i));
    stream.property("Checksum").value(sum).endLine();
    stream.list("Levels", levels,
                [&](LodLevels::Steps& steps)
                {
                    stream.list("Steps", steps, [&](LodLevels::Step& step) { transferStep(stream, step); });
                });
    if (!stream.hasRead()) return;
    if (sum != checksum.value()) return warn(mesh, "mesh", "its vertices or primitives have changed");
    const Result<std::shared_ptr<const LodLevels>> restored = LodLevels::restored(mesh, std::move(levels));
    if (!restored) return warn(mesh, "mesh", restored.error().message);
    mesh.setLodLevels(restored.value());
}

} // namespace osgGpuAnimation::serializers
