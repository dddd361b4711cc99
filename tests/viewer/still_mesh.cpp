// SPDX-License-Identifier: MIT
// Usage: still_mesh CHARACTER.glb STILL.osgt
// Stores the first frame of the file's first clip as plain osg::Geometry that the fixed pipeline draws.
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/TriangleIndexFunctor>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <iostream>
#include <vector>

namespace
{

using namespace osgGpuAnimation;

template <typename Wanted>
class Collector : public osg::NodeVisitor
{
public:
    Collector() : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Node& node) override
    {
        if (auto* wanted = dynamic_cast<Wanted*>(&node)) found.push_back(wanted);
        traverse(node);
    }
    std::vector<osg::ref_ptr<Wanted>> found;
};

template <typename Wanted>
std::vector<osg::ref_ptr<Wanted>> below(osg::Node& node)
{
    Collector<Wanted> collector;
    node.accept(collector);
    return collector.found;
}

struct TriangleIndices
{
    void operator()(unsigned int a, unsigned int b, unsigned int c) { indices.insert(indices.end(), {a, b, c}); }
    std::vector<unsigned int> indices;
};

/// Gives each triangle vertices of its own, with its normal.
void makeFlat(osg::Geometry& mesh)
{
    osg::TriangleIndexFunctor<TriangleIndices> triangles;
    mesh.accept(triangles);
    const auto gathered = [&](const auto& array)
    {
        auto result = osg::clone(&array, osg::CopyOp::SHALLOW_COPY);
        result->clear();
        for (const unsigned int index : triangles.indices)
            result->push_back(array[index]);
        return result;
    };
    osg::ref_ptr<osg::Vec3Array> positions = gathered(static_cast<osg::Vec3Array&>(*mesh.getVertexArray()));
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    for (std::size_t i = 0; i + 2 < positions->size(); i += 3)
    {
        osg::Vec3 normal = ((*positions)[i + 1] - (*positions)[i]) ^ ((*positions)[i + 2] - (*positions)[i]);
        normal.normalize();
        normals->insert(normals->end(), 3, normal);
    }
    if (const auto* coordinates = dynamic_cast<osg::Vec2Array*>(mesh.getTexCoordArray(0)))
        mesh.setTexCoordArray(0, gathered(*coordinates));
    mesh.setVertexArray(positions);
    mesh.setNormalArray(normals);
    mesh.removePrimitiveSet(0, mesh.getNumPrimitiveSets());
    mesh.addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(positions->size())));
}

osg::ref_ptr<osg::Geometry> still(const AnimatedCharacter& character, const SkinnedGeometry& mesh)
{
    osg::ref_ptr<osg::Geometry> plain = character.getPosedMesh(mesh, true);
    const osg::ref_ptr<osg::Geometry> usual = new osg::Geometry;
    plain->setUseDisplayList(usual->getUseDisplayList());
    plain->setUseVertexBufferObjects(usual->getUseVertexBufferObjects());
    plain->setInitialBound(character.getCurrentBounds()); // programs place cameras and grounds by it
    if (!mesh.getStateSet()) return plain;
    bool isFlat = false;
    if (const osg::Uniform* uniform = mesh.getStateSet()->getUniform("flatNormals")) uniform->get(isFlat);
    if (isFlat || !plain->getNormalArray()) makeFlat(*plain);
    osg::ref_ptr<osg::StateSet> state = osg::clone(mesh.getStateSet());
    state->removeAttribute(osg::StateAttribute::PROGRAM);
    state->getUniformList().clear();
    state->getDefineList().clear();
    plain->setStateSet(state);
    return plain;
}

template <typename Old>
void replace(Old& old, osg::Node& with)
{
    const osg::Node::ParentList parents = old.getParents();
    for (osg::Group* parent : parents)
        parent->replaceChild(&old, &with);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 3) return 2;
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("start=0 speed=0 lighting=fixed");
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(argv[1], options);
    if (!model) return 1;
    root->addChild(model);
    for (const osg::ref_ptr<AnimatedCharacter>& character : below<AnimatedCharacter>(*root))
    {
        const osg::BoundingSphere bound = character->getBound(); // of its meshes, which are replaced below
        for (const osg::ref_ptr<SkinnedGeometry>& mesh : below<SkinnedGeometry>(*character))
            replace(*mesh, *still(*character, *mesh));
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(character->getMatrix());
        place->setInitialBound(bound);
        place->setName(character->getName());
        place->setStateSet(character->getStateSet());
        for (unsigned int i = 0; i < character->getNumChildren(); ++i)
            place->addChild(character->getChild(i));
        replace(*character, *place);
    }
    return osgDB::writeNodeFile(*root->getChild(0), argv[2], new osgDB::Options("WriteImageHint=IncludeData")) ? 0 : 1;
}
