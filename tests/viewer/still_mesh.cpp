// SPDX-License-Identifier: MIT
// Usage: still_mesh CHARACTER.glb STILL.osgt
// Stores the first frame of the first clip of the file's first character as plain osg::Geometry that the fixed pipeline
// draws.
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <vector>

namespace
{

using namespace osgGpuAnimation;

/// Gives each triangle vertices of its own, with its normal.
void makeFlat(osg::Geometry& mesh)
{
    std::vector<std::uint32_t> corners;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
        for (const std::uint32_t corner : LodLevels::trianglesOf(primitives, mesh.getVertexArray()->getNumElements()))
            corners.push_back(corner);
    const auto gathered = [&](const auto& array)
    {
        auto result = osg::clone(&array, osg::CopyOp::SHALLOW_COPY);
        result->clear();
        for (const std::uint32_t corner : corners)
            result->push_back(array[corner]);
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

void replace(osg::Node& old, osg::Node& with)
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
    const osg::ref_ptr<AnimatedCharacter> character = model ? findCharacter(*model) : nullptr;
    if (!character) return 1;
    root->addChild(model);
    const osg::BoundingSphere bound = character->getBound(); // of its meshes, which are replaced below
    std::vector<osg::ref_ptr<SkinnedGeometry>> meshes;
    forEachMeshBelow(*character, [&](SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    for (const osg::ref_ptr<SkinnedGeometry>& mesh : meshes)
        replace(*mesh, *still(*character, *mesh));
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(character->getMatrix());
    place->setInitialBound(bound);
    place->setName(character->getName());
    place->setStateSet(character->getStateSet());
    for (unsigned int i = 0; i < character->getNumChildren(); ++i)
        place->addChild(character->getChild(i));
    replace(*character, *place);
    return osgDB::writeNodeFile(*root->getChild(0), argv[2], new osgDB::Options("WriteImageHint=IncludeData")) ? 0 : 1;
}
