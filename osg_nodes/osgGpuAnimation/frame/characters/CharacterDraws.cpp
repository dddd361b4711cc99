// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/characters/CharacterDraws.h>

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

void CharacterDraws::begin(DrawnInstances* counted)
{
    _looks.clear();
    _looksByHash.clear();
    _lastLook = nullptr;
    _groups.clear();
    _lastScale.reset();
    _counted = counted;
}

CharacterDraws::Look& CharacterDraws::lookOf(const osgUtil::CullVisitor& visitor, const DrawnCharacter& character)
{
    const auto isIts = [&](const Look& look)
    {
        bool isSame = look.set == &character.controller.set() && look.traversalMask == visitor.getTraversalMask() &&
                      look.children.size() == character.node.getNumChildren();
        for (unsigned int i = 0; i < character.node.getNumChildren() && isSame; ++i)
            isSame = look.children[i] == character.node.getChild(i);
        return isSame;
    };
    if (_lastLook && isIts(*_lastLook)) return *_lastLook;
    std::size_t hash = character.node.getNumChildren();
    for (unsigned int i = 0; i < character.node.getNumChildren(); ++i)
        hash = (hash ^ reinterpret_cast<std::uintptr_t>(character.node.getChild(i)) >> 4) *
               std::size_t(0x9E3779B97F4A7C15);
    const auto [begin, end] = _looksByHash.equal_range(hash);
    const auto known = std::find_if(begin, end, [&](const auto& each) { return isIts(*each.second); });
    if (known != end) return *(_lastLook = known->second);
    Look look{_looks.size(), &character.controller.set(), visitor.getTraversalMask(), {}};
    for (unsigned int i = 0; i < character.node.getNumChildren(); ++i)
    {
        osg::Node* child = character.node.getChild(i);
        look.children.push_back(child);
        SkinnedGeometry* mesh = asShared(child);
        if (!mesh)
            look.hasOthers = true;
        else if (visitor.validNodeMask(*mesh))
            look.shared.push_back(mesh);
    }
    forEachMesh(character.node, [&](const SkinnedGeometry& mesh) { look.box.expandBy(mesh.getBoundingBox()); });
    _looks.push_back(std::make_unique<Look>(std::move(look)));
    _lastLook = _looks.back().get();
    _looksByHash.emplace(hash, _lastLook);
    return *_lastLook;
}

void CharacterDraws::draw(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character,
                          PoseFrame& frame, SubmittedPose pose)
{
    Look& look = lookOf(visitor, character);
    const int level = levelOf(visitor, view, character, look, osg::Matrixd());
    Group* group = nullptr;
    if (character.isDrawnTogether && !look.shared.empty() && canDrawTogether(visitor))
        group = &groupOf(visitor, character.controller.set(), pose.slot, level);
    std::vector<osg::Node*> alone; // not a member: other characters may be below these nodes
    for (unsigned int i = 0; i < character.node.getNumChildren(); ++i)
        if (!group || !group->knows(character.node.getChild(i))) alone.push_back(character.node.getChild(i));
    const bool isVisible = !character.node.isCullingActive() || !visitor.isCulled(look.box);
    if (group && isVisible) add(visitor, *group, look, frame, *visitor.getModelViewMatrix(), pose.instance);
    for (const SkinnedGeometry* mesh : look.shared)
        if (group) group->bindings.emplace(mesh, nullptr);
    osg::StateSet* state = nullptr;
    for (osg::Node* child : alone)
    {
        if (!state)
            visitor.pushStateSet(state = frame.stateOf(character.node, character.controller.set(), pose, level));
        child->accept(visitor);
    }
    if (state) visitor.popStateSet();
}

bool CharacterDraws::drawFromAbove(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character,
                                   const osg::Matrixd& toParent, const osg::Matrixd& toEye, PoseFrame& frame)
{
    Look& look = lookOf(visitor, character);
    if (look.shared.empty() || look.hasOthers || !canDrawTogether(visitor)) return false;
    const int level = levelOf(visitor, view, character, look, toParent);
    const SubmittedPose pose = frame.submit(character.node, character.controller, character.rootMatrix);
    Group& group = groupOf(visitor, character.controller.set(), pose.slot, level);
    const auto isKnown = [&](const SkinnedGeometry* mesh) { return group.knows(mesh); };
    if (!group.isOpen(look) && !std::all_of(look.shared.begin(), look.shared.end(), isKnown)) return false;
    add(visitor, group, look, frame, toEye, pose.instance);
    return true;
}

