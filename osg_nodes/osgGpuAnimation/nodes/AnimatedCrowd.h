// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/mesh/PosedMeshSource.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/CharacterMeshes.h>
#include <osgGpuAnimation/nodes/CrowdOutfits.h>
#include <osgGpuAnimation/nodes/NodeConstraint.h>

#include <osg/Transform>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

class AnimatedCharacter;
class CrowdInstances;
class PosedInstances;
class SharedPoses;
class StateGraph;
class StateMachine;
class WorldTargets;

/// Thousands of instances of one character in one node, each with its own placement, controller and tint. One instanced
/// draw per mesh primitive shows them all.
///
///     osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*osgDB::readRefNodeFile("fox.glb")));
///     AnimationController controller(crowd->getSharedAnimationSet());
///     controller.play("Run");
///     controller.seek(0.4);
///     AnimatedCrowd::Instance fox = crowd->add(osg::Matrix::translate(100, 20, 0), controller).value();
///     crowd->setPlacement(fox, osg::Matrix::translate(101, 20, 0));      // not while the crowd is culled
///     crowd->getController(fox)->crossfade("Walk", 0.3);
///
/// The update traversal advances all instances by the frame stamp's simulation time, before it runs the crowd's own
/// update callbacks. Cull tests each instance with the bounds of the clip that it plays and submits the visible ones to
/// the GPU. An instance that plays one clip in a loop costs least; every other instance (crossfades, layers, events)
/// keeps a controller.
///
/// The meshes are the crowd's children; other children are drawn once. Transparent instances of one mesh are not sorted
/// by depth. As with AnimatedCharacter, getFileToNode() leads from the axes of the set's file to the space that the
/// placements start from (OSG: +Z up), so that a translation alone places an upright character.
class AnimatedCrowd : public osg::Transform, public PosedMeshSource
{
public:
    /// A handle of an instance. It stays valid until the instance is removed and is never reused.
    using Instance = std::uint64_t;
    static constexpr std::size_t maxInstances = 1000000; ///< in one crowd

    /// A crowd with an empty set, for OSG's serializers.
    AnimatedCrowd();
    /// set: null counts as an empty one. meshes: built for the set's palette.
    AnimatedCrowd(std::shared_ptr<const AnimationSet> set, const std::vector<osg::ref_ptr<SkinnedGeometry>>& meshes);
    /// Shares the character's set, meshes and state, and copies its bounds, pixel error and getFileToNode(). Ignores
    /// its matrix. The meshes of its glTF file that do not move are meshes of the crowd, too.
    explicit AnimatedCrowd(const AnimatedCharacter& character);
    /// Copies the instances with their handles.
    AnimatedCrowd(const AnimatedCrowd& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGpuAnimation, AnimatedCrowd)
    /// During update: calls update() with the frame stamp's simulation time, then the update callbacks.
    void accept(osg::NodeVisitor& visitor) override;

    /// The skeleton, palette layout and clips of all instances.
    const AnimationSet& getAnimationSet() const { return *_meshes._set; }
    /// The same set with shared ownership, for new controllers.
    const std::shared_ptr<const AnimationSet>& getSharedAnimationSet() const { return _meshes._set; }

    /// The transform from the axes of the set's file to the space that placements start from, see
    /// AnimatedCharacter::setFileToNode(). Instances keep their placements.
    Result<void> setFileToNode(const osg::Matrixd& fileToNode);
    const osg::Matrixd& getFileToNode() const { return _fileToNode; } ///< affine, with an inverse

    /// Adds an instance. placement: affine, from the character's space to the space of this node. controller: built for
    /// the crowd's set; it is copied. tint: multiplies the colour, each component in [0, 1].
    /// Errors, which leave the crowd unchanged: the placement is not finite, not affine or mirrors (its determinant is
    /// below 0); the controller has another set; the crowd has maxInstances.
    Result<Instance> add(const osg::Matrixd& placement, const AnimationController& controller,
                         const osg::Vec4& tint = osg::Vec4(1, 1, 1, 1));
    bool remove(Instance instance); ///< false: no such instance
    /// Errors: those of add(); no such instance.
    Result<void> setPlacement(Instance instance, const osg::Matrixd& placement);
    Result<void> setTint(Instance instance, const osg::Vec4& tint); ///< error: no such instance
    /// The tint of an instance, rounded to 8 bits a component; white if no such instance exists.
    osg::Vec4 getTint(Instance instance) const;
    bool contains(Instance instance) const; ///< true until the instance is removed
    std::size_t getNumInstances() const;    ///< in [0, maxInstances]

    /// The controller of an instance, for crossfades and layers; valid until the next update(). Null: no such instance.
    AnimationController* getController(Instance instance);
    /// The constraint of that name of an instance, in the space that placements lead to.
    NodeConstraint constraint(Instance instance, const std::string& name);
    /// The placement of an instance; the identity if no such instance exists (see contains()).
    osg::Matrixd getPlacement(Instance instance) const;
    /// The root motion of an instance since the last call, in the space that placements start from: the new placement
    /// is the motion times the old one. The identity without root motion or without such an instance.
    osg::Matrixd takeRootMotion(Instance instance);
    /// The transform of a joint of an instance, from the joint's space to the space of this node; the CPU twin computes
    /// it. joint: its index in the skeleton. Errors: no such instance or joint.
    Result<osg::Matrixd> jointToCrowd(Instance instance, std::size_t joint) const;
    Result<osg::Matrixd> jointToCrowd(Instance instance, const std::string& joint) const; ///< The same by name.

