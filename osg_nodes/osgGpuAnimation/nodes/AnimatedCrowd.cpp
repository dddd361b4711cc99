// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>
#include <osgGpuAnimation/frame/crowd/CrowdCull.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/crowd/InstanceVisits.h>
#include <osgGpuAnimation/frame/crowd/SharedPoses.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/nodes/detail/StillParts.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>
#include <osgGpuAnimation/nodes/properties/OutfitMeshes.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/MeshVisits.h>

#include <osgUtil/IntersectionVisitor>
#include <osgUtil/Statistics>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

/// fileToNode, then the placement as seen from the origin.
osg::Matrixd rootFrom(const osg::Vec3d& origin, const osg::Matrixd& fileToNode, const osg::Matrixd& placement)
{
    osg::Matrixd fromOrigin = placement;
    fromOrigin.setTrans(placement.getTrans() - origin);
    return fileToNode * fromOrigin;
}

} // namespace

AnimatedCrowd::AnimatedCrowd() : AnimatedCrowd(nullptr, {}) {}

AnimatedCrowd::AnimatedCrowd(std::shared_ptr<const AnimationSet> set,
                             const std::vector<osg::ref_ptr<SkinnedGeometry>>& meshes)
    : _instances(std::make_unique<CrowdInstances>(std::move(set))), _posed(std::make_unique<PosedInstances>()),
      _worldTargets(std::make_unique<WorldTargets>()), _meshes(*this, _instances->set()),
      _outfits(*this, *_instances, _meshes._outfits, [this] { showOutfits(); })
{
    // Not STATIC: the Optimizer must not flatten the transforms above into the bind pose.
    setDataVariance(osg::Object::DYNAMIC);
    // The update traversal must reach this node without a callback.
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
    for (const osg::ref_ptr<SkinnedGeometry>& mesh : meshes)
        addChild(mesh);
    if (!meshes.empty()) computeBounds();
}

AnimatedCrowd::AnimatedCrowd(const AnimatedCharacter& character)
    : AnimatedCrowd(character.getController().sharedSet(), {})
{
    _fileToNode = character.getFileToNode();
    _meshes.copySettings(character.getMeshes());
    setVariantNames(*this, variantNamesOf(character));
    setName(character.getName());
    if (character.getStateSet()) setStateSet(const_cast<osg::StateSet*>(character.getStateSet()));
    addUnanimated(character, getAnimationSet(), *this);
    const bool hasStillParts = StillParts::addTo(*this, character); // which the character's bounds do not include
    const std::shared_ptr<const ClipBoxes>& known = character._clipBoxes;
    const auto isSolid = [](const Box& box) { return !box.empty(); };
    if (known && !hasStillParts && std::any_of(known->ofClips.begin(), known->ofClips.end(), isSolid))
        _instances->setClipBounds(known->ofClips, {known, &known->ofMixes});
    else
        computeBounds();
}