/// toVisitor: from the character's space to the visitor's present one.
int CharacterDraws::levelOf(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character, Look& look,
                            const osg::Matrixd& toVisitor)
{
    if (!(character.pixelError > 0.0f) || !look.box.valid()) return LodLevels::allTriangles;
    if (!look.range) look.range = LodRange(character.node, character.controller.set());
    const osg::RefMatrix *toEye = visitor.getModelViewMatrix(), *projection = visitor.getProjectionMatrix();
    if (!_lastScale || _lastScale->toEye != toEye || _lastScale->projection != projection ||
        _lastScale->look != &look || _lastScale->pixelError != character.pixelError)
        _lastScale = {toEye, projection, &look, character.pixelError,
                      LodScale(visitor, view, character.pixelError, *look.range)};
    const osg::Vec3d centre = osg::Vec3d(look.box.center()) * toVisitor;
    const float scale = maxScale(toAffine(toVisitor));
    const LodScale& lod = _lastScale->scale;
    return lod.levelWithin(lod.allowedError(glm::vec3(centre.x(), centre.y(), centre.z()), look.box.radius() * scale,
                                            scale * maxScale(character.rootMatrix)));
}

CharacterDraws::Group& CharacterDraws::groupOf(osgUtil::CullVisitor& visitor, const AnimationSet& set, std::size_t slot,
                                               int level)
{
    const GroupKey key{visitor.getCurrentRenderBin(), visitor.getProjectionMatrix(), &set, slot, level};
    std::vector<std::unique_ptr<Group>>& groups = _groups[visitor.getCurrentStateGraph()];
    auto known = std::find_if(groups.begin(), groups.end(),
                              [&](const std::unique_ptr<Group>& group) { return group->key == key; });
    if (known == groups.end()) known = groups.insert(known, std::make_unique<Group>(Group{key}));
    return **known;
}

/// Adds an instance, unless it is behind the near plane or nowhere: the tests of CullVisitor::apply(Drawable&).
void CharacterDraws::add(osgUtil::CullVisitor& visitor, Group& group, const Look& look, PoseFrame& frame,
                         const osg::Matrixd& toEye, std::size_t instance)
{
    const AffineMatrix placement = toAffine(toEye);
    if (!placement.isFinite()) return;
    const bool hasNearFar = visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR;
    if (hasNearFar && !visitor.updateCalculatedNearFar(toEye, look.box)) return;
    std::shared_ptr<std::vector<InstanceTransform>> instances;
    if (group.isOpen(look))
        instances = group.instances[look.number];
    else
        instances = open(visitor, group, look, frame, static_cast<float>(-(osg::Vec3d(look.box.center()) * toEye).z()));
    instances->push_back({placement, static_cast<float>(instance)});
}

/// Adds a list of instances to the draws of the look's meshes that the group knows. It serves later ones, too, if those
/// are all.
std::shared_ptr<std::vector<InstanceTransform>> CharacterDraws::open(osgUtil::CullVisitor& visitor, Group& group,
                                                                     const Look& look, PoseFrame& frame, float depth)
{
    const auto instances = std::make_shared<std::vector<InstanceTransform>>();
    const osg::ref_ptr<osg::RefMatrix> eye = new osg::RefMatrix;
    bool isComplete = true;
    for (SkinnedGeometry* mesh : look.shared)
    {
        const auto known = group.bindings.find(mesh);
        isComplete = isComplete && known != group.bindings.end();
        if (known == group.bindings.end()) continue;
        PaletteBinding*& binding = known->second;
        if (!binding)
        {
            const auto& [bin, projection, set, slot, level] = group.key;
            const DrawState placed = frame.instancedState(*set, slot, level);
            binding = placed.binding;
            if (_counted) _counted->add(*mesh, *binding);
            visitor.pushStateSet(placed.stateSet);
            mesh->addTo(visitor, eye.get(), depth);
            visitor.popStateSet();
        }
        binding->add(instances);
    }
    if (!isComplete) return instances;
    if (group.instances.size() <= look.number) group.instances.resize(look.number + 1);
    return group.instances[look.number] = instances;
}

} // namespace osgGpuAnimation
