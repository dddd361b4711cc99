// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/characters/FirstDraw.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseStage.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/nodes/properties/Wardrobe.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <typeinfo>

namespace osgGpuAnimation
{

namespace
{

/// The constraints with an effect, bit c for constraint c.
std::uint64_t constraintsOf(const AnimationController& controller)
{
    std::uint64_t constraints = 0;
    const std::vector<ConstraintTarget>& targets = controller.instruction().targets;
    for (std::size_t c = 0; c < targets.size(); ++c)
        if (targets[c].weight > 0.0f) constraints |= std::uint64_t(1) << c;
    return constraints;
}

std::vector<const SkinnedGeometry*> meshesBelow(osg::Node& node)
{
    std::vector<const SkinnedGeometry*> meshes;
    forEachMeshBelow(node, [&](const SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    return meshes;
}

/// True if it shows meshes of the character where they are: a mesh, its levels of detail, a switch of a host above
/// parts.
bool showsMeshesAlone(const osg::Node& node)
{
    if (dynamic_cast<const SkinnedGeometry*>(&node)) return true;
    const osg::Group* const group = node.asGroup();
    if (!group || group->asTransform() || group->getNumChildren() == 0) return false;
    for (unsigned int child = 0; child < group->getNumChildren(); ++child)
        if (!showsMeshesAlone(*group->getChild(child))) return false;
    return true;
}

/// True if the object's class derives nothing that could do otherwise.
template <typename Class, typename Object>
bool isPlain(const Object& object)
{
    return typeid(object) == typeid(Class);
}

/// Those that others wear: of levels of detail in the file the first.
std::vector<const SkinnedGeometry*> wornMeshes(const AnimatedCharacter& garment)
{
    std::vector<const SkinnedGeometry*> meshes;
    forEachMesh(garment, [&](const SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    return meshes;
}

} // namespace

AnimatedCharacter::AnimatedCharacter() : AnimatedCharacter(nullptr) {}

AnimatedCharacter::AnimatedCharacter(std::shared_ptr<const AnimationSet> set)
    : _controller(std::make_unique<AnimationController>(std::move(set))),
      _worldTargets(std::make_unique<WorldTargets>()), _meshes(*this, _controller->sharedSet(), _controller.get()),
      _wardrobe(std::make_shared<Wardrobe>())
{
    static const std::shared_ptr<const Axes> identity = std::make_shared<const Axes>();
    _axes = identity;
    // Not STATIC: the Optimizer must not flatten this transform or those above into the bind pose.
    setDataVariance(osg::Object::DYNAMIC);
    // The update traversal must reach this node without a callback.
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

AnimatedCharacter::AnimatedCharacter(const AnimatedCharacter& other, const osg::CopyOp& copyop)
    : osg::MatrixTransform(other, copyop), _controller(std::make_unique<AnimationController>(*other._controller)),
      _axes(other._axes), _clipBoxes(other._clipBoxes), _updateTime(other._updateTime),
      _worldTargets(std::make_unique<WorldTargets>(*other._worldTargets)), _isDrawnTogether(other._isDrawnTogether),
      _meshes(*this, _controller->sharedSet(), _controller.get()), _wardrobe(other._wardrobe)
{
    _meshes.copySettings(other._meshes);
    // osg::Node copies its other callbacks, but not the event callbacks.
    setEventCallback(copyop(other.getEventCallback()));
    // The update traversal must reach this node without a callback.
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

AnimatedCharacter::~AnimatedCharacter() = default;

Result<void> AnimatedCharacter::setAnimationSet(std::shared_ptr<const AnimationSet> newSet)
{
    const bool isFirst = getAnimationSet().paletteSize() == 0;
    if (!newSet || (!isFirst && newSet->paletteSize() != getAnimationSet().paletteSize()))
        return Error{"a set of " + std::to_string(newSet ? newSet->paletteSize() : 0) +
                     " palette entries for the meshes of one of " + std::to_string(getAnimationSet().paletteSize())};
    *_controller = AnimationController(std::move(newSet), *_controller);
    _meshes.forgetProperties();
    if (_clipBoxes) computeClipBounds();
    // The levels of detail depend on the poses of the clips.
    if (!isFirst) forEachMeshBelow(*this, [](SkinnedGeometry& mesh) { MeshDetail::forgetLevels(mesh); });
    return _meshes.setPixelError(_meshes.getPixelError());
}

NodeConstraint AnimatedCharacter::constraint(const std::string& name)
{
    return {_controller.get(), name, _axes->fileToNode, toWorld(*this, true), *_worldTargets, 0};
}

Result<WornGarment> AnimatedCharacter::wear(osg::Node* garment)
{
    AnimatedCharacter* source = garment ? findCharacter(*garment) : nullptr;
    if (!source || source == this) return Error{"the garment has no animated character"};
    const std::vector<const SkinnedGeometry*> meshes = wornMeshes(*source);
    if (meshes.empty()) return Error{"the garment has no meshes that joints move"};
    if (wears(_wardrobe->identifierOf(*source, meshes))) return Error{"the character wears the garment already"};
    const Result<FittedGarment> fitted =
        _wardrobe->fit(*source, source->getAnimationSet(), meshes, _controller->sharedSet());
    if (!fitted) return fitted.error();
    for (const osg::ref_ptr<SkinnedGeometry>& mesh : fitted.value().meshes)
        addChild(mesh);
    _meshes.showVariant();
    useOutfit(fitted.value().set);
    return WornGarment(fitted.value());
}

/// identifier: of a garment; empty: none.
bool AnimatedCharacter::wears(const std::string& identifier) const
{
    const auto isPart = [&](const osg::ref_ptr<osg::Node>& child)
    { return Wardrobe::identifierOf(*child) == identifier; };
    return !identifier.empty() && std::any_of(_children.begin(), _children.end(), isPart);
}

Result<void> AnimatedCharacter::takeOff(const osg::Node* garment)
{
    if (!garment) return Error{"there is no garment to take off"};
    AnimatedCharacter* source = findCharacter(const_cast<osg::Node&>(*garment));
    const std::string identifier =
        source ? _wardrobe->identifierOf(*source, wornMeshes(*source)) : Wardrobe::identifierOf(*garment);
    if (!wears(identifier))
    {
        std::vector<std::string> worn;
        for (const osg::ref_ptr<osg::Node>& child : _children)
            if (!Wardrobe::identifierOf(*child).empty()) worn.push_back(child->getName());
        return Error{"the character does not wear \"" + garment->getName() + "\"; the meshes of its garments are " +
                     quotedNames(worn)};
    }
    for (unsigned int child = getNumChildren(); child-- > 0;)
        if (Wardrobe::identifierOf(*getChild(child)) == identifier) removeChild(child);
    useOutfit(Wardrobe::withoutUnused(_controller->sharedSet(), *this));
    return {};
}

/// Takes a set that the present meshes fit. Clones share the meshes, so their boxes only grow.
void AnimatedCharacter::useOutfit(const std::shared_ptr<const AnimationSet>& set)
{
    if (set != _controller->sharedSet()) *_controller = AnimationController(set, *_controller);
    if (_clipBoxes)
    {
        _clipBoxes = _wardrobe->boxes(meshesBelow(*this), set);
        growMeshes(boundsOfAllClips());
        _played.clear();
        dirtyBound();
    }
    (void)_meshes.setPixelError(_meshes.getPixelError());
}

Result<void> AnimatedCharacter::setFileToNode(const osg::Matrixd& fileToNode)
{
    const Result<AffineMatrix> root = toRootMatrix(fileToNode, "the transform from the file's axes", true);
    if (!root) return root.error();
    _axes = std::make_shared<const Axes>(Axes{fileToNode, root.value()});
    if (_clipBoxes) setMeshBounds();
    return {};
}

Result<osg::Matrixd> AnimatedCharacter::jointToModel(std::size_t joint) const
{
    const std::size_t count = getAnimationSet().skeleton().jointCount();
    if (joint >= count) return Error{"there is no joint " + std::to_string(joint) + " among " + std::to_string(count)};
    return toOsg(Pose::jointToModel(getAnimationSet(), _controller->instruction(), joint)) * _axes->fileToNode;
}

Result<osg::Matrixd> AnimatedCharacter::jointToModel(const std::string& joint) const
{
    const Result<std::size_t> index = getAnimationSet().skeleton().jointNamed(joint);
    if (!index) return index.error();
    return jointToModel(index.value());
}

Result<void> AnimatedCharacter::setModelTransforms(std::size_t layer, const std::vector<osg::Matrixd>& jointToModel)
{
    return poseJoints(*_controller, layer, jointToModel, _axes->fileToNode);
}

osg::Matrixd AnimatedCharacter::takeRootMotion()
{
    return toOsg(_controller->takeRootMotion(), _axes->fileToNode);
}

void AnimatedCharacter::update(double simulationTime)
{
    PendingEvents events;
    if (_updateTime && simulationTime != *_updateTime)
        ControllerDetail::advance(*_controller, simulationTime - *_updateTime, events);
    _updateTime = simulationTime;
    updateBounds();
    _meshes.showProperties();
    _meshes.updateLevels();
    const auto takeWorldTargets = [](AnimatedCharacter& character)
    {
        const WorldTargets::Owner owner{character._controller.get(),
                                        osg::Matrixd::inverse(toWorld(character, true)) *
                                            osg::Matrixd::inverse(character._axes->fileToNode)};
        character._worldTargets->passOn([&](WorldTargets::Instance) { return owner; });
    };
    if (!_worldTargets->isEmpty()) runAfterUpdateOf(*this, takeWorldTargets);
    if (events.isEmpty()) return;
    runAfterUpdate(*this,
                   [events, character = osg::observer_ptr<AnimatedCharacter>(this)]
                   {
                       events.deliver();
                       osg::ref_ptr<AnimatedCharacter> present;
                       if (character.lock(present)) present->updateBounds();
                   });
}

void AnimatedCharacter::updateBounds()
{
    ControllerDetail::findPlayedClips(*_controller, _playedNow);
    const std::uint64_t constraints = constraintsOf(*_controller);
    if (_playedNow == _played && constraints == _constraints) return;
    std::swap(_played, _playedNow);
    _constraints = constraints;
    dirtyBound();
    if (_clipBoxes) growMeshes(boundsOf(_played));
}

// The boxes of the meshes already contain each single clip. Clones share the meshes, so a larger box serves them all.
void AnimatedCharacter::growMeshes(const osg::BoundingBox& box)
{
    forEachMeshBelow(*this,
                     [&](SkinnedGeometry& mesh)
                     {
                         osg::BoundingBox grown = mesh.getInitialBound();
                         grown.expandBy(box);
                         if (grown != mesh.getInitialBound()) mesh.setInitialBound(grown);
                     });
}

void AnimatedCharacter::computeClipBounds()
{
    _clipBoxes =
        std::make_shared<const ClipBoxes>(getAnimationSet(), mixBoxesOf(meshesBelow(*this), getAnimationSet()));
    setMeshBounds();
}

osg::BoundingBox AnimatedCharacter::boundsOfAllClips() const
{
    osg::BoundingBox all;
    for (const Box& box : _clipBoxes->ofClips)
        all.expandBy(transformed(toOsg(box), _axes->fileToNode));
    return all;
}

void AnimatedCharacter::setMeshBounds()
{
    const osg::BoundingBox all = boundsOfAllClips();
    forEachMeshBelow(*this, [&](SkinnedGeometry& mesh) { mesh.setInitialBound(all); });
    _played.clear();
    dirtyBound();
}

osg::BoundingBox AnimatedCharacter::getClipBounds(int clip) const
{
    const std::size_t index = static_cast<std::size_t>(clip + 1);
    if (!_clipBoxes || index >= _clipBoxes->ofClips.size()) return {};
    return transformed(toOsg(_clipBoxes->ofClips[index]), _axes->fileToNode);
}

osg::ref_ptr<osg::Geometry> AnimatedCharacter::getPosedMesh(const SkinnedGeometry& mesh, bool withNormals) const
{
    std::call_once(_posedMeshesMade, [this] { _posedMeshes = std::make_unique<PosedMeshes>(); });
    return _posedMeshes->of(mesh, _controller->sharedSet(), _controller->instruction(), _axes->rootMatrix, withNormals);
}

void AnimatedCharacter::acceptPosed(osg::PrimitiveFunctor& functor)
{
    const auto pass = [&](const SkinnedGeometry& mesh)
    {
        if (mesh.getNodeMask() != 0) getPosedMesh(mesh)->accept(functor);
    };
    forEachMeshBelow(*this, pass);
}

void AnimatedCharacter::accept(osg::NodeVisitor& visitor)
{
    if (const std::optional<double> time = updateTimeOf(visitor); time && visitor.validNodeMask(*this))
    {
        update(*time);
        // This node itself requires one.
        const bool isLeaf = !getUpdateCallback() && getNumChildrenRequiringUpdateTraversal() == 1;
        if (isLeaf && isPlain<AnimatedCharacter>(*this) && isPlain<osgUtil::UpdateVisitor>(visitor)) return;
    }
    else if (osgUtil::CullVisitor* cull = visitor.asCullVisitor(); cull && cullTogether(*cull))
        return;
    osg::MatrixTransform::accept(visitor);
}

/// As the traversal of a CullVisitor for a character that is drawn together with others. False: the visitor must
/// traverse it.
bool AnimatedCharacter::cullTogether(osgUtil::CullVisitor& visitor)
{
    if (!_isDrawnTogether || getCullCallback() || getStateSet() || getReferenceFrame() != RELATIVE_RF) return false;
    if (!visitor.validNodeMask(*this) || !isPlain<AnimatedCharacter>(*this) ||
        !isPlain<osgUtil::CullVisitor>(visitor) || getNumChildren() == 0 || getAnimationSet().paletteSize() == 0)
        return false;
    if (visitor.isCulled(*this)) return true;
    visitor.pushCurrentMask();
    bool isDrawn = false;
    {
        const DepthPass pass(visitor);
        const ViewLightsScope lights(visitor);
        isDrawn = PoseStage::drawFromAbove(visitor, drawn(), getMatrix());
    }
    visitor.popCurrentMask();
    return isDrawn;
}

void AnimatedCharacter::traverse(osg::NodeVisitor& visitor)
{
    if (const std::optional<double> time = updateTimeOf(visitor); time && time != _updateTime) update(*time);
    osgUtil::CullVisitor* cullVisitor = visitor.asCullVisitor();
    if (!cullVisitor || getNumChildren() == 0 || getAnimationSet().paletteSize() == 0)
    {
        const osg::BoundingBox now = computesBounds(visitor) ? getCurrentBounds() : osg::BoundingBox();
        if (now.valid())
            traverseWithBounds(*this, now, visitor);
        else if (!keepFlattenedPlace(*this, visitor))
            osg::MatrixTransform::traverse(visitor);
        prepareFirstDraw(visitor, drawn());
        return;
    }
    const DepthPass pass(*cullVisitor);
    const ViewLightsScope lights(*cullVisitor);
    PoseStage::draw(*cullVisitor, drawn());
}

DrawnCharacter AnimatedCharacter::drawn()
{
    return {*this, *_controller, _axes->rootMatrix, _meshes.getPixelError(), _isDrawnTogether};
}

osg::BoundingBox AnimatedCharacter::boundsOf(const std::vector<PlayedClip>& played) const
{
    const std::uint64_t constraints = constraintsOf(*_controller);
    const bool isAlone = played.size() == 1 && played.front().part == PlayedClip::Part::Mixed && constraints == 0;
    if (isAlone || !_clipBoxes) return getClipBounds(isAlone ? played.front().clip : _controller->clip());
    return transformed(toOsg(_clipBoxes->ofMixes.box(played, constraints)), _axes->fileToNode);
}

osg::BoundingBox AnimatedCharacter::getCurrentBounds() const
{
    std::vector<PlayedClip> played;
    ControllerDetail::findPlayedClips(*_controller, played);
    return boundsOf(played);
}

osg::BoundingSphere AnimatedCharacter::computeBound() const
{
    osg::BoundingBox box = getCurrentBounds();
    if (!box.valid()) return osg::MatrixTransform::computeBound();
    osg::BoundingSphere others;
    for (const osg::ref_ptr<osg::Node>& child : _children)
    {
        // Meshes are asked for theirs, too: cameras that cull at once must find all bounds computed.
        const osg::BoundingSphere& bound = child->getBound();
        if (!showsMeshesAlone(*child)) others.expandBy(bound);
    }
    if (others.valid()) box.expandBy(others);
    return osg::BoundingSphere(transformed(box, getMatrix()));
}

AnimatedCharacter* findCharacter(osg::Node& node)
{
    return findBelow<AnimatedCharacter>(node);
}

} // namespace osgGpuAnimation
