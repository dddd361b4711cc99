// SPDX-License-Identifier: MIT
#include "plugin/SharedAssets.h"
#include "plugin/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osg/ShapeDrawable>
#include <osgUtil/Optimizer>

// Every flag of osgUtil::Optimizer, one by one and all at once: the pictures stay the same.

namespace osgGpuAnimation
{

namespace
{

using Flags = osgUtil::Optimizer::OptimizationOptions;

struct FlagCase
{
    const char* name;
    unsigned int flags;
};

const FlagCase flagCases[] = {
    {"Default", Flags::DEFAULT_OPTIMIZATIONS},
    {"All", Flags::ALL_OPTIMIZATIONS},
    {"FlattenStaticTransforms", Flags::FLATTEN_STATIC_TRANSFORMS},
    {"RemoveRedundantNodes", Flags::REMOVE_REDUNDANT_NODES},
    {"RemoveLoadedProxyNodes", Flags::REMOVE_LOADED_PROXY_NODES},
    {"CombineAdjacentLods", Flags::COMBINE_ADJACENT_LODS},
    {"ShareDuplicateState", Flags::SHARE_DUPLICATE_STATE},
    {"MergeGeometry", Flags::MERGE_GEOMETRY},
    {"CheckGeometry", Flags::CHECK_GEOMETRY},
    {"MakeFastGeometry", Flags::MAKE_FAST_GEOMETRY},
    {"SpatializeGroups", Flags::SPATIALIZE_GROUPS},
    {"CopySharedNodes", Flags::COPY_SHARED_NODES},
    {"TristripGeometry", Flags::TRISTRIP_GEOMETRY},
    {"TessellateGeometry", Flags::TESSELLATE_GEOMETRY},
    {"OptimizeTextureSettings", Flags::OPTIMIZE_TEXTURE_SETTINGS},
    {"MergeGeodes", Flags::MERGE_GEODES},
    {"FlattenBillboards", Flags::FLATTEN_BILLBOARDS},
    {"TextureAtlasBuilder", Flags::TEXTURE_ATLAS_BUILDER},
    {"StaticObjectDetection", Flags::STATIC_OBJECT_DETECTION},
    {"FlattenDuplicating", Flags::FLATTEN_STATIC_TRANSFORMS_DUPLICATING_SHARED_SUBGRAPHS},
    {"IndexMesh", Flags::INDEX_MESH},
    {"VertexPosttransform", Flags::VERTEX_POSTTRANSFORM},
    {"VertexPretransform", Flags::VERTEX_PRETRANSFORM},
    {"BufferObjectSettings", Flags::BUFFER_OBJECT_SETTINGS},
};

class OptimizerGLTest : public ViewerGLTest, public ::testing::WithParamInterface<FlagCase>
{
protected:
    int pictureSide() const override { return 160; }

    static osg::ref_ptr<osg::MatrixTransform> placed(osg::Node* node, const osg::Matrix& matrix)
    {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(matrix);
        place->setDataVariance(osg::Object::STATIC);
        place->addChild(node);
        return place;
    }

    /// Pictures of the scene from a fixed camera, which does not depend on the scene's bounds.
    std::vector<osg::ref_ptr<osg::Image>> pictures(osg::Node& scene)
    {
        viewer().setSceneData(&scene);
        viewer().getCamera()->setProjectionMatrixAsOrtho(-5, 5, -5, 5, 1, 60);
        viewer().getCamera()->setViewMatrixAsLookAt({6, -24, 8}, {0, 0, 1}, {0, 0, 1});
        std::vector<osg::ref_ptr<osg::Image>> taken;
        for (const double time : {0.0, 0.45})
        {
            drawAt(time);
            taken.push_back(picture().copy());
        }
        return taken;
    }

    void expectSamePictures(osg::ref_ptr<osg::Node> (*make)())
    {
        const osg::ref_ptr<osg::Node> plain = make();
        const auto expected = pictures(*plain);
        EXPECT_GT(Picture::pixelsDifferent(*expected[0], *expected[1]), 20) << "nothing moves";
        const osg::ref_ptr<osg::Node> optimized = make();
        // Twice, because osgviewer optimizes a scene again that osgconv has optimized.
        osgUtil::Optimizer().optimize(optimized, GetParam().flags);
        osgUtil::Optimizer().optimize(optimized, GetParam().flags);
        const auto found = pictures(*optimized);
        for (std::size_t i = 0; i < expected.size(); ++i)
        {
            // Flattened matrices round differently, which moves edges.
            EXPECT_LE(Picture::pixelsDifferent(*expected[i], *found[i]), 12) << "picture " << i;
        }
    }

    static osg::ref_ptr<osg::Node> makeCharacters()
    {
        osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(ownScene("Wanderer.glb"));
        osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand_R");
        const osg::ref_ptr<osg::ShapeDrawable> box = new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.3f));
        box->setUseDisplayList(false); // Mesa's zink leaves one out now and then
        box->setUseVertexBufferObjects(true);
        hand->addChild(box);
        findCharacter(*model)->addChild(hand);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(placed(model, osg::Matrix::translate(-2, 0, 0)));
        const osg::Matrix turned = osg::Matrix::rotate(1.0, 0, 0, 1) * osg::Matrix::translate(2, 0, 0);
        scene->addChild(placed(placed(model, osg::Matrix::scale(1.3, 1.3, 1.3)), turned));
        osg::ref_ptr<osg::Node> other = osg::clone(model.get(), osg::CopyOp::DEEP_COPY_NODES);
        findCharacter(*other)->getController().seek(0.3);
        scene->addChild(placed(other, osg::Matrix::translate(0, 0, 2)));
        return scene;
    }

    static osg::ref_ptr<osg::Node> makeCrowds()
    {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("spacing=2");
        osg::ref_ptr<osg::Node> crowd = osgDB::readRefNodeFile(ownScene("Wanderer.glb.2x2.crowd"), options);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(placed(crowd, osg::Matrix::translate(-2, 0, 0)));
        scene->addChild(placed(osg::clone(crowd.get(), osg::CopyOp::DEEP_COPY_NODES),
                               osg::Matrix::rotate(1.0, 0, 0, 1) * osg::Matrix::translate(2, 0, 1)));
        return scene;
    }

    StoredScene plugins;
};

} // namespace

TEST_P(OptimizerGLTest, charactersLookTheSame)
{
    expectSamePictures(makeCharacters);
}

TEST_P(OptimizerGLTest, crowdsLookTheSame)
{
    expectSamePictures(makeCrowds);
}

INSTANTIATE_TEST_SUITE_P(Flags, OptimizerGLTest, ::testing::ValuesIn(flagCases),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace osgGpuAnimation
