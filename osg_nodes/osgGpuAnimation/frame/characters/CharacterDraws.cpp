// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/characters/CharacterDraws.h>

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/mesh/draw/InstancedDraw.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osgUtil/Statistics>

#include <algorithm>

namespace osgGpuAnimation
{

DrawnInstances::DrawnInstances()
{
    setName("osgGpuAnimation DrawnInstances");
    setUseDisplayList(false);
    setCullingActive(false); // it has no bounds
}

void DrawnInstances::accept(osg::PrimitiveFunctor& functor) const
{
    if (auto* statistics = dynamic_cast<osgUtil::Statistics*>(&functor)) --statistics->numDrawables;
    for (const Draw& draw : _draws)
        for (std::size_t instance = 1; instance < draw.binding->getDrawnCount(); ++instance)
            draw.mesh->accept(functor);
}

namespace
{

bool isOrderedByState(osgUtil::RenderBin::SortMode mode)
{
    return mode == osgUtil::RenderBin::SORT_BY_STATE || mode == osgUtil::RenderBin::SORT_BY_STATE_THEN_FRONT_TO_BACK;
}

bool isOrderedByState(const osg::StateSet* stateSet)
{
    if (!stateSet) return true;
    if (!stateSet->getBinName().empty() && stateSet->getBinName() != "RenderBin") return false;
    return !stateSet->useRenderBinDetails() || isOrderedByState(osgUtil::RenderBin::getDefaultRenderBinSortMode());
}

bool canDrawTogether(osgUtil::CullVisitor& visitor)
{
    const osg::CullSettings::ComputeNearFarMode mode = visitor.getComputeNearFarMode();
    return isOrderedByState(visitor.getCurrentRenderBin()->getSortMode()) &&
           (mode == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR ||
            mode == osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES) &&
           visitor.getCurrentCullingSet().getStateFrustumList().empty();
}

SkinnedGeometry* asShared(osg::Node* child)
{
    auto* mesh = dynamic_cast<SkinnedGeometry*>(child);
    return mesh && canBeDrawnTogether(*mesh) ? mesh : nullptr;
}

} // namespace

bool canBeDrawnTogether(const SkinnedGeometry& mesh)
{
    return !mesh.getCullCallback() && !mesh.getDrawCallback() && mesh.getBoundingBox().valid() &&
           isOrderedByState(mesh.getStateSet()) && !InstanceRuns::isRefusedBy(mesh);
}

bool CharacterDraws::Group::holds(const Group& other) const
{
    return bin == other.bin && projection == other.projection && traversalMask == other.traversalMask &&
           set == other.set && slot == other.slot && level == other.level && meshes == other.meshes;
}

bool CharacterDraws::LodInput::isOf(const osg::Group& node) const
{
    if (children.size() != node.getNumChildren()) return false;
    for (unsigned int i = 0; i < node.getNumChildren(); ++i)
        if (children[i] != node.getChild(i)) return false;
    return true;
}

void CharacterDraws::draw(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character,
                          PoseFrame& frame, SubmittedPose pose)
{
    const int level = levelOf(visitor, view, character);
    std::vector<osg::Node*> others; // not a member: other characters may be below these nodes
    const bool isTogether = character.isDrawnTogether && canDrawTogether(visitor) &&
                            drawTogether(visitor, character, frame, pose, level, others);
    osg::StateSet* state = nullptr;
    const auto count = isTogether ? static_cast<unsigned int>(others.size()) : character.node.getNumChildren();
    for (unsigned int i = 0; i < count; ++i)
    {
        osg::Node* child = isTogether ? others[i] : character.node.getChild(i);
        if (!state)
            visitor.pushStateSet(state = frame.stateOf(character.node, character.controller.set(), pose, level));
        child->accept(visitor);
    }
    if (state) visitor.popStateSet();
}

int CharacterDraws::levelOf(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character)
{
    if (!(character.pixelError > 0.0f)) return LodLevels::allTriangles;
    const LodInput& lod = lodOf(character);
    if (!lod.box.valid()) return LodLevels::allTriangles;
    const osg::Vec3 centre = lod.box.center();
    return LodScale(visitor, view, character.pixelError, lod.range)
        .level(glm::vec3(centre.x(), centre.y(), centre.z()), lod.box.radius(), character.rootMatrix);
}

// Characters of one set usually share their meshes; otherwise the range is computed again for each character.
const CharacterDraws::LodInput& CharacterDraws::lodOf(const DrawnCharacter& character)
{
    LodInput& lod = _lods[&character.controller.set()];
    if (lod.isOf(character.node)) return lod;
    lod = {{}, LodRange(character.node, character.controller.set()), {}};
    for (unsigned int i = 0; i < character.node.getNumChildren(); ++i)
        lod.children.push_back(character.node.getChild(i));
    forEachMesh(character.node, [&](const SkinnedGeometry& mesh) { lod.box.expandBy(mesh.getBoundingBox()); });
    return lod;
}

// True: the meshes are part of a group's instanced draw. False: the caller draws all children normally.
bool CharacterDraws::drawTogether(osgUtil::CullVisitor& visitor, const DrawnCharacter& character, PoseFrame& frame,
                                  SubmittedPose pose, int level, std::vector<osg::Node*>& outOthers)
{
    _candidate.bin = visitor.getCurrentRenderBin();
    _candidate.projection = visitor.getProjectionMatrix();
    _candidate.traversalMask = visitor.getTraversalMask();
    _candidate.set = &character.controller.set();
    _candidate.slot = pose.slot;
    _candidate.level = level;
    _candidate.meshes.clear();
    for (unsigned int i = 0; i < character.node.getNumChildren(); ++i)
    {
        SkinnedGeometry* mesh = asShared(character.node.getChild(i));
        if (!mesh)
            outOthers.push_back(character.node.getChild(i));
        else if (visitor.validNodeMask(*mesh))
            _candidate.meshes.push_back(mesh);
    }
    if (_candidate.meshes.empty()) return false;
    std::vector<Group>& groups = _groups[visitor.getCurrentStateGraph()];
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Group& known) { return known.holds(_candidate); });
    if (group == groups.end())
    {
        groups.push_back(_candidate);
        for (const SkinnedGeometry* mesh : _candidate.meshes)
            groups.back().box.expandBy(mesh->getBoundingBox());
        return false;
    }

    // The same tests as CullVisitor::apply(Drawable&).
    const osg::RefMatrix& toEye = *visitor.getModelViewMatrix();
    if (character.node.isCullingActive() && visitor.isCulled(group->box)) return true;
    const bool hasNearFar = visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR;
    if (hasNearFar && !visitor.updateCalculatedNearFar(toEye, group->box)) return true;
    const AffineMatrix placement = toAffine(toEye);
    if (!placement.isFinite()) return true;
    if (!group->together) open(visitor, *group, frame, visitor.getDistanceFromEyePoint(group->box.center(), false));
    group->together->add({placement, static_cast<float>(pose.instance)});
    return true;
}

void CharacterDraws::open(osgUtil::CullVisitor& visitor, Group& group, PoseFrame& frame, float depth)
{
    const DrawState placed = frame.instancedState(*group.set, group.slot, group.level);
    group.together = placed.binding;
    const osg::ref_ptr<osg::RefMatrix> eye = new osg::RefMatrix;
    visitor.pushStateSet(placed.stateSet);
    for (SkinnedGeometry* mesh : group.meshes)
    {
        if (_counted) _counted->add(*mesh, *placed.binding);
        mesh->addTo(visitor, eye.get(), depth);
    }
    visitor.popStateSet();
}

} // namespace osgGpuAnimation