AnimatedCrowd::AnimatedCrowd(const AnimatedCrowd& other, const osg::CopyOp& copyop)
    : osg::Transform(other, copyop), _instances(std::make_unique<CrowdInstances>(*other._instances)),
      _posed(std::make_unique<PosedInstances>()), _fileToNode(other._fileToNode), _origin(other._origin),
      _hasOrigin(other._hasOrigin), _updateTime(other._updateTime),
      _worldTargets(std::make_unique<WorldTargets>(*other._worldTargets)), _meshes(*this, _instances->set()),
      _outfits(*this, *_instances, _meshes._outfits, [this] { showOutfits(); }),
      _sharedPoses(other._sharedPoses ? std::make_unique<SharedPoses>(*other._sharedPoses) : nullptr)
{
    _meshes.copySettings(other._meshes);
    // The update traversal must reach this node without a callback.
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

AnimatedCrowd::~AnimatedCrowd() = default;

void AnimatedCrowd::computeBounds()
{
    const AnimationSet& set = getAnimationSet();
    std::vector<const SkinnedGeometry*> meshes;
    forEachMesh(_meshes.drawn(), [&](const SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    const auto boxes = std::make_shared<const ClipBoxes>(set, mixBoxesOf(meshes, set));
    _instances->setClipBounds(boxes->ofClips, {boxes, &boxes->ofMixes});
}

bool AnimatedCrowd::contains(Instance instance) const
{
    return _instances->indexOf(instance) != CrowdInstances::none;
}

std::size_t AnimatedCrowd::getNumInstances() const
{
    return _instances->size();
}

Result<AnimatedCrowd::Instance> AnimatedCrowd::add(const osg::Matrixd& placement, const AnimationController& controller,
                                                   const osg::Vec4& tint)
{
    if (getNumInstances() >= maxInstances)
        return Error{"the crowd has " + std::to_string(getNumInstances()) + " instances, the most that one can have"};
    if (&controller.set() != &getAnimationSet()) return Error{"the controller is for another set than the crowd's"};
    const osg::Vec3d origin = _hasOrigin ? _origin : placement.getTrans();
    const Result<AffineMatrix> root = toRootMatrix(rootFrom(origin, _fileToNode, placement), "the placement", false);
    if (!root) return root.error();
    _origin = origin;
    _hasOrigin = true;
    dirtyBound();
    return _instances->add(root.value(), (_fileToNode * placement).getTrans(), controller, toRgba(tint));
}

Result<void> AnimatedCrowd::setFileToNode(const osg::Matrixd& fileToNode)
{
    if (const Result<AffineMatrix> root = toRootMatrix(fileToNode, "the transform from the file's axes", true); !root)
        return root.error();
    for (std::size_t index = 0; index < getNumInstances(); ++index)
    {
        const osg::Matrixd placement = getPlacement(_instances->handleOf(index));
        _instances->move(index, toAffine(rootFrom(_origin, fileToNode, placement)),
                         (fileToNode * placement).getTrans());
    }
    _fileToNode = fileToNode;
    dirtyBound();
    return {};
}

bool AnimatedCrowd::remove(Instance instance)
{
    if (!contains(instance)) return false;
    _instances->remove(_instances->indexOf(instance));
    dirtyBound();
    return true;
}

Result<void> AnimatedCrowd::setPlacement(Instance instance, const osg::Matrixd& placement)
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return CrowdInstances::noInstance();
    const Result<AffineMatrix> root = toRootMatrix(rootFrom(_origin, _fileToNode, placement), "the placement", false);
    if (!root) return root.error();
    _instances->move(index, root.value(), (_fileToNode * placement).getTrans());
    dirtyBound();
    return {};
}

Result<void> AnimatedCrowd::setTint(Instance instance, const osg::Vec4& tint)
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return CrowdInstances::noInstance();
    _instances->setTint(index, toRgba(tint));
    return {};
}

osg::Vec4 AnimatedCrowd::getTint(Instance instance) const
{
    const std::size_t index = _instances->indexOf(instance);
    return index == CrowdInstances::none ? osg::Vec4(1, 1, 1, 1) : toColor(_instances->tint(index));
}

void AnimatedCrowd::showOutfits()
{
    _meshes.showLevels();
    if (_meshes._outfits->hasProps()) computeBounds();
    dirtyBound();
}

Result<void> AnimatedCrowd::setOutfit(Instance instance, const Outfit* outfit)
{
    const std::size_t index = _instances->indexOf(instance);
    return index == CrowdInstances::none ? CrowdInstances::noInstance() : _outfits.wear(index, outfit);
}

const Outfit* AnimatedCrowd::getOutfit(Instance instance) const
{
    const std::size_t index = _instances->indexOf(instance);
    return index == CrowdInstances::none ? nullptr : _outfits.wornBy(index);
}

Result<void> AnimatedCrowd::setInstanceData(Instance instance, osg::Referenced* data)
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return CrowdInstances::noInstance();
    _instances->setUserData(index, data);
    return {};
}

osg::Referenced* AnimatedCrowd::getInstanceData(Instance instance) const
{
    const std::size_t index = _instances->indexOf(instance);
    return index == CrowdInstances::none ? nullptr : _instances->userData(index);
}

Result<osg::Matrixd> AnimatedCrowd::jointToCrowd(Instance instance, std::size_t joint) const
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return CrowdInstances::noInstance();
    const std::size_t count = getAnimationSet().skeleton().jointCount();
    if (joint >= count) return Error{"there is no joint " + std::to_string(joint) + " among " + std::to_string(count)};
    return toOsg(Pose::jointToModel(getAnimationSet(), _instances->instruction(index), joint)) * fileToSpace(index);
}

Result<osg::Matrixd> AnimatedCrowd::jointToCrowd(Instance instance, const std::string& joint) const
{
    const Result<std::size_t> found = getAnimationSet().skeleton().jointNamed(joint);
    if (!found) return found.error();
    return jointToCrowd(instance, found.value());
}

void AnimatedCrowd::setInstanceEventCallback(std::function<void(Instance, const AnimationEvent&)> callback)
{
    _instances->setEventCallback(std::move(callback));
    dirtyBound();
}

Result<void> AnimatedCrowd::setStateGraph(Instance instance, std::shared_ptr<const StateGraph> graph, std::size_t layer)
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return CrowdInstances::noInstance();
    _instances->setStateMachine(index, graph ? std::make_unique<StateMachine>(std::move(graph), layer) : nullptr);
    dirtyBound();
    return {};
}

