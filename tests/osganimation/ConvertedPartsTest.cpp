// SPDX-License-Identifier: MIT
#include "osganimation/MorphMeshes.h"
#include "osganimation/SkeletonConversion.h"
#include "osganimation/SmallRig.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>
#include <osg/BlendFunc>
#include <osg/Material>
#include <osgAnimation/RigGeometry>

namespace osgGpuAnimation
{

namespace
{

const SkinnedGeometry* meshNamed(const AnimatedCharacter& character, const std::string& name)
{
    for (unsigned int i = 0; i < character.getNumChildren(); ++i)
        if (character.getChild(i)->getName() == name)
            return dynamic_cast<const SkinnedGeometry*>(character.getChild(i));
    return nullptr;
}

osg::ref_ptr<AnimatedCharacter> converted(const SmallRig& rig)
{
    const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
    EXPECT_EQ(made.characters.size(), 1u);
    return made.characters.empty() ? nullptr : made.characters.front();
}

osg::ref_ptr<osg::Geometry> triangle(const std::string& name)
{
    osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    made->setName(name);
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    made->setVertexArray(new osg::Vec3Array(3, corners));
    made->setColorArray(new osg::Vec4Array(3), osg::Array::BIND_PER_VERTEX);
    made->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return made;
}

TEST(ConvertedPartsTest, mirroredBonesStayMirrored)
{
    const SmallRig rig;
    auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*rig.lower->getUpdateCallback());
    const osg::Matrix mirror = osg::Matrix::scale(2, -3, 4) * osg::Matrix::rotate(0.5, osg::Vec3(1, 0, 0));
    update.getStackedTransforms().push_back(new osgAnimation::StackedMatrixElement("mirror", mirror));
    osg::Matrix expected = mirror * osg::Matrix::rotate(0.3, osg::Vec3(0, 1, 0)) * osg::Matrix::translate(0, 0, 1) *
                           osg::Matrix::rotate(0.2, osg::Vec3(1, 0, 0)) * osg::Matrix::translate(0, 0, 0.1);
    const osg::ref_ptr<AnimatedCharacter> character = converted(rig);
    ASSERT_TRUE(character);
    character->getController().stop();
    const Result<osg::Matrixd> found = character->jointToModel("lower");
    ASSERT_TRUE(found);
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(found.value().ptr()[i], expected.ptr()[i], 1e-5) << i;
}

/// Of a vertex with ten bones the eight largest weights remain, scaled to 1.
TEST(ConvertedPartsTest, theLargestInfluencesRemain)
{
    const SmallRig rig;
    osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (int i = 0; i < 10; ++i)
    {
        const std::string name = "strand" + std::to_string(i);
        osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
        bone->setUpdateCallback(new osgAnimation::UpdateBone(name));
        rig.upper->addChild(bone);
        for (unsigned int vertex = 0; vertex < 3; ++vertex)
            (*map)[name].emplace_back(vertex, static_cast<float>(i + 1));
    }
    rig.skeleton->addChild(SmallRig::rigged("coat", triangle("coat"), *map));
    const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
    ASSERT_EQ(made.characters.size(), 1u);
    EXPECT_EQ(made.warnings, std::vector<std::string>{"mesh \"coat\": 3 vertices have more than 8 influences; the 8 "
                                                      "largest are kept"});
    const SkinnedGeometry* const mesh = meshNamed(*made.characters.front(), "coat");
    ASSERT_TRUE(mesh);
    const AnimationSet& set = made.characters.front()->getAnimationSet();
    double sum = 0.0;
    mesh->forEachInfluence(1,
                           [&](std::size_t entry, float weight)
                           {
                               const int joint = set.palette()[entry].joint;
                               const std::string& name = set.skeleton().joint(static_cast<std::size_t>(joint)).name;
                               EXPECT_NEAR(weight, (std::stof(name.substr(6)) + 1.0f) / 52.0f, 1e-6)
                                   << name; // 3 + … + 10
                               sum += static_cast<double>(weight);
                           });
    EXPECT_NEAR(sum, 1.0, 1e-6);
}

/// What a bone of a bone carries is in the space of the lower one.
TEST(ConvertedPartsTest, statesMasksAndPlacesComeAlong)
{
    const SmallRig rig;
    rig.skeleton->setNodeMask(0x6);
    rig.upper->setMatrix(osg::Matrix::translate(0, 0, 0.1));
    const osg::ref_ptr<osgAnimation::Bone> tip = new osgAnimation::Bone("tip");
    tip->setUpdateCallback(new osgAnimation::UpdateBone("tip"));
    const osg::ref_ptr<osg::MatrixTransform> held = new osg::MatrixTransform(osg::Matrix::translate(0, 3, 0));
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    const osg::ref_ptr<osg::Geometry> coloured = triangle("coloured"), plain = triangle("plain");
    for (osg::Geometry* const geometry : {coloured.get(), plain.get()})
    {
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setColorMode(geometry == coloured.get() ? osg::Material::DIFFUSE : osg::Material::OFF);
        geometry->getOrCreateStateSet()->setAttribute(material);
        geode->addDrawable(geometry);
    }
    held->addChild(geode);
    tip->addChild(held);
    rig.lower->addChild(tip);
    const osg::ref_ptr<osg::Geometry> source = triangle("source");
    source->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc);
    const osg::ref_ptr<osg::Geode> cuff = SmallRig::rigged("cuff", source, "upper");
    cuff->getDrawable(0)->setStateSet(nullptr);
    rig.skeleton->addChild(cuff);
    const osg::ref_ptr<osg::Geode> glove = SmallRig::rigged("", triangle(""), "lower");
    glove->setName("glove");
    rig.skeleton->addChild(glove);
    const osg::ref_ptr<AnimatedCharacter> character = converted(rig);
    ASSERT_TRUE(character);
    EXPECT_EQ(character->getNodeMask(), 0x6u);
    const SkinnedGeometry* const meshes[] = {meshNamed(*character, "coloured"), meshNamed(*character, "plain"),
                                             meshNamed(*character, "cuff")};
    ASSERT_TRUE(meshes[0] && meshes[1] && meshes[2]);
    EXPECT_TRUE(meshNamed(*character, "glove")) << "its Geode's name";
    EXPECT_TRUE(meshes[0]->getColorArray());
    EXPECT_FALSE(meshes[1]->getColorArray()) << "the fixed pipeline does not show them";
    EXPECT_TRUE(meshes[2]->getStateSet()->getMode(GL_BLEND) & osg::StateAttribute::ON) << "the source's own state";
    character->getController().stop();
    const osg::Vec3d inTip = osg::Vec3d(1, 3, 0) * character->jointToModel("tip").value();
    const osg::ref_ptr<osg::Geometry> posed = character->getPosedMesh(*meshes[0]);
    ASSERT_TRUE(posed);
    const osg::Vec3 found = (*static_cast<const osg::Vec3Array*>(posed->getVertexArray()))[1];
    EXPECT_LT((osg::Vec3d(found) - inTip).length(), 1e-5);
}

