// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/mesh/PosedMeshSource.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/CharacterMeshes.h>
#include <osgGpuAnimation/nodes/NodeConstraint.h>
#include <osgGpuAnimation/nodes/WornGarment.h>

#include <osg/BoundingBox>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/PrimitiveSet>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

struct ClipBoxes;
struct DrawnCharacter;
class PosedMeshes;
class Wardrobe;
class WorldTargets;
struct PlayedClip;

/// One animated character: owns a controller, shares an AnimationSet, and has its SkinnedGeometry drawables as
/// children. Its matrix places the character in its parent, like any MatrixTransform's.
///
///     osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
///     AnimatedCharacter* fox = findCharacter(*node);
///     fox->getController().play("Run");
///     osg::ref_ptr<osg::Node> another = osg::clone(node.get(), osg::CopyOp::DEEP_COPY_NODES); // its own controller
///
/// The update traversal advances the controller by the frame stamp's simulation time, before it runs the character's
/// own update callbacks. A visible character submits its pose to the PoseStage of the graphics context during cull, and
/// the GPU evaluates it before any camera draws it. An invisible character costs nothing on the GPU.
///
/// The set has the axes of its file (glTF: +Y up). The character draws it in its own space (OSG: +Z up) by
/// getFileToNode(), and all matrices, boxes and meshes of this class are in the character's own space.
class AnimatedCharacter : public osg::MatrixTransform, public PosedMeshSource
{
public:
    /// A character with an empty set; setAnimationSet() gives it another.
    AnimatedCharacter();
    /// set: null counts as an empty one.
    explicit AnimatedCharacter(std::shared_ptr<const AnimationSet> set);
    /// Shares the set and copies the controller: the copy starts with the same times, clips and speeds and is then
    /// independent.
    AnimatedCharacter(const AnimatedCharacter& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGpuAnimation, AnimatedCharacter)
    /// During update: calls update() with the frame stamp's simulation time, then the update callbacks. During cull: a
    /// character that is drawn together with others needs no traversal.
    void accept(osg::NodeVisitor& visitor) override;

    /// The set, which copies share. Valid until setAnimationSet(): to keep it, hold getController().sharedSet().
    const AnimationSet& getAnimationSet() const { return _controller->set(); }
    /// The controller of this character alone.
    AnimationController& getController() { return *_controller; }
    const AnimationController& getController() const { return *_controller; } ///< the same, read only

    /// The constraint of that name, see AnimationSet::withConstraints().
    NodeConstraint constraint(const std::string& name);

    /// Replaces the set, for example by one with markers or root motion (AnimationSet::withClips, withRootMotion). The
    /// controller continues with the clips of the same indices (see AnimationController), and the bounds are computed
    /// again. Call it before cloning, so that the clones share the set. A character without a set accepts any set.
    /// Error: the palette size of the set differs from that of the present set.
    Result<void> setAnimationSet(std::shared_ptr<const AnimationSet> set);

    /// Sets the transform from the axes of the set's file to the character's own space: the plugin for glTF turns +Y up
    /// to +Z up with it. Default: the identity. Call it before cloning and before a crowd is made of the character.
    /// Errors: the matrix is not finite, not affine, or its determinant is not above 0.
    Result<void> setFileToNode(const osg::Matrixd& fileToNode);
    const osg::Matrixd& getFileToNode() const { return _axes->fileToNode; } ///< affine, with an inverse

    /// The present transform of a joint, from joint space to the character's own space. The CPU twin computes it from
    /// the joint's chain of parents, cheaply enough for every frame.
    /// joint: in [0, skeleton().jointCount()). Error: joint is out of range.
    Result<osg::Matrixd> jointToModel(std::size_t joint) const;
    /// The same for the first joint of that name. Error: no joint has the name; the message lists the names.
    Result<osg::Matrixd> jointToModel(const std::string& joint) const;

    /// Poses all joints in a layer of the controller, as physics or motion capture does in every frame: the inverse of
    /// jointToModel(). Roots and joints below rotated and scaled parents take the matrices that they are given; a shear
    /// between a joint and its parent is dropped, and the joints below keep their places. See JointPose for the layer.
    /// layer: see AnimationController::layer(). jointToModel: one per joint, from joint space to the character's own
    /// space. Errors, which leave the pose unchanged: a wrong number of matrices; a matrix is not finite, not affine or
    /// has no inverse.
    Result<void> setModelTransforms(std::size_t layer, const std::vector<osg::Matrixd>& jointToModel);

    /// The root motion since the last call, in the character's own space: preMult() it to the matrix that places the
    /// character. The identity without root motion (see withRootMotion).
    osg::Matrixd takeRootMotion();

    /// Advances the controller by the time since the last update; the first call only stores the time. A jump of the
    /// time in either direction moves the clips by the same amount, so equal times show equal poses.
    /// Properties that clips animate (see MorphWeights) get their values, in StateSets of this character's own.
    /// simulationTime: seconds. The event callback is called after the viewer's update traversal, or at once without a
    /// viewer; it may also delete this character.
    void update(double simulationTime);

    /// Computes the bounds of every clip from the SkinnedGeometry below and sets the meshes' bounding boxes. Call it
    /// once after all meshes are added; copies of this node share the result.
    void computeClipBounds();
    /// The box of all vertices at all times of the clip, in the character's own space. clip: an index of
    /// getAnimationSet().clips(); -1: the rest pose. Invalid before computeClipBounds() and for other indices.
    osg::BoundingBox getClipBounds(int clip) const;

