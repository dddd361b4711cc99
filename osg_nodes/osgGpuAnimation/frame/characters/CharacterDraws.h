// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseFrame.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Drawable>
#include <osgUtil/CullVisitor>

#include <cstddef>
#include <memory>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// Counts instances for a camera's statistics (osgViewer's StatsHandler): those ask each drawable of a cull for its
/// primitives, and a mesh of an instanced draw reports them once. This drawable reports the primitives of the other
/// instances. It draws nothing and does not count as a drawable. The PoseStage adds it while statistics are collected.
class DrawnInstances : public osg::Drawable
{
public:
    DrawnInstances();

    /// Called at the start of a cull traversal.
    void clear() { _draws.clear(); }
    /// Adds a draw of the mesh for the instances of the binding; more instances may follow.
    void add(const SkinnedGeometry& mesh, const PaletteBinding& binding)
    {
        Draw& draw = _draws.emplace_back(); // a Draw that is copied here makes g++ 14 warn of a null pointer
        draw.mesh = &mesh;
        draw.binding = &binding;
    }

    using osg::Drawable::accept;
    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override;
    void drawImplementation(osg::RenderInfo&) const override {}

protected:
    ~DrawnInstances() override = default;

private:
    struct Draw
    {
        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const PaletteBinding> binding;
    };

    std::vector<Draw> _draws;
};

/// The parts of a character that CharacterDraws needs.
struct DrawnCharacter
{
    osg::Group& node; ///< the parent of the meshes
    const AnimationController& controller;
    const AffineMatrix& rootMatrix;
    float pixelError;     ///< pixels, see LodRange
    bool isDrawnTogether; ///< true: may share instanced draws with other characters
};

/// True if characters may share instanced draws of a mesh that is their child.
bool canBeDrawnTogether(const SkinnedGeometry& mesh);

/// The draws of one cull visitor's characters in a frame. Characters of one set and state, in a bin sorted by state,
/// form a group: the first with a mesh draws it normally, all others by one instanced draw per mesh primitive,
/// whichever of the meshes each shows.
///
/// Always drawn normally: meshes with callbacks, with vertex arrays at the locations of placements
/// (InstanceRuns::isRefusedBy), in bins sorted by depth or traversal, or below other nodes; all meshes if near and far
/// planes come from primitives. Characters with a StateSet of their own are a group of their own.
class CharacterDraws
{
public:
    /// Called at the start of a cull traversal. counted: records draws for statistics; null: nobody collects them.
    void begin(DrawnInstances* counted);

    /// Draws the character's children. pose: its place in the frame. view: the visitor's.
    void draw(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character, PoseFrame& frame,
              SubmittedPose pose);
    /// The same from the space above a character that is in view, if others have drawn all its meshes. toParent: its
    /// matrix. toEye: its model-view matrix, finite. False: nothing is drawn yet, call draw().
    bool drawFromAbove(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character,
                       const osg::Matrixd& toParent, const osg::Matrixd& toEye, PoseFrame& frame);

private:
    /// The children that several characters of a set have: they look alike.
    struct Look
    {
        std::size_t number; ///< in the traversal
        const AnimationSet* set;
        osg::Node::NodeMask traversalMask; ///< the visitor's
        std::vector<const osg::Node*> children;
        std::vector<SkinnedGeometry*> shared{}; ///< the visible ones that may be drawn with those of other characters
        bool hasOthers = false;                 ///< true: some children are drawn normally
        osg::BoundingBox box{};                 ///< of the meshes
        std::optional<LodRange> range{};        ///< empty: not asked for yet
    };
    /// What the characters of a group have in common, besides their state graph: bin, projection, set, slot, level of
    /// detail.
    using GroupKey =
        std::tuple<const osgUtil::RenderBin*, const osg::RefMatrix*, const AnimationSet*, std::size_t, int>;
    /// Characters that differ in poses, placements and looks only.
    struct Group
    {
        GroupKey key;
        /// By the number of their look; null: none yet.
        std::vector<std::shared_ptr<std::vector<InstanceTransform>>> instances{};
        std::unordered_map<const osg::Node*, PaletteBinding*> bindings{}; ///< of the meshes' draws; null: drawn once

        /// True if the look has a list of instances, which the draws of all its meshes show.
        bool isOpen(const Look& look) const
        {
            return look.number < instances.size() && instances[look.number] != nullptr;
        }
        bool knows(const osg::Node* mesh) const { return bindings.count(mesh) != 0; }
    };
    /// The scale of the last selected level, for siblings.
    struct LastScale
    {
        osg::ref_ptr<const osg::RefMatrix> toEye;
        osg::ref_ptr<const osg::RefMatrix> projection;
        const Look* look = nullptr;
        float pixelError = 0.0f;
        LodScale scale;
    };

    Look& lookOf(const osgUtil::CullVisitor& visitor, const DrawnCharacter& character);
    int levelOf(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character, Look& look,
                const osg::Matrixd& toVisitor);
    Group& groupOf(osgUtil::CullVisitor& visitor, const AnimationSet& set, std::size_t slot, int level);
    void add(osgUtil::CullVisitor& visitor, Group& group, const Look& look, PoseFrame& frame, const osg::Matrixd& toEye,
             std::size_t instance);
    std::shared_ptr<std::vector<InstanceTransform>> open(osgUtil::CullVisitor& visitor, Group& group, const Look& look,
                                                         PoseFrame& frame, float depth);

    std::vector<std::unique_ptr<Look>> _looks; ///< of the traversal
    std::unordered_multimap<std::size_t, Look*> _looksByHash;
    Look* _lastLook = nullptr;
    std::unordered_map<const osgUtil::StateGraph*, std::vector<std::unique_ptr<Group>>> _groups; ///< of the traversal
    std::optional<LastScale> _lastScale;
    DrawnInstances* _counted = nullptr; ///< the PoseStage's
};

} // namespace osgGpuAnimation
