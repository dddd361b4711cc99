// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Export.h"
#include "gltf/GlbText.h"
#include "gltf/Import.h"
#include "support/Results.h"

#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The vertices of a scene at a time of a clip, and the places of its joints, in the scene's space.
class PosedScene : public osg::NodeVisitor
{
public:
    /// clip: of all characters; -1: the rest pose.
    PosedScene(osg::Node& scene, int clip, double time)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _clip(clip), _time(time)
    {
        scene.accept(*this);
    }

    /// In the order of the traversal; by "mesh NAME, VERTICES" and "joint NAME".
    std::map<std::string, std::vector<osg::Vec3d>> points;

    double size() const ///< the largest coordinate
    {
        double largest = 0.0;
        for (const auto& [name, places] : points)
            for (const osg::Vec3d& at : places)
                largest = std::max({largest, std::abs(at.x()), std::abs(at.y()), std::abs(at.z())});
        return largest;
    }

    void apply(osg::Transform& node) override
    {
        AnimatedCharacter* const outer = _character;
        if (auto* const character = dynamic_cast<AnimatedCharacter*>(&node)) enter(*character);
        traverse(node);
        _character = outer;
    }

    void apply(osg::Drawable& drawable) override
    {
        const auto* const skinned = dynamic_cast<const SkinnedGeometry*>(&drawable);
        const osg::ref_ptr<const osg::Geometry> geometry = skinned && _character
                                                               ? _character->getPosedMesh(*skinned)
                                                               : osg::ref_ptr<osg::Geometry>(drawable.asGeometry());
        const auto* const vertices =
            geometry ? dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray()) : nullptr;
        if (!vertices) return;
        const osg::Matrixd toScene = osg::computeLocalToWorld(getNodePath());
        for (const osg::Vec3& vertex : *vertices)
            points["mesh " + meshNameOf(drawable) + ", " + std::to_string(vertices->size())].push_back(
                osg::Vec3d(vertex) * toScene);
    }

private:
    void enter(AnimatedCharacter& character)
    {
        _character = &character;
        AnimationController& controller = character.getController();
        controller.stop();
        controller.setLoopMode(LoopMode::Once); // a clip does not wrap at its end
        if (_clip >= 0)
        {
            static_cast<void>(controller.play(static_cast<std::size_t>(_clip)));
            controller.pause();
            controller.seek(_time);
        }
        const osg::Matrixd toScene = osg::computeLocalToWorld(getNodePath());
        const Skeleton& skeleton = character.getAnimationSet().skeleton();
        for (std::size_t joint = 0; joint < skeleton.jointCount(); ++joint)
            if (!skeleton.joint(joint).name.empty()) // else the import's own
                for (const osg::Vec3d& point : {osg::Vec3d(), osg::Vec3d(1, 0, 0), osg::Vec3d(0, 1, 0)})
                    points["joint " + skeleton.joint(joint).name].push_back(
                        point * character.jointToModel(joint).value() * toScene);
    }

    const int _clip;
    const double _time;
    AnimatedCharacter* _character = nullptr;
};

/// Both scenes have the same vertices and joints at that time, within 1e-5 of the size.
inline void expectSamePose(osg::Node& expected, osg::Node& found, int clip, double time)
{
    const PosedScene before(expected, clip, time), after(found, clip, time);
    const double allowed = 1e-5 * before.size();
    for (const auto& [name, places] : before.points)
    {
        SCOPED_TRACE(name + ", clip " + std::to_string(clip) + " at " + std::to_string(time));
        const auto others = after.points.find(name);
        ASSERT_NE(others, after.points.end());
        ASSERT_EQ(others->second.size(), places.size());
        double largest = 0.0;
        for (std::size_t i = 0; i < places.size(); ++i)
            largest = std::max(largest, (places[i] - others->second[i]).length());
        EXPECT_LE(largest, allowed);
    }
}

/// The same for all clips of the scenes' first characters, at both ends and at places between; and for their names,
/// durations and markers.
inline void expectSameClips(osg::Node& expected, osg::Node& found)
{
    expectSamePose(expected, found, -1, 0.0);
    const AnimatedCharacter* const before = findCharacter(expected);
    const AnimatedCharacter* const after = findCharacter(found);
    ASSERT_EQ(before == nullptr, after == nullptr);
    if (!before) return;
    const std::vector<Clip>& clips = before->getAnimationSet().clips();
    ASSERT_EQ(after->getAnimationSet().clips().size(), clips.size());
    for (std::size_t clip = 0; clip < clips.size(); ++clip)
    {
        const Clip& other = after->getAnimationSet().clips()[clip];
        EXPECT_EQ(other.name(), clips[clip].name());
        EXPECT_EQ(other.duration(), clips[clip].duration()) << clips[clip].name();
        ASSERT_EQ(other.markers().size(), clips[clip].markers().size()) << clips[clip].name();
        for (std::size_t i = 0; i < other.markers().size(); ++i)
        {
            EXPECT_EQ(other.markers()[i].name, clips[clip].markers()[i].name);
            EXPECT_EQ(other.markers()[i].time, clips[clip].markers()[i].time);
        }
        for (const double share : {0.0, 0.31, 0.77, 1.0})
            expectSamePose(expected, found, static_cast<int>(clip), share * clips[clip].duration());
    }
}

/// The scene as GLB; if the export fails, the test ends as a failure. warnings: those that are expected.
inline std::string glbOf(const osg::Node& scene, const std::vector<std::string>& warnings = {})
{
    gltf::Messages messages;
    gltf::Report report(messages);
    std::string glb = valueOf(gltf::exportModel(scene, report));
    EXPECT_EQ(messages.warnings, warnings);
    return glb;
}

/// The scene as GLB and back; the import may not warn.
inline osg::ref_ptr<osg::Group> throughGlb(const osg::Node& scene, const std::vector<std::string>& warnings = {})
{
    const gltf::ImportedModel model = valueOf(gltf::importModel(glbOf(scene, warnings), "", {}));
    EXPECT_EQ(model.messages.warnings, std::vector<std::string>());
    return model.root;
}

/// warnings: those that are expected.
inline gltf::GlbParts exported(const osg::Node& scene, const std::vector<std::string>& warnings = {})
{
    return gltf::GlbParts(glbOf(scene, warnings));
}

/// A triangle in the x-z plane.
template <typename Geometry = osg::Geometry>
osg::ref_ptr<Geometry> plainTriangle(const std::string& name)
{
    osg::ref_ptr<Geometry> made = new Geometry;
    made->setName(name);
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    made->setVertexArray(new osg::Vec3Array(3, corners));
    made->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return made;
}

} // namespace osgGpuAnimation
