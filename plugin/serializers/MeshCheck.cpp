// SPDX-License-Identifier: MIT
#include "serializers/MeshCheck.h"

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/NodeVisitor>
#include <osg/Notify>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::serializers
{

namespace
{

using Fault = std::optional<std::string>;

std::string counted(std::size_t found, const char* of, std::size_t wanted)
{
    return std::to_string(found) + " " + of + " of " + std::to_string(wanted);
}

bool isShorter(const osg::Array* array, std::size_t vertices)
{
    return array && array->getBinding() == osg::Array::BIND_PER_VERTEX && array->getNumElements() < vertices;
}

Fault findFaultInArrays(const SkinnedGeometry& mesh, std::size_t vertices)
{
    osg::Geometry::ArrayList arrays;
    mesh.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (isShorter(array.get(), vertices)) return counted(array->getNumElements(), "elements of an array", vertices);
    return std::nullopt;
}

Fault findFaultInPrimitives(const SkinnedGeometry& mesh, std::size_t vertices)
{
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
    {
        if (!primitives) return "a primitive set that is none";
        if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(primitives.get()))
            if (arrays->getFirst() < 0 || arrays->getCount() < 0) return "a range of vertices below 0";
        for (unsigned int i = 0; i < primitives->getNumIndices(); ++i)
        {
            if (primitives->index(i) >= vertices) return counted(primitives->index(i), "as a vertex", vertices);
            if (primitives->getType() == osg::PrimitiveSet::DrawArraysPrimitiveType) // ascending
                i = std::max(i, primitives->getNumIndices() - 2);
        }
    }
    return std::nullopt;
}

Fault findFaultInEntries(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    if (mesh.rigidEntry() >= 0)
    {
        if (static_cast<std::size_t>(mesh.rigidEntry()) < set.paletteSize()) return std::nullopt;
        return counted(static_cast<std::size_t>(mesh.rigidEntry()), "as an entry", set.paletteSize());
    }
    if (!mesh.entries(0) || !mesh.weights(0)) return "no influences";
    for (unsigned int influences = 0; influences < SkinnedGeometry::maxInfluenceSets; ++influences)
    {
        const osg::Vec4usArray* entries = mesh.entries(influences);
        for (std::size_t vertex = 0; entries && vertex < entries->size(); ++vertex)
            for (int i = 0; i < 4; ++i)
                if ((*entries)[vertex][i] >= set.paletteSize())
                    return counted((*entries)[vertex][i], "as an entry", set.paletteSize());
    }
    return std::nullopt;
}

Fault findFaultInMorphs(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    if (mesh.morphTargets().empty()) return std::nullopt;
    if (mesh.morph() < 0 || static_cast<std::size_t>(mesh.morph()) >= set.morphs().size())
        return "a morph that is not the set's";
    const std::size_t weights = set.morphs()[static_cast<std::size_t>(mesh.morph())].defaults.size();
    if (mesh.morphTargets().size() > weights) return counted(mesh.morphTargets().size(), "morph targets", weights);
    if (mesh.morphEntry() != set.entryOfMorph(static_cast<std::size_t>(mesh.morph()))) return "a wrong morph entry";
    return std::nullopt;
}

Fault findFault(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    const osg::Array* positions = mesh.getVertexArray();
    if (!positions) return "no vertices";
    const std::size_t vertices = positions->getNumElements();
    Fault fault = findFaultInArrays(mesh, vertices);
    if (!fault) fault = findFaultInPrimitives(mesh, vertices);
    if (!fault) fault = findFaultInEntries(mesh, set);
    return fault ? fault : findFaultInMorphs(mesh, set);
}

class UnfitMeshes : public osg::NodeVisitor
{
public:
    explicit UnfitMeshes(const AnimationSet& set) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _set(set) {}

    void apply(osg::Drawable& drawable) override
    {
        const auto* mesh = dynamic_cast<const SkinnedGeometry*>(&drawable);
        const Fault fault = mesh ? findFault(*mesh, _set) : Fault();
        if (!fault) return;
        OSG_WARN << "osgGpuAnimation: mesh \"" << drawable.getName() << "\" has " << *fault << "; it is not drawn"
                 << std::endl;
        found.push_back(&drawable);
    }

    std::vector<osg::ref_ptr<osg::Drawable>> found;

private:
    const AnimationSet& _set;
};

} // namespace

void removeUnfitMeshes(osg::Group& group, const AnimationSet& set)
{
    UnfitMeshes unfit(set);
    group.traverse(unfit);
    for (const osg::ref_ptr<osg::Drawable>& mesh : unfit.found)
        while (mesh->getNumParents() > 0)
            mesh->getParent(0)->removeChild(mesh);
}

} // namespace osgGpuAnimation::serializers
