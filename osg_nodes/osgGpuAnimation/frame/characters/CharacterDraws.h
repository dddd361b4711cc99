// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseFrame.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Drawable>
#include <osgUtil/CullVisitor>

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

/// The draws of one cull visitor's characters in a frame. Characters with the same meshes and state, in a bin sorted by
/// state, form a group: the first is drawn normally, all others by one instanced draw per mesh primitive.
///
/// Always drawn normally: meshes with callbacks, with vertex arrays at the locations of placements
/// (InstanceRuns::isRefusedBy), in bins sorted by depth or traversal, or below other nodes; all meshes if near and far
/// planes come from primitives; characters with their own StateSet.
class CharacterDraws
{
public:
    /// Called at the start of a cull traversal. counted: records draws for statistics; null: nobody collects them.
    void begin(DrawnInstances* counted)
    {
        _groups.clear();
        _lods.clear();
        _counted = counted;
    }

    /// Draws the character's children. pose: its place in the frame. view: the visitor's.
    void draw(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character, PoseFrame& frame,
              SubmittedPose pose);

private:
    /// Characters that differ in poses and placements only.
    struct Group
    {
        const osgUtil::RenderBin* bin;
        const osg::RefMatrix* projection;
        osg::Node::NodeMask traversalMask;
        const AnimationSet* set;
        std::size_t slot;
        int level; ///< of detail
        std::vector<SkinnedGeometry*> meshes;
        osg::BoundingBox box;               ///< of the meshes
        PaletteBinding* together = nullptr; ///< null: the group has one character

        bool holds(const Group& other) const;
    };
    /// The input of level selection.
    struct LodInput
    {
        std::vector<const osg::Node*> children;
        LodRange range;
        osg::BoundingBox box; ///< of the meshes

        bool isOf(const osg::Group& node) const;
    };

    bool drawTogether(osgUtil::CullVisitor& visitor, const DrawnCharacter& character, PoseFrame& frame,
                      SubmittedPose pose, int level, std::vector<osg::Node*>& outOthers);
    int levelOf(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character);
    const LodInput& lodOf(const DrawnCharacter& character);
    void open(osgUtil::CullVisitor& visitor, Group& group, PoseFrame& frame, float depth);

    std::unordered_map<const osgUtil::StateGraph*, std::vector<Group>> _groups;
    std::unordered_map<const AnimationSet*, LodInput> _lods; ///< by set, for its last character
    Group _candidate;                                        ///< kept for its memory
    DrawnInstances* _counted = nullptr;                      ///< the PoseStage's
};

} // namespace osgGpuAnimation