    /// The box of the present animation, in the character's own space: the clip's box if one clip plays alone,
    /// otherwise the box of every possible mix of the playing clips (see MixBounds). Invalid before
    /// computeClipBounds().
    osg::BoundingBox getCurrentBounds() const;

    /// Allows one instanced draw per mesh primitive for consecutive characters with the same meshes and state, see
    /// CharacterDraws. Meshes with programs that do not link skin.glsl are drawn one by one. Default: true.
    void setDrawnTogether(bool together) { _isDrawnTogether = together; }
    bool isDrawnTogether() const { return _isDrawnTogether; } ///< default: true

    /// Visibility, material variants and levels of detail of the meshes; clones have their own.
    CharacterMeshes& getMeshes() { return _meshes; }
    const CharacterMeshes& getMeshes() const { return _meshes; } ///< the same, read only

    /// Adds the meshes of a garment from another file, bound to this character's joints by name, see
    /// "Garments" in the guide:
    ///
    ///     osg::ref_ptr<osg::Node> coat = osgDB::readRefNodeFile("coat.glb");
    ///     if (auto worn = knight->wear(coat.get()); !worn) std::cerr << worn.error().message << "\n";
    ///
    /// Where joint and inverse bind matrix agree (to 1 / 100,000 of the garment's size), the meshes use the palette
    /// entries of this character, so the garment adds no pose work. Otherwise the character gets a set with further
    /// entries, which all characters with equal sets share that wear such garments, put on in the same order. Clones
    /// and crowds made of the character wear the garment; characters that wear it are drawn together. Only the pose of
    /// this character counts: the garment's clips do not. The garment is unchanged and need not be kept. Call it during
    /// the update traversal or between frames; with further entries it invalidates references to layers.
    /// garment: a node at or above an AnimatedCharacter with meshes. Errors, which change nothing: there is none; it is
    /// worn already; a joint that moves vertices has no counterpart here, and no joint above it has one.
    Result<WornGarment> wear(osg::Node* garment);
    /// Removes the meshes of a garment, and the palette entries that only the garments put on last have needed.
    /// garment: that of wear(), of this character or a clone of it, or a clone of the garment; or one of the garment's
    /// meshes below this node, as hits and CharacterMeshes::find() name them. Error: this character does not wear it;
    /// the message lists the meshes of the garments that it wears.
    Result<void> takeOff(const osg::Node* garment);

    /// A mesh below this node in the present pose, in the character's own space. The CPU twin computes it, and the
    /// result is kept until the pose changes. Intersectors test it in place of the mesh. withNormals: with normals and
    /// colours, if the mesh has them.
    osg::ref_ptr<osg::Geometry> getPosedMesh(const SkinnedGeometry& mesh, bool withNormals = false) const override;
    /// Passes the primitives of all meshes below in their present pose to the functor. (A mesh alone passes its bind
    /// pose, because it belongs to no character.)
    void acceptPosed(osg::PrimitiveFunctor& functor);

    /// During cull: submits the pose and draws the children from the palette. Visitors that compute bounds
    /// (osg::ComputeBoundsVisitor and osgShadow's) get getCurrentBounds() in place of the boxes of the meshes, which
    /// clones share. During update: calls update() unless accept() did, for derived classes with an accept() of their
    /// own (META_Node). Other visitors traverse the children.
    void traverse(osg::NodeVisitor& visitor) override;
    /// The sphere around getCurrentBounds(); update() marks it dirty when other clips play.
    osg::BoundingSphere computeBound() const override;

protected:
    ~AnimatedCharacter() override;

private:
    friend class AnimatedCrowd;
    struct Axes
    {
        osg::Matrixd fileToNode;
        AffineMatrix rootMatrix; ///< the same as floats
    };

    DrawnCharacter drawn();
    bool cullTogether(osgUtil::CullVisitor& visitor);
    bool wears(const std::string& identifier) const;
    void useOutfit(const std::shared_ptr<const AnimationSet>& set);
    osg::BoundingBox boundsOfAllClips() const;
    void setMeshBounds();
    void updateBounds();
    osg::BoundingBox boundsOf(const std::vector<PlayedClip>& played) const;
    void growMeshes(const osg::BoundingBox& box);

    std::unique_ptr<AnimationController> _controller;
    std::shared_ptr<const Axes> _axes;                 ///< never null, shared with clones
    std::shared_ptr<const ClipBoxes> _clipBoxes;       ///< null before computeClipBounds()
    std::optional<double> _updateTime;                 ///< seconds of simulation time
    std::unique_ptr<WorldTargets> _worldTargets;       ///< never null
    std::vector<PlayedClip> _played;                   ///< the clips at the last dirtyBound()
    std::uint64_t _constraints = 0;                    ///< with an effect at the last dirtyBound(), bit by bit
    std::vector<PlayedClip> _playedNow;                ///< kept for its memory
    mutable std::unique_ptr<PosedMeshes> _posedMeshes; ///< created on demand; copies do not share it
    mutable std::once_flag _posedMeshesMade;
    bool _isDrawnTogether = true;
    CharacterMeshes _meshes;
    std::shared_ptr<Wardrobe> _wardrobe; ///< never null, shared with clones
};

/// The first AnimatedCharacter at or below the node, depth first; null if none exists.
AnimatedCharacter* findCharacter(osg::Node& node);

} // namespace osgGpuAnimation