StateMachine* AnimatedCrowd::getStateMachine(Instance instance)
{
    const std::size_t index = _instances->indexOf(instance);
    return index == CrowdInstances::none ? nullptr : _instances->stateMachine(index);
}

AnimationController* AnimatedCrowd::getController(Instance instance)
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return nullptr;
    dirtyBound();
    return &_instances->controller(index);
}

osg::Matrixd AnimatedCrowd::fileToSpace(std::size_t index) const
{
    osg::Matrixd root = toOsg(_instances->rootMatrix(index));
    root.setTrans(_instances->position(index));
    return root;
}

NodeConstraint AnimatedCrowd::constraint(Instance instance, const std::string& name)
{
    const std::size_t index = _instances->indexOf(instance);
    const osg::Matrixd fromFile = index == CrowdInstances::none ? osg::Matrixd() : fileToSpace(index);
    return {getController(instance), name, fromFile, toWorld(*this, false), *_worldTargets, instance};
}

Result<void> AnimatedCrowd::setModelTransforms(Instance instance, std::size_t layer,
                                               const std::vector<osg::Matrixd>& jointToCrowd)
{
    if (!contains(instance)) return CrowdInstances::noInstance();
    return poseJoints(*getController(instance), layer, jointToCrowd, fileToSpace(_instances->indexOf(instance)));
}

osg::Matrixd AnimatedCrowd::getPlacement(Instance instance) const
{
    const std::size_t index = _instances->indexOf(instance);
    if (index == CrowdInstances::none) return osg::Matrixd();
    return osg::Matrixd::inverse(_fileToNode) * fileToSpace(index);
}

osg::Matrixd AnimatedCrowd::takeRootMotion(Instance instance)
{
    const std::size_t index = _instances->indexOf(instance);
    return index == CrowdInstances::none ? osg::Matrixd() : toOsg(_instances->takeRootMotion(index), _fileToNode);
}

Result<void> AnimatedCrowd::setOrigin(const osg::Vec3d& origin)
{
    const Result<void> moved = _instances->setOrigin(origin);
    if (!moved) return moved;
    _origin = origin;
    _hasOrigin = true;
    dirtyBound();
    return {};
}

void AnimatedCrowd::update(double simulationTime)
{
    const double step = _updateTime ? simulationTime - *_updateTime : 0.0;
    _updateTime = simulationTime;
    prepareSharedPoses();
    PendingEvents events;
    if (_instances->advance(step, events)) dirtyBound();
    const auto takeWorldTargets = [](AnimatedCrowd& crowd)
    {
        const osg::Matrixd worldToSpace = osg::Matrixd::inverse(toWorld(crowd, false));
        crowd._worldTargets->passOn(
            [&](Instance instance) -> WorldTargets::Owner
            {
                const std::size_t index = crowd._instances->indexOf(instance);
                if (index == CrowdInstances::none) return {};
                return {&crowd._instances->controller(index),
                        worldToSpace * osg::Matrixd::inverse(crowd.fileToSpace(index))};
            });
    };
    if (!_worldTargets->isEmpty()) runAfterUpdateOf(*this, takeWorldTargets);
    if (!events.isEmpty()) runAfterUpdate(*this, [events] { events.deliver(); });
}

std::optional<AnimatedCrowd::Instance> detail::instanceOfMatrix(const osg::RefMatrix* matrix)
{
    const auto* ofInstance = dynamic_cast<const InstanceMatrix*>(matrix);
    return ofInstance ? std::optional(ofInstance->getInstance()) : std::nullopt;
}

osg::ref_ptr<osg::Geometry> AnimatedCrowd::getPosedMesh(Instance instance, const SkinnedGeometry& mesh) const
{
    return posedMesh(_instances->indexOf(instance), mesh, false);
}

osg::ref_ptr<osg::Geometry> AnimatedCrowd::getPosedMesh(const SkinnedGeometry& mesh, bool withNormals) const
{
    return posedMesh(VisitedInstance::current(), mesh, withNormals);
}

osg::ref_ptr<osg::Geometry> AnimatedCrowd::posedMesh(std::size_t index, const SkinnedGeometry& mesh,
                                                     bool withNormals) const
{
    if (index >= getNumInstances())
    {
        osg::ref_ptr<osg::Geometry> none = new osg::Geometry;
        none->setVertexArray(new osg::Vec3Array);
        return none;
    }
    return _posed->of(_instances->handleOf(index))
        ->of(mesh, getSharedAnimationSet(), _instances->instruction(index), _instances->rootMatrix(index), withNormals);
}