/// osgAnimation's material animations go on: their callbacks stay with their materials.
TEST(ConvertedPartsTest, callbacksOfMaterialsStay)
{
    class Callback : public osg::StateAttributeCallback
    {
        void operator()(osg::StateAttribute*, osg::NodeVisitor*) override {}
    };
    const SmallRig rig;
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setUpdateCallback(new Callback);
    rig.skeleton->getChild(rig.skeleton->getNumChildren() - 1)->getOrCreateStateSet()->setAttribute(material);
    ASSERT_TRUE(converted(rig));
    EXPECT_TRUE(material->getUpdateCallback());
}

// Targets of method NORMALIZED are whole shapes: equal ones change nothing.
TEST(ConvertedPartsTest, equalShapesHaveNoDeltas)
{
    osg::ref_ptr<osg::Geometry> shapes[] = {triangle("base"), triangle("target")};
    for (const osg::ref_ptr<osg::Geometry>& shape : shapes)
    {
        shape->setNormalArray(new osg::Vec3Array(3), osg::Array::BIND_PER_VERTEX);
        for (osg::Vec3& normal : static_cast<osg::Vec3Array&>(*shape->getNormalArray()))
            normal.set(0, -1, 0);
    }
    const osg::ref_ptr<osgAnimation::MorphGeometry> mesh = new osgAnimation::MorphGeometry(*shapes[0]);
    mesh->setMethod(osgAnimation::MorphGeometry::NORMALIZED);
    mesh->addMorphTarget(shapes[1], 0.0f);
    const auto targets = osganimation::morphTargetsOf(*mesh);
    ASSERT_TRUE(targets);
    ASSERT_TRUE((*targets)[0].normals);
    for (const osg::Vec3& normal : *(*targets)[0].normals)
        EXPECT_EQ(normal, osg::Vec3());
}

