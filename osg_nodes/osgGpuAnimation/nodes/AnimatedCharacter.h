// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/PrimitiveSet>

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

class MixBounds;
class PosedMeshes;
struct PlayedClip;

/// One animated character: owns a controller, shares an AnimationSet, and has its SkinnedGeometry drawables as
/// children. Its matrix places the character in its parent, like any MatrixTransform's.
///
///     osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
///     AnimatedCharacter* fox = findCharacter(*node);
///     fox->getController().play("Run");
///     osg::ref_ptr<osg::Node> another = osg::clone(node.get(), osg::CopyOp::DEEP_COPY_NODES); // its own controller
///
/// An AnimationUpdateCallback (installed by the constructor) advances the controller by the frame stamp's simulation
/// time. When culled and seen, the character submits with the PoseStage of the graphics context, which evaluates its
/// pose on the GPU before anything draws from it; unseen it costs nothing there.
class AnimatedCharacter : public osg::MatrixTransform, public Updatable, public PosedMeshSource
{
public:
    AnimatedCharacter();
    explicit AnimatedCharacter(std::shared_ptr<const AnimationSet> set);
    /// Shares the set, copies the controller: time, clip and speed are those of the other, independent from now on.
    AnimatedCharacter(const AnimatedCharacter& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, AnimatedCharacter)

    const AnimationSet& getAnimationSet() const { return _controller->set(); }
    AnimationController& getController() { return *_controller; }
    const AnimationController& getController() const { return *_controller; }

    /// The same character with another set, such as one with markers or root motion (AnimationSet::withClips,
    /// withRootMotion): its controller goes on with the clips of the same numbers (see AnimationController), bounds are
    /// worked out anew. Do it before cloning, so that clones share the set. A character that was made without a set
    /// takes any. Error: the set's palette is another than this one's, so the meshes would not fit.
    Result<bool> setAnimationSet(std::shared_ptr<const AnimationSet> set);

    /// Where a joint is now, in the character's own space: computed from its own chain of parents by the CPU twin,
    /// cheap enough for every frame. joint: below the skeleton's jointCount(). Error: it is not.
    Result<osg::Matrixd> jointToModel(std::size_t joint) const;
    /// Error: there is no joint of that name; it lists the names there are.
    Result<osg::Matrixd> jointToModel(const std::string& joint) const;

    /// Advances the controller by the time since the last update; the first only takes the time down. A jump of the
    /// time, backwards too, moves the clip by as much, so the same times show the same poses.
    /// simulationTime: seconds.
    void update(double simulationTime) override;

    /// Works out the bounds of every clip from the SkinnedGeometry below and gives those their bounding boxes. To be
    /// called once when all meshes are in; copies of this node share the result.
    void computeClipBounds();
    /// The box of the clip in the character's own space (all its vertices at all its times); -1: the rest pose.
    const Box& getClipBounds(int clip) const;

    /// The box of all that plays now, in the character's own space: the clip's where one plays alone, else that of any
    /// mix of the clips that the layers play, see MixBounds. Empty before computeClipBounds().
    Box getCurrentBounds() const;

    /// Whether characters that OSG would draw alike, one after another, may be drawn by one instanced draw a mesh
    /// primitive, see CharacterDraws. Programs that have no part in it (they do not link skin.glsl) are drawn one by
    /// one.
    void setDrawnTogether(bool together) { _isDrawnTogether = together; }
    bool isDrawnTogether() const { return _isDrawnTogether; } ///< default: true

    /// How far the surface that is drawn may be off on screen, in pixels: where that hides it, meshes are drawn with
    /// fewer triangles, see LodLevels. 0 (the default): with all. Each camera sees what its distance allows, by
    /// small feature culling's measure; what is near has all triangles. Makes the levels of its meshes at once, which
    /// takes its time, see MeshSimplifier; of those that are added or changed later, the next cull does. Drawn whole
    /// are meshes that are not its own children, and what comes after LodRange::mostVertices. Error: pixels is below
    /// 0, above LodRange::largestPixelError or no number.
    Result<bool> setPixelError(float pixels);
    float getPixelError() const { return _pixelError; }

    /// A mesh below this node as the character shows it now, in the character's own space: computed by the CPU twin,
    /// and kept until the pose is another. Intersectors meet it in the mesh's place.
    osg::ref_ptr<osg::Geometry> getPosedMesh(const SkinnedGeometry& mesh) const override;
    /// Gives the functor the primitives of all meshes below in their present pose. (A mesh by itself gives those of its
    /// bind pose: it belongs to no character.)
    void acceptPosed(osg::PrimitiveFunctor& functor);

    void traverse(osg::NodeVisitor& visitor) override;
    /// Of getCurrentBounds(); update() sees to it that it is asked for again when other clips play.
    osg::BoundingSphere computeBound() const override;

protected:
    ~AnimatedCharacter() override;

private:
    Box boundsOf(const std::vector<PlayedClip>& played) const;
    void growMeshes(const Box& box);

    std::unique_ptr<AnimationController> _controller;
    std::shared_ptr<const std::vector<Box>> _clipBounds; ///< the rest pose's, then one a clip
    std::shared_ptr<const MixBounds> _mixBounds;         ///< there with _clipBounds
    std::optional<double> _updateTime;                   ///< seconds of simulation time
    std::vector<PlayedClip> _played;                     ///< what the bound was last dirtied for
    std::vector<PlayedClip> _playedNow;                  ///< kept for its memory
    mutable std::unique_ptr<PosedMeshes> _posedMeshes;   ///< its own: no copy shares it; made when first asked
    mutable std::once_flag _posedMeshesMade;
    bool _isDrawnTogether = true;
    float _pixelError = 0.0f;
};

/// The first AnimatedCharacter at or below the node, depth first; null where there is none.
AnimatedCharacter* findCharacter(osg::Node& node);

/// How far the clips of a character are off since they are compact, in its own units.
struct CompactedCharacter
{
    double longestSide = 0.0; ///< see animation/CompactClips.h
    double tolerance = 0.0;
    std::vector<double> errors; ///< one a clip; 0 where it is exact
};

/// Gives the character a set with compact clips, see animation/CompactClips.h: no vertex is farther from where the
/// exact clips have it than that fraction of the model's longest side. To be called when all meshes are in, and before
/// cloning. Errors: those of compactClips() and AnimatedCharacter::setAnimationSet(); a model without size.
Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction);

} // namespace osgGpuAnimation