    /// Instances of an outfit show other parts, colours, variants, pictures or props, in the draws of one crowd.
    CrowdOutfits& getOutfits() { return _outfits; }
    const CrowdOutfits& getOutfits() const { return _outfits; } ///< the same, read only
    /// outfit: null: none. Errors: no such instance; no such outfit.
    Result<void> setOutfit(Instance instance, const Outfit* outfit);
    const Outfit* getOutfit(Instance instance) const; ///< null: none, or no such instance

    /// Data of the application, for example the person that a hit has found, see instanceOf(). Copies of the crowd
    /// share it; stored scenes have none. data: null: none. Error: no such instance.
    Result<void> setInstanceData(Instance instance, osg::Referenced* data);
    osg::Referenced* getInstanceData(Instance instance) const; ///< null: none, or no such instance

    /// Poses all joints in a layer of an instance, see AnimatedCharacter::setModelTransforms(). jointToCrowd: one per
    /// joint, from joint space to the space of this node. Further error: no such instance.
    Result<void> setModelTransforms(Instance instance, std::size_t layer,
                                    const std::vector<osg::Matrixd>& jointToCrowd);

    /// update() calls the callback with the events of all instances, in the order and at the times of
    /// AnimatedCharacter::update(). It replaces the callbacks of the instances' controllers; a callback that a
    /// controller gets later replaces it for that instance. With a callback every instance keeps a controller, which
    /// costs more than a plain loop. An empty function removes it. Copies of the crowd do not copy it.
    void setInstanceEventCallback(std::function<void(Instance, const AnimationEvent&)> callback);
    /// Lets a state machine drive a layer of an instance: update() updates it before it advances the instance. graph:
    /// null removes the machine. layer: see StateMachine. Copies of the crowd have copies of the machines; stored
    /// scenes have none. Error: no such instance.
    Result<void> setStateGraph(Instance instance, std::shared_ptr<const StateGraph> graph, std::size_t layer = 0);
    /// The state machine of an instance, for its parameters and triggers. Null: none. Valid until it is replaced or
    /// removed.
    StateMachine* getStateMachine(Instance instance);
    /// Sets the point that placements are stored relative to, as floats; the default is the first instance's position.
    /// Existing instances keep their placements; a later origin does not depend on the ones before.
    /// Errors, without a change: the origin is not finite; an instance is too far from it for a float.
    Result<void> setOrigin(const osg::Vec3d& origin);
    const osg::Vec3d& getOrigin() const { return _origin; } ///< in the space of this node

    /// Visibility, material variants and levels of detail of the meshes, for all instances.
    CharacterMeshes& getMeshes() { return _meshes; }
    const CharacterMeshes& getMeshes() const { return _meshes; } ///< the same, read only

    /// Advances all instances by the time since the last update; the first call only stores the time.
    /// simulationTime: seconds. Event callbacks are called as those of AnimatedCharacter::update().
    void update(double simulationTime);

    /// The mesh in the present pose of the instance, in the crowd's space. The CPU twin computes it. It has no vertices
    /// if no such instance exists.
    osg::ref_ptr<osg::Geometry> getPosedMesh(Instance instance, const SkinnedGeometry& mesh) const;
    /// Cull submits and draws the visible instances; intersectors and writers of other file formats meet posed meshes;
    /// statistics count every instance; visitors that compute bounds get the box around all instances as they play now.
    void traverse(osg::NodeVisitor& visitor) override;
    osg::BoundingSphere computeBound() const override; ///< around all instances and the other children
    void releaseGLObjects(osg::State* state = nullptr) const override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    /// Applies the origin to the matrix.
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;
    /// Removes the origin from the matrix.
    bool computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;

protected:
    ~AnimatedCrowd() override;

private:
    friend struct CrowdDetail;

    void computeBounds();
    void showOutfits();
    osg::ref_ptr<osg::Geometry> getPosedMesh(const SkinnedGeometry& mesh, bool withNormals) const override;
    osg::ref_ptr<osg::Geometry> posedMesh(std::size_t index, const SkinnedGeometry& mesh, bool withNormals) const;
    void prepareSharedPoses();
    osg::Matrixd fileToSpace(std::size_t index) const;

    std::unique_ptr<CrowdInstances> _instances; ///< never null
    std::unique_ptr<PosedInstances> _posed;     ///< copies do not share it
    osg::Matrixd _fileToNode;
    osg::Vec3d _origin;
    bool _hasOrigin = false;
    std::optional<double> _updateTime;           ///< seconds of simulation time
    std::unique_ptr<WorldTargets> _worldTargets; ///< never null
    CharacterMeshes _meshes;
    CrowdOutfits _outfits;
    std::unique_ptr<SharedPoses> _sharedPoses; ///< null: no pixel error yet
};

namespace detail
{
std::optional<AnimatedCrowd::Instance> instanceOfMatrix(const osg::RefMatrix* matrix);
}

/// The instance of a hit: an Intersection of any of OSG's intersectors. Empty: the hit is in no crowd. See jointOf()
/// for the joint.
template <typename Intersection>
std::optional<AnimatedCrowd::Instance> instanceOf(const Intersection& hit)
{
    return detail::instanceOfMatrix(hit.matrix.get());
}

} // namespace osgGpuAnimation
