// SPDX-License-Identifier: MIT
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/NodeCallback>

// Copies and shared nodes, made as applications make them: each shows what its own controller says.

namespace osgGpuAnimation
{

namespace
{

struct CopyCase
{
    const char* name;
    unsigned int flags;
};

const CopyCase copies[] = {
    {"Shallow", osg::CopyOp::SHALLOW_COPY},
    {"DeepNodes", osg::CopyOp::DEEP_COPY_NODES},
    {"DeepNodesAndCallbacks", osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_CALLBACKS},
    {"DeepAll", osg::CopyOp::DEEP_COPY_ALL},
};

std::string wanderer()
{
    return ownScene("Wanderer.glb");
}

class CloningGLTest : public ViewerGLTest
{
protected:
    osg::ref_ptr<osg::Node> load() { return osgDB::readRefNodeFile(wanderer()); }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node& scene, double time)
    {
        return ViewerGLTest::pictureOf(&scene, {time});
    }

    /// Of a scene of its own, taken at these times one after another: the last one.
    osg::ref_ptr<osg::Image> expectedAt(const std::string& clip, const std::vector<double>& times)
    {
        const osg::ref_ptr<osg::Node> scene = load();
        EXPECT_TRUE(findCharacter(*scene)->getController().play(clip));
        osg::ref_ptr<osg::Image> last;
        for (const double time : times)
            last = pictureOf(*scene, time);
        return last;
    }

    StoredScene plugins;
};

/// Copies its children during the update traversal.
class CopyWhileUpdating : public osg::NodeCallback
{
public:
    explicit CopyWhileUpdating(unsigned int flags) : _flags(flags) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        traverse(node, visitor);
        if (!copy) copy = osg::clone(node->asGroup()->getChild(0), osg::CopyOp(_flags));
    }

    osg::ref_ptr<osg::Node> copy;

private:
    unsigned int _flags;
};

} // namespace

class CopiesGLTest : public CloningGLTest, public ::testing::WithParamInterface<CopyCase>
{
protected:
    /// The character alone: a shallow copy of a node above it would have the same one below.
    static osg::ref_ptr<AnimatedCharacter> copyOf(osg::Node& scene)
    {
        return osg::clone(findCharacter(scene), osg::CopyOp(GetParam().flags));
    }

    void expectIndependent(osg::Node& original, AnimatedCharacter& copy)
    {
        AnimatedCharacter& first = *findCharacter(original);
        ASSERT_NE(&first, &copy);
        EXPECT_EQ(&first.getAnimationSet(), &copy.getAnimationSet());
        const std::string last = first.getAnimationSet().clips().back().name();
        const osg::ref_ptr<osg::Image> before = pictureOf(original, 1.0);
        ASSERT_TRUE(copy.getController().play(last));
        copy.getController().setSpeed(0.5);
        EXPECT_EQ(Picture::pixelsDifferent(*before, *pictureOf(original, 1.0)), 0);
        EXPECT_NE(first.getController().clip(), copy.getController().clip());
        osg::ref_ptr<osg::Group> place = new osg::Group;
        place->addChild(&copy);
        pictureOf(*place, 1.0);
        copy.getController().seek(0.0);
        copy.getController().setSpeed(1.0);
        const osg::ref_ptr<osg::Image> shown = pictureOf(*place, 1.5);
        EXPECT_EQ(Picture::pixelsDifferent(*shown, *expectedAt(last, {1.0, 1.5})), 0);
        EXPECT_EQ(Picture::pixelsDifferent(*before, *pictureOf(original, 1.0)), 0);
    }
};

TEST_P(CopiesGLTest, madeBetweenFrames)
{
    for (const bool isDrawn : {false, true})
    {
        const osg::ref_ptr<osg::Node> scene = load();
        if (isDrawn) ViewerGLTest::pictureOf(scene, {0.0, 0.4});
        const osg::ref_ptr<AnimatedCharacter> copy = copyOf(*scene);
        EXPECT_EQ(copy->getController().time(), findCharacter(*scene)->getController().time());
        expectIndependent(*scene, *copy);
    }
}

TEST_P(CopiesGLTest, madeDuringTheUpdate)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<osg::Node> loaded = load();
    scene->addChild(loaded);
    osg::ref_ptr<CopyWhileUpdating> callback = new CopyWhileUpdating(GetParam().flags | osg::CopyOp::DEEP_COPY_NODES);
    scene->setUpdateCallback(callback);
    pictureOf(*scene, 0.0);
    ASSERT_TRUE(callback->copy);
    expectIndependent(*loaded, *osg::ref_ptr<AnimatedCharacter>(findCharacter(*callback->copy)));
}

INSTANTIATE_TEST_SUITE_P(Ways, CopiesGLTest, ::testing::ValuesIn(copies),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_F(CloningGLTest, theObjectCacheHandsOutCharactersOfTheirOwn)
{
    const osg::ref_ptr<osg::Node> source = load();
    ASSERT_TRUE(osgDB::writeNodeFile(*source, plugins.folder.file("kept.osgb")));
    const std::string files[] = {wanderer(), plugins.folder.file("kept.osgb"), wanderer() + ".0,0,90.rot"};
    for (const std::string& file : files)
        for (const auto hint : {osgDB::Options::CACHE_NODES, osgDB::Options::CACHE_ALL})
        {
            SCOPED_TRACE(file);
            osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
            options->setObjectCacheHint(hint);
            const osg::ref_ptr<osg::Node> one = osgDB::readRefNodeFile(file, options);
            ASSERT_TRUE(one && findCharacter(*one));
            findCharacter(*one)->update(0.0);
            findCharacter(*one)->update(0.7);
            const osg::ref_ptr<osg::Node> other = osgDB::readRefNodeFile(file, options);
            ASSERT_TRUE(other && findCharacter(*other));
            EXPECT_NE(findCharacter(*one), findCharacter(*other));
            EXPECT_EQ(&findCharacter(*one)->getAnimationSet(), &findCharacter(*other)->getAnimationSet())
                << "it is cached";
            EXPECT_EQ(findCharacter(*other)->getController().time(), 0.0);
            osgDB::Registry::instance()->clearObjectCache();
        }
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setObjectCacheHint(osgDB::Options::CACHE_OBJECTS); // of readObject, which returns nodes as well
    const auto readObject = [&] { return osgDB::readRefObjectFile(wanderer(), options); };
    const osg::ref_ptr<osg::Object> one = readObject(), other = readObject();
    ASSERT_TRUE(one && one->asNode() && other && other->asNode());
    EXPECT_NE(findCharacter(*one->asNode()), findCharacter(*other->asNode()));
    EXPECT_EQ(&findCharacter(*one->asNode())->getAnimationSet(), &findCharacter(*other->asNode())->getAnimationSet());
    osgDB::Registry::instance()->clearObjectCache();
    options->setObjectCacheHint(osgDB::Options::CACHE_ALL);
    const std::string still = plugins.folder.file("still.osgb");
    ASSERT_TRUE(osgDB::writeNodeFile(*osg::ref_ptr<osg::Group>(new osg::Group), still));
    EXPECT_EQ(osgDB::readRefNodeFile(still, options), osgDB::readRefNodeFile(still, options)) << "as OSG has it";
    const osg::ref_ptr<osg::Node> crowd = osgDB::readRefNodeFile(wanderer() + ".2x2.crowd", options);
    EXPECT_NE(crowd, osgDB::readRefNodeFile(wanderer() + ".2x2.crowd", options));
    osgDB::Registry::instance()->clearObjectCache();
}

} // namespace osgGpuAnimation
