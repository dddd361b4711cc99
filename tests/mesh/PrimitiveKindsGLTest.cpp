// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

#include <vector>

// Instanced draws show every kind of primitives as OSG draws it.

namespace osgGpuAnimation
{

namespace
{

using Primitives = std::vector<osg::ref_ptr<osg::PrimitiveSet>>;

struct PrimitiveKind
{
    const char* name;
    Primitives primitives; ///< of the squares whose corners are 0 to 3 and 4 to 7
    int pixels;            ///< of one character
};

template <typename Elements>
Primitives squaresOf()
{
    Primitives primitives;
    for (unsigned int first : {0u, 4u})
    {
        osg::ref_ptr<Elements> elements = new Elements(GL_TRIANGLES);
        for (unsigned int corner : {0u, 1u, 2u, 0u, 2u, 3u})
            elements->push_back(static_cast<typename Elements::value_type>(first + corner));
        primitives.push_back(elements);
    }
    return primitives;
}

Primitives lengthsOf()
{
    osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_TRIANGLE_FAN, 0);
    lengths->push_back(3);
    lengths->push_back(1); // draws nothing
    lengths->push_back(4);
    return {lengths};
}

Primitives severalOf()
{
    osg::ref_ptr<osg::MultiDrawArrays> several = new osg::MultiDrawArrays(GL_TRIANGLE_FAN);
    several->add(0, 3);
    several->add(4, 4);
    return {several};
}

osg::ref_ptr<AnimatedCharacter> characterOf(const Primitives& primitives)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    for (osg::Array* array : {mesh.getVertexArray(), mesh.getNormalArray()})
    {
        auto& vectors = dynamic_cast<osg::Vec3Array&>(*array);
        vectors.insert(vectors.end(), 4, osg::Vec3(0, -1, 0));
    }
    auto& places = dynamic_cast<osg::Vec3Array&>(*mesh.getVertexArray());
    for (std::size_t corner = 4; corner < 8; ++corner)
        places[corner] = places[corner - 4] + osg::Vec3(1.5f, 0, 0.5f);
    dynamic_cast<osg::Vec4Array&>(*mesh.getColorArray()).resize(8, osg::Vec4(1, 1, 1, 1));
    mesh.removePrimitiveSet(0);
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : primitives)
        mesh.addPrimitiveSet(set);
    character->computeClipBounds();
    character->getController().pause();
    return character;
}

using PrimitiveKindsGLTest = ViewerGLTest;

TEST_F(PrimitiveKindsGLTest, areDrawnByInstancesAsByOneCharacter)
{
    const PrimitiveKind kinds[] = {
        {"the last of an array", {new osg::DrawArrays(GL_TRIANGLE_FAN, 4, 4)}, 64},
        {"lengths", lengthsOf(), 64 + 20},
        {"several ranges", severalOf(), 64 + 20},
        {"bytes", squaresOf<osg::DrawElementsUByte>(), 2 * 64},
        {"shorts", squaresOf<osg::DrawElementsUShort>(), 2 * 64},
        {"integers", squaresOf<osg::DrawElementsUInt>(), 2 * 64},
    };
    for (const PrimitiveKind& kind : kinds)
    {
        SCOPED_TRACE(kind.name);
        const osg::ref_ptr<AnimatedCharacter> first = characterOf(kind.primitives);
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
        const osg::ref_ptr<osg::Group> apart = new osg::Group;
        for (const double height : {-3.0, 0.0, 2.0})
        {
            const osg::Matrixd place = osg::Matrixd::translate(-2, 0, height);
            EXPECT_TRUE(crowd->add(place, first->getController()));
            const osg::ref_ptr<AnimatedCharacter> one = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
            one->setDrawnTogether(false);
            one->setMatrix(place);
            apart->addChild(one);
        }
        const osg::ref_ptr<osg::Image> expected = pictureOf(apart, {0.0});
        EXPECT_GE(picture().pixelsDrawn(), 3 * kind.pixels);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0})), 0);
    }
    EXPECT_NO_GL_ERROR();
}

} // namespace

} // namespace osgGpuAnimation