void AnimatedCrowd::accept(osg::NodeVisitor& visitor)
{
    const std::optional<double> time = updateTimeOf(visitor);
    if (time && visitor.validNodeMask(*this)) update(*time);
    osg::Transform::accept(visitor);
}

void AnimatedCrowd::traverse(osg::NodeVisitor& visitor)
{
    if (const std::optional<double> time = updateTimeOf(visitor); time && time != _updateTime) update(*time);
    const OutfitMeshes* const outfits = _meshes._outfits.get();
    const auto nodesOfOutfits = [&] { return outfits ? outfits->nodesOfOutfits() : NodesOfOutfits(); };
    if (osgUtil::CullVisitor* cullVisitor = visitor.asCullVisitor())
        cullCrowd({*this, *this, *_instances, _meshes.drawn(), _meshes.getPixelError(), _meshes._levels,
                   _sharedPoses.get(), outfits ? &outfits->lists() : nullptr},
                  *cullVisitor);
    else if (dynamic_cast<osgUtil::IntersectionVisitor*>(&visitor) || isFileWriter(visitor))
        visitInstances(*this, *_instances, nodesOfOutfits(), visitor);
    else if (dynamic_cast<osgUtil::StatsVisitor*>(&visitor))
        visitMeshesPerInstance(*this, *_instances, nodesOfOutfits(), visitor);
    else if (const Box now = computesBounds(visitor) ? _instances->bounds() : Box(); !now.empty())
        traverseWithBounds(*this, toOsg(now), visitor);
    else if (!keepFlattenedPlace(*this, visitor))
        osg::Transform::traverse(visitor);
}

void AnimatedCrowd::prepareSharedPoses()
{
    if (_meshes._outfits && _meshes._outfits->update(*this)) _meshes.showLevels();
    _meshes.updateLevels();
    const bool isOn = _meshes.getPixelError() > 0.0f && getAnimationSet().paletteSize() > 0;
    if (isOn && (!_sharedPoses || !_sharedPoses->isOf(_meshes.drawn()))) // kept for the next pixel error
        _sharedPoses = std::make_unique<SharedPoses>(_meshes.drawn(), getSharedAnimationSet());
    if (_sharedPoses) _sharedPoses->update(isOn && !_meshes._task); // no waiting while levels are being made
}

void AnimatedCrowd::releaseGLObjects(osg::State* state) const
{
    osg::Transform::releaseGLObjects(state);
    if (_meshes._outfits) _meshes._outfits->meshes().releaseGLObjects(state);
    if (_meshes._levels) _meshes._levels->releaseGLObjects(state);
}

void AnimatedCrowd::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Transform::resizeGLObjectBuffers(maxSize);
    if (_meshes._outfits) const_cast<osg::Group&>(_meshes._outfits->meshes()).resizeGLObjectBuffers(maxSize);
    if (_meshes._levels) _meshes._levels->resizeGLObjectBuffers(maxSize);
}

osg::BoundingSphere AnimatedCrowd::computeBound() const
{
    osg::BoundingBox box;
    for (std::size_t index = 0; index < getNumInstances(); ++index)
    {
        const glm::vec4& sphere = _instances->sphere(index);
        box.expandBy(osg::BoundingSphere(osg::Vec3(sphere.x, sphere.y, sphere.z), sphere.w));
    }
    osg::BoundingSphere bound = box.valid() ? osg::BoundingSphere(box) : osg::BoundingSphere();
    for (const osg::ref_ptr<osg::Node>& child : _children)
    {
        // Also compute the bounds of the meshes: cameras that cull concurrently must find them ready.
        const osg::BoundingSphere& ofChild = child->getBound();
        if (!dynamic_cast<const SkinnedGeometry*>(child.get())) bound.expandBy(ofChild);
    }
    if (!bound.valid()) return bound;
    const osg::Vec3d center = osg::Vec3d(bound.center()) + _origin;
    // A bound may store floats: the margin covers their rounding far from the origin.
    return {osg::BoundingSphere::vec_type(center),
            static_cast<osg::BoundingSphere::value_type>(bound.radius() + 1e-6 * center.length())};
}

bool AnimatedCrowd::computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor*) const
{
    if (_referenceFrame == RELATIVE_RF)
        matrix.preMultTranslate(_origin);
    else
        matrix.makeTranslate(_origin);
    return true;
}

bool AnimatedCrowd::computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor*) const
{
    if (_referenceFrame == RELATIVE_RF)
        matrix.postMultTranslate(-_origin);
    else
        matrix.makeTranslate(-_origin);
    return true;
}

} // namespace osgGpuAnimation
