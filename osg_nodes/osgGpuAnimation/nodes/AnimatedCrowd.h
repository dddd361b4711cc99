// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/PrimitiveSet>
#include <osg/Transform>
#include <osgUtil/CullVisitor>

#include <optional>

namespace osgGpuAnimation
{

class AnimatedCharacter;
class CrowdInstances;
class PosedInstances;

/// Thousands of instances of one character in one node: each with its own placement, controller and tint, all drawn by
/// one instanced draw a mesh primitive.
///
///     osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*osgDB::readRefNodeFile("fox.glb")));
///     AnimationController controller(crowd->getSharedAnimationSet());
///     controller.play("Run");
///     controller.seek(0.4);
///     AnimatedCrowd::Instance fox = crowd->add(osg::Matrix::translate(100, 20, 0), controller).value();
///     crowd->setPlacement(fox, osg::Matrix::translate(101, 20, 0));      // at any time but while the crowd is culled
///     crowd->getController(fox)->crossfade("Walk", 0.3);
///
/// An update callback (installed by the constructor) advances all instances by the frame stamp's simulation time. At
/// cull each instance is tested by itself, with the bounds of the clip it plays; those that are seen go to the GPU.
/// An instance that plays one clip in a loop costs least; any other (crossfades, layers, events …) has a controller.
///
/// Meshes are the crowd's children, as they are in an AnimatedCharacter's; other children are drawn once. Within one
/// mesh, transparent instances are not sorted by depth.
class AnimatedCrowd : public osg::Transform, public Updatable
{
public:
    /// Names an instance as long as it is there, and no other afterwards.
    using Instance = std::uint64_t;
    static constexpr std::size_t maxInstances = 1000000;

    AnimatedCrowd();
    /// meshes: made for the set's palette.
    AnimatedCrowd(std::shared_ptr<const AnimationSet> set, const std::vector<osg::ref_ptr<SkinnedGeometry>>& meshes);
    /// Shares the character's set, meshes and state, and copies its bounds and pixel error; its own placement plays no
    /// part.
    explicit AnimatedCrowd(const AnimatedCharacter& character);
    /// The instances are copied, under the same names.
    AnimatedCrowd(const AnimatedCrowd& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, AnimatedCrowd)

    const AnimationSet& getAnimationSet() const;
    const std::shared_ptr<const AnimationSet>& getSharedAnimationSet() const;

    /// For a crowd that was made without a set: works out the bounds from the meshes that are there. Error: it has
    /// instances, or a set already.
    Result<bool> setAnimationSet(std::shared_ptr<const AnimationSet> set);

    /// placement: affine, from the character's own space to the space this node is in. controller: one of the crowd's
    /// set; it is copied. tint: what the colour is multiplied by, [0, 1] each.
    /// Errors: a placement that is not finite, not affine, or mirrors (its determinant is below 0); a controller of
    /// another set; more than maxInstances. The crowd is unchanged then.
    Result<Instance> add(const osg::Matrixd& placement, const AnimationController& controller,
                         const osg::Vec4& tint = osg::Vec4(1, 1, 1, 1));
    bool remove(Instance instance); ///< false: there is none
    Result<bool> setPlacement(Instance instance,
                              const osg::Matrixd& placement);       ///< errors: as add()'s; no such instance
    Result<bool> setTint(Instance instance, const osg::Vec4& tint); ///< error: no such instance
    bool contains(Instance instance) const;
    std::size_t getNumInstances() const;

    /// To ask for crossfades, layers and so on; null where there is no such instance. Holds until the next update().
    AnimationController* getController(Instance instance);
    /// instance: one there is.
    osg::Matrixd getPlacement(Instance instance) const;
    const CrowdInstances& getInstances() const { return *_instances; }

    /// Placements are kept as floats relative to the origin: the first instance's, unless it is set before.
    /// Where instances are already there, they stay where they are, as exactly as floats can say.
    void setOrigin(const osg::Vec3d& origin);
    const osg::Vec3d& getOrigin() const { return _origin; }

    /// How far the surface that is drawn may be off on screen, in pixels: where that hides it, instances are drawn with
    /// fewer triangles, each level of detail in use by one instanced draw a mesh primitive. 0 (the default): all
    /// triangles. For meshes that are drawn whole, the time it takes and errors see AnimatedCharacter::setPixelError().
    Result<bool> setPixelError(float pixels);
    float getPixelError() const { return _pixelError; }

    /// Advances by the time since the last update; the first only takes the time down. simulationTime: seconds.
    void update(double simulationTime) override;

    /// The instance that an intersector has hit: of the Intersection's drawable. Nothing where it is no crowd's.
    static std::optional<Instance> instanceOf(const osg::Drawable* hit);
    /// The mesh as the instance shows it now, computed by the CPU twin, in the crowd's own space; its instanceOf() is
    /// the instance. No positions where there is no such instance. See jointOf() for a hit's joint.
    osg::ref_ptr<osg::Geometry> getPosedMesh(Instance instance, const SkinnedGeometry& mesh) const;
    /// Gives the functor the primitives of all instances in their present pose: slow, computed by the CPU twin.
    void acceptInstances(osg::PrimitiveFunctor& functor) const;

    void traverse(osg::NodeVisitor& visitor) override;
    osg::BoundingSphere computeBound() const override;
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;
    bool computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;

protected:
    ~AnimatedCrowd() override;

private:
    void cull(osgUtil::CullVisitor& visitor);
    void intersect(osg::NodeVisitor& visitor);
    void count(osg::NodeVisitor& visitor);

    std::unique_ptr<CrowdInstances> _instances; ///< never null
    std::unique_ptr<PosedInstances> _posed;     ///< its own: no copy shares it
    osg::Vec3d _origin;
    bool _hasOrigin = false;
    std::optional<double> _updateTime; ///< seconds of simulation time
    float _pixelError = 0.0f;          ///< pixels
};

} // namespace osgGpuAnimation
