// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geode>
#include <osg/Material>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedRotateAxisElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgGpuAnimation/animation/Channel.h>

#include <string>

namespace osgGpuAnimation
{

/// A scene of osgAnimation with all that a conversion turns: two bones with stacked transforms, a RigGeometry, a
/// geometry and another node below a bone, and animations with linear, slerp, step, cubic Bezier and matrix channels.
class SmallRig
{
public:
    /// A mesh below a geode, skinned by the bones of the map.
    static osg::ref_ptr<osg::Geode> rigged(const std::string& name, osg::Geometry* source,
                                           osgAnimation::VertexInfluenceMap& map)
    {
        for (auto& [bone, influence] : map)
            influence.setName(bone);
        osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
        rig->setName(name);
        rig->setSourceGeometry(source);
        rig->setInfluenceMap(&map);
        osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->addDrawable(rig);
        return geode;
    }
    /// All vertices follow one bone.
    static osg::ref_ptr<osg::Geode> rigged(const std::string& name, osg::Geometry* source, const std::string& bone)
    {
        const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
        for (unsigned int vertex = 0; vertex < source->getVertexArray()->getNumElements(); ++vertex)
            (*map)[bone].emplace_back(vertex, 1.0f);
        return rigged(name, source, *map);
    }

    SmallRig()
    {
        skeleton->setName("arm");
        skeleton->setMatrix(osg::Matrix::translate(0.2, 0.0, -0.3));
        skeleton->setUpdateCallback(new osgAnimation::Skeleton::UpdateSkeleton);
        upper->setName("upper");
        lower->setName("lower");
        osg::ref_ptr<osgAnimation::UpdateBone> upperUpdate = new osgAnimation::UpdateBone("upper");
        upperUpdate->getStackedTransforms().push_back(
            new osgAnimation::StackedTranslateElement("translate", osg::Vec3(0.0f, 0.0f, 0.1f)));
        upperUpdate->getStackedTransforms().push_back(
            new osgAnimation::StackedRotateAxisElement("swing", osg::Vec3(1, 0, 0), 0.2));
        upperUpdate->getStackedTransforms().push_back(
            new osgAnimation::StackedScaleElement("scale", osg::Vec3(1.0f, 1.0f, 1.0f)));
        upper->setUpdateCallback(upperUpdate);
        osg::ref_ptr<osgAnimation::UpdateBone> lowerUpdate = new osgAnimation::UpdateBone("lower");
        lowerUpdate->getStackedTransforms().push_back(
            new osgAnimation::StackedMatrixElement("matrix", osg::Matrix::translate(0.0, 0.0, 1.0)));
        lowerUpdate->getStackedTransforms().push_back(
            new osgAnimation::StackedQuaternionElement("rotate", osg::Quat(0.3, osg::Vec3d(0, 1, 0))));
        lower->setUpdateCallback(lowerUpdate);
        upper->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(0.0, 0.0, -0.1));
        lower->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(0.0, 0.0, -1.1));
        skeleton->addChild(upper);
        upper->addChild(lower);
        addMeshes();
        addAnimations();
        root->addChild(skeleton);
        root->setUpdateCallback(manager);
    }

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    osg::ref_ptr<osgAnimation::Bone> upper = new osgAnimation::Bone;
    osg::ref_ptr<osgAnimation::Bone> lower = new osgAnimation::Bone;
    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager = new osgAnimation::BasicAnimationManager;

private:
    static osg::ref_ptr<osg::Geometry> ribbon(const std::string& name)
    {
        osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
        made->setName(name);
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        for (int i = 0; i <= 4; ++i)
            for (const float x : {-0.2f, 0.2f})
                vertices->push_back(osg::Vec3(x, 0.0f, 0.5f * static_cast<float>(i)));
        made->setVertexArray(vertices);
        osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(10);
        for (osg::Vec3& normal : *normals)
            normal.set(0.0f, -1.0f, 0.0f);
        made->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        made->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 10));
        return made;
    }

    void addMeshes()
    {
        osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
        for (unsigned int vertex = 0; vertex < 10; ++vertex)
        {
            const float share = static_cast<float>(vertex / 2) / 4.0f;
            // The sums are 2: osgAnimation divides by them.
            if (share < 1.0f) (*map)["upper"].emplace_back(vertex, 2.0f - 2.0f * share);
            if (share > 0.0f) (*map)["lower"].emplace_back(vertex, 2.0f * share);
        }
        const osg::ref_ptr<osg::Geode> geode = rigged("sleeve", ribbon("sleeve"), *map);
        osg::ref_ptr<osg::Material> red = new osg::Material;
        red->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.1f, 0.1f, 1.0f));
        geode->getOrCreateStateSet()->setAttribute(red);
        osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(0.1, 0.0, 0.0));
        beside->addChild(geode);
        skeleton->addChild(beside);

        osg::ref_ptr<osg::MatrixTransform> held = new osg::MatrixTransform(osg::Matrix::translate(0.4, 0.0, 0.5));
        osg::ref_ptr<osg::Geode> heldGeode = new osg::Geode;
        heldGeode->addDrawable(ribbon("flag"));
        held->addChild(heldGeode);
        lower->addChild(held);
    }

    template <class Channel, class Container, class Value>
    static osg::ref_ptr<osgAnimation::Channel> channel(const char* bone, const char* name,
                                                       std::initializer_list<std::pair<double, Value>> keys)
    {
        osg::ref_ptr<Container> container = new Container;
        for (const auto& [time, value] : keys)
            container->push_back(typename Container::KeyType(time, value));
        osg::ref_ptr<Channel> made = new Channel;
        made->setTargetName(bone);
        made->setName(name);
        made->getOrCreateSampler()->setKeyframeContainer(container);
        return made;
    }

    void addAnimations()
    {
        using namespace osgAnimation;
        osg::ref_ptr<Animation> wave = new Animation, jump = new Animation;
        wave->setName("Wave");
        jump->setName("Jump");
        wave->addChannel(channel<FloatCubicBezierChannel, FloatCubicBezierKeyframeContainer, FloatCubicBezier>(
            "upper", "swing", {{0.0, FloatCubicBezier(0.0f, 0.0f, 1.0f)}, {1.0, FloatCubicBezier(1.2f, 2.0f, 1.2f)}}));
        wave->addChannel(channel<QuatSphericalLinearChannel, QuatKeyframeContainer, osg::Quat>(
            "lower", "rotate",
            {{0.0, osg::Quat(0.0, osg::Vec3d(0, 1, 0))}, {0.7, osg::Quat(1.5, osg::Vec3d(0, 1, 0))}}));
        wave->addChannel(channel<Vec3LinearChannel, Vec3KeyframeContainer, osg::Vec3>(
            "upper", "scale", {{0.0, osg::Vec3(1, 1, 1)}, {0.5, osg::Vec3(1.5f, 1.5f, 1.5f)}}));
        jump->addChannel(channel<Vec3StepChannel, Vec3KeyframeContainer, osg::Vec3>(
            "upper", "translate", {{0.0, osg::Vec3(0, 0, 0)}, {0.4, osg::Vec3(0, 0, 1)}, {1.0, osg::Vec3(0, 0, 0)}}));
        jump->addChannel(channel<MatrixLinearChannel, MatrixKeyframeContainer, osg::Matrixf>(
            "lower", "matrix",
            {{0.0, osg::Matrixf::translate(0, 0, 1)}, {0.8, osg::Matrixf::translate(0.3f, 0, 1.4f)}}));
        manager->registerAnimation(wave);
        manager->registerAnimation(jump);
    }
};

} // namespace osgGpuAnimation