/// Bones in one another below a bone; a bone is `times` times the child of the one above. Taken apart one by one.
struct BoneChain
{
    BoneChain(osgAnimation::Bone& top, std::size_t count, unsigned int times)
    {
        bones.push_back(&top);
        for (std::size_t i = 0; i < count; ++i)
            bones.push_back(new osgAnimation::Bone("bone " + std::to_string(i)));
        for (std::size_t i = count; i > 0; --i) // the innermost first: counts of children pass up one level
            for (unsigned int time = 0; time < times; ++time)
                bones[i - 1]->addChild(bones[i]);
    }
    ~BoneChain()
    {
        for (; bones.size() > 1; bones.pop_back())
            bones[bones.size() - 2]->removeChild(bones.back());
    }
    std::vector<osg::ref_ptr<osg::Group>> bones;
};

TEST(BrokenSkeletonsTest, theyStayAsTheyAre)
{
    const struct
    {
        const char* name;
        std::size_t depth;
        unsigned int times;
        const char* fault;
    } cases[] = {{"30,000 nested bones", 30'000, 1, " nodes above it"},
                 {"millions of paths", 22, 2, "more than 1000000 paths lead to its groups"}};
    for (const auto& each : cases)
    {
        SCOPED_TRACE(each.name);
        const SmallRig rig;
        const BoneChain chain(*rig.lower, each.depth, each.times);
        const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
        EXPECT_TRUE(made.characters.empty());
        ASSERT_FALSE(made.warnings.empty());
        EXPECT_NE(made.warnings.back().find(each.fault), std::string::npos) << made.warnings.back();
        EXPECT_NE(made.warnings.back().find("it stays as it is"), std::string::npos) << made.warnings.back();
    }
}

TEST(BrokenSkeletonsTest, aBoneBelowItselfIsNamed)
{
    const SmallRig rig;
    rig.lower->addChild(rig.upper);
    const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
    EXPECT_TRUE(made.characters.empty());
    EXPECT_EQ(made.warnings,
              std::vector<std::string>{"skeleton \"arm\": node \"upper\" is below itself; it stays as it is"});
    rig.lower->removeChild(rig.upper);
}

TEST(BrokenSkeletonsTest, aMissingPrimitiveSetCostsItself)
{
    const SmallRig rig;
    const osg::ref_ptr<osg::Geometry> geometry = triangle("odd");
    geometry->getPrimitiveSetList().insert(geometry->getPrimitiveSetList().begin(), nullptr);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(geometry);
    rig.lower->addChild(geode);
    const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
    ASSERT_EQ(made.characters.size(), 1u);
    const SkinnedGeometry* const mesh = meshNamed(*made.characters[0], "odd");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->getNumPrimitiveSets(), 1u);
    EXPECT_EQ(made.warnings,
              std::vector<std::string>{"mesh \"odd\": a primitive set is missing or has indices beyond its "
                                       "vertices; left out"});
}

} // namespace

} // namespace osgGpuAnimation
