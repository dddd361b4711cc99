// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/frame/characters/FirstDraw.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseStage.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>
#include <osgGpuAnimation/nodes/properties/Wardrobe.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/observer_ptr>
#include <osgUtil/CullVisitor>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

EntryBoxes entryBoxesOf(osg::Node& node, const AnimationSet& set)
{
    PaletteEntryBounds bounds(set);
    forEachMeshBelow(node, [&](const SkinnedGeometry& mesh) { bounds.add(mesh); });
    return bounds.boxes();
}

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

/// Those that others wear: of levels of detail in the file the first.
std::vector<const SkinnedGeometry*> wornMeshes(const AnimatedCharacter& garment)
{
    std::vector<const SkinnedGeometry*> meshes;
    forEachMesh(garment, [&](const SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    return meshes;
}

Error noInstance()
{
    return Error{"the crowd has no such instance (any more)"};
}

} // namespace

NodeConstraint::NodeConstraint(AnimationController* controller, const std::string& name,
                               const osg::Matrixd& fileToSpace, const osg::Matrixd& spaceToWorld,
                               WorldTargets& worldTargets, std::uint64_t instance)
    : _controller(controller), _name(name), _fileToSpace(fileToSpace), _spaceToWorld(spaceToWorld),
      _worldTargets(&worldTargets), _instance(instance)
{
}

Result<void> NodeConstraint::setTarget(const osg::Vec3d& position)
{
    if (!_controller) return noInstance();
    Result<void> taken =
        _controller->constraint(_name).setTarget(toGlm(position * osg::Matrixd::inverse(_fileToSpace)));
    if (taken) _worldTargets->remove(_instance, _name);
    return taken;
}

Result<void> NodeConstraint::setWorldTarget(const osg::Vec3d& position)
{
    Result<void> taken = setTarget(position * osg::Matrixd::inverse(_spaceToWorld));
    if (taken) _worldTargets->set(_instance, _name, {nullptr, false, position});
    return taken;
}

Result<void> NodeConstraint::follow(osg::Node* node, const osg::Vec3d& position)
{
    if (!node) return Error{"constraint \"" + _name + "\": there is no node to follow"};
    Result<void> taken = setTarget(position * toWorld(*node, true) * osg::Matrixd::inverse(_spaceToWorld));
    if (taken) _worldTargets->set(_instance, _name, {node, true, position});
    return taken;
}

Result<void> NodeConstraint::setWeight(float weight)
{
    return _controller ? _controller->constraint(_name).setWeight(weight) : noInstance();
}

Result<void> NodeConstraint::setPole(const osg::Vec3d& direction)
{
    if (!_controller) return noInstance();
    const osg::Vec3d inFile = osg::Matrixd::transform3x3(direction, osg::Matrixd::inverse(_fileToSpace));
    return _controller->constraint(_name).setPole(toGlm(inFile));
}

Result<void> NodeConstraint::setTwist(double radians)
{
    return _controller ? _controller->constraint(_name).setTwist(static_cast<float>(radians)) : noInstance();
}

Result<void> NodeConstraint::setRotation(const osg::Quat& rotation)
{
    if (!_controller) return noInstance();
    osg::Vec3d translation, scale;
    osg::Quat turn, scaleAxes;
    _fileToSpace.decompose(translation, turn, scale, scaleAxes);
    const osg::Quat inFile = rotation * turn.inverse();
    return _controller->constraint(_name).setRotation(
        glm::vec4(glm::dvec4(inFile.x(), inFile.y(), inFile.z(), inFile.w())));
}

Result<void> NodeConstraint::clear()
{
    if (!_controller) return noInstance();
    _worldTargets->remove(_instance, _name);
    return _controller->constraint(_name).clear();
}

AnimatedCharacter::AnimatedCharacter() : AnimatedCharacter(nullptr) {}

AnimatedCharacter::AnimatedCharacter(std::shared_ptr<const AnimationSet> set)
    : _controller(std::make_unique<AnimationController>(std::move(set))),
      _worldTargets(std::make_unique<WorldTargets>()), _variantMeshes(std::make_shared<VariantMeshes>()),
      _wardrobe(std::make_shared<Wardrobe>()), _properties(AnimatedProperties::of(getAnimationSet()))
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
      _axes(other._axes), _clipBounds(other._clipBounds), _mixBounds(other._mixBounds), _updateTime(other._updateTime),
      _worldTargets(std::make_unique<WorldTargets>(*other._worldTargets)), _isDrawnTogether(other._isDrawnTogether),
      _pixelError(other._pixelError), _materialVariant(other._materialVariant), _variantMeshes(other._variantMeshes),
      _wardrobe(other._wardrobe), _properties(AnimatedProperties::of(getAnimationSet()))
{
    if (_properties) _properties->bind(*this); // the children are the other's, too
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
    _properties = AnimatedProperties::of(getAnimationSet());
    if (_clipBounds) computeClipBounds();
    // The levels of detail depend on the poses of the clips.
    if (!isFirst) forEachMeshBelow(*this, [](SkinnedGeometry& mesh) { mesh.forgetLodLevels(); });
    return setPixelError(_pixelError);
}

NodeConstraint AnimatedCharacter::constraint(const std::string& name)
{
    return {_controller.get(), name, _axes->fileToNode, toWorld(*this, true), *_worldTargets, 0};
}

void AnimatedCharacter::takeWorldTargets()
{
    const osg::Matrixd worldToFile =
        osg::Matrixd::inverse(toWorld(*this, true)) * osg::Matrixd::inverse(_axes->fileToNode);
    _worldTargets->passOn(
        [&](WorldTargets::Instance) -> WorldTargets::Owner {
            return {_controller.get(), worldToFile};
        });
}

Result<void> AnimatedCharacter::setPixelError(float pixels)
{
    const Result<void> prepared = LodRange::prepare(pixels, *this, getAnimationSet());
    if (prepared) _pixelError = pixels;
    return prepared;
}

std::vector<std::string> AnimatedCharacter::getMaterialVariants() const
{
    std::vector<std::string> names = variantNamesOf(*this);
    const auto addNames = [&](const SkinnedGeometry& mesh)
    {
        for (const std::string& name : variantNamesOf(mesh))
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    forEachMesh(*this, addNames);
    return names;
}

Result<void> AnimatedCharacter::setMaterialVariant(const std::string& name)
{
    const std::vector<std::string> names = getMaterialVariants();
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
        return Error{"there is no material variant \"" + name + "\"; the variants are " +
                     quotedNames(names, [](const std::string& known) { return known; })};
    if (_properties) _properties->restoreMasks();
    _variantMeshes->show(*this, name);
    _materialVariant = name;
    rebindProperties();
    return {};
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
    if (_properties) _properties->restoreMasks();
    if (!_materialVariant.empty()) _variantMeshes->show(*this, _materialVariant);
    useOutfit(fitted.value().set);
    rebindProperties();
    return WornGarment{fitted.value().addedEntries, fitted.value().followed, fitted.value().leftOut};
}

/// identifier: of a garment; empty: none.
bool AnimatedCharacter::wears(const std::string& identifier) const
{
    const auto isPart = [&](const osg::ref_ptr<osg::Node>& child)
    { return Wardrobe::identifierOf(*child) == identifier; };
    return !identifier.empty() && std::any_of(_children.begin(), _children.end(), isPart);
}

bool AnimatedCharacter::takeOff(const osg::Node* garment)
{
    if (!garment) return false;
    AnimatedCharacter* source = findCharacter(const_cast<osg::Node&>(*garment));
    const std::string identifier =
        source ? _wardrobe->identifierOf(*source, wornMeshes(*source)) : Wardrobe::identifierOf(*garment);
    if (!wears(identifier)) return false;
    for (unsigned int child = getNumChildren(); child-- > 0;)
        if (Wardrobe::identifierOf(*getChild(child)) == identifier) removeChild(child);
    useOutfit(Wardrobe::withoutUnused(_controller->sharedSet(), *this));
    return true;
}

/// Takes a set that the present meshes fit. Clones share the meshes, so their boxes only grow.
void AnimatedCharacter::useOutfit(const std::shared_ptr<const AnimationSet>& set)
{
    if (set != _controller->sharedSet()) *_controller = AnimationController(set, *_controller);
    if (_clipBounds)
    {
        const ClipBoxes boxes = _wardrobe->boxes(meshesBelow(*this), set);
        _clipBounds = boxes.ofClips;
        _mixBounds = boxes.ofMixes;
        growMeshes(boundsOfAllClips());
        _played.clear();
        dirtyBound();
    }
    (void)setPixelError(_pixelError);
}

SkinnedGeometry* AnimatedCharacter::findMesh(const std::string& name) const
{
    return firstMeshNamed(*this, name);
}

Result<void> AnimatedCharacter::setMeshVisible(const std::string& name, bool isVisible)
{
    const Result<std::vector<SkinnedGeometry*>> meshes = meshesNamed(*this, name);
    if (!meshes) return meshes.error();
    if (_properties && !_properties->isBound()) _properties->bind(*this);
    if (_properties) _properties->restoreMasks();
    const std::vector<SkinnedGeometry*> own = meshesNamed(*this, name).value();
    _variantMeshes->setVisible(*this, {own.begin(), own.end()}, isVisible);
    rebindProperties();
    return {};
}

Result<void> AnimatedCharacter::setFileToNode(const osg::Matrixd& fileToNode)
{
    const Result<AffineMatrix> root = toRootMatrix(fileToNode, "the transform from the file's axes", true);
    if (!root) return root.error();
    _axes = std::make_shared<const Axes>(Axes{fileToNode, root.value()});
    if (_clipBounds) setMeshBounds();
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
    if (_properties) showProperties();
    if (!_worldTargets->isEmpty())
        runAfterUpdate(*this,
                       [character = osg::observer_ptr<AnimatedCharacter>(this)]
                       {
                           osg::ref_ptr<AnimatedCharacter> present;
                           if (character.lock(present)) present->takeWorldTargets();
                       });
    if (events.isEmpty()) return;
    runAfterUpdate(*this,
                   [events, character = osg::observer_ptr<AnimatedCharacter>(this)]
                   {
                       events.deliver();
                       osg::ref_ptr<AnimatedCharacter> present;
                       if (character.lock(present)) present->updateBounds();
                   });
}

/// After changes to the meshes with the masks that the application gave them.
void AnimatedCharacter::rebindProperties()
{
    if (!_properties || !_properties->isBound()) return;
    _properties->bind(*this);
    showProperties();
}

void AnimatedCharacter::showProperties()
{
    if (!_properties->isBound()) _properties->bind(*this);
    _properties->apply(getAnimationSet(), _controller->instruction());
}

void AnimatedCharacter::updateBounds()
{
    ControllerDetail::findPlayedClips(*_controller, _playedNow);
    const std::uint64_t constraints = constraintsOf(*_controller);
    if (_playedNow == _played && constraints == _constraints) return;
    std::swap(_played, _playedNow);
    _constraints = constraints;
    dirtyBound();
    if (_mixBounds) growMeshes(boundsOf(_played));
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
    const ClipBoxes boxes(meshesBelow(*this), getAnimationSet());
    _clipBounds = boxes.ofClips;
    _mixBounds = boxes.ofMixes;
    setMeshBounds();
}

osg::BoundingBox AnimatedCharacter::boundsOfAllClips() const
{
    osg::BoundingBox all;
    for (const osg::BoundingBox& box : *_clipBounds)
        all.expandBy(transformed(box, _axes->fileToNode));
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
    return transformed(clipBoundsInFile(clip), _axes->fileToNode);
}

osg::BoundingBox AnimatedCharacter::clipBoundsInFile(int clip) const
{
    const std::size_t index = static_cast<std::size_t>(clip + 1);
    return _clipBounds && index < _clipBounds->size() ? (*_clipBounds)[index] : osg::BoundingBox();
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
    const std::optional<double> time = updateTimeOf(visitor);
    if (time && visitor.validNodeMask(*this)) update(*time);
    osg::MatrixTransform::accept(visitor);
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
        prepareFirstDraw(visitor, {*this, *_controller, _axes->rootMatrix, _pixelError, _isDrawnTogether});
        return;
    }
    const DepthPass pass(*cullVisitor);
    PoseStage::draw(*cullVisitor, {*this, *_controller, _axes->rootMatrix, _pixelError, _isDrawnTogether});
}

osg::BoundingBox AnimatedCharacter::boundsOf(const std::vector<PlayedClip>& played) const
{
    const std::uint64_t constraints = constraintsOf(*_controller);
    const bool isAlone = played.size() == 1 && played.front().part == PlayedClip::Part::Mixed && constraints == 0;
    if (isAlone || !_mixBounds) return getClipBounds(isAlone ? played.front().clip : _controller->clip());
    return transformed(toOsg(_mixBounds->box(played, constraints)), _axes->fileToNode);
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
        if (!dynamic_cast<const SkinnedGeometry*>(child.get())) others.expandBy(bound);
    }
    if (others.valid()) box.expandBy(others);
    return osg::BoundingSphere(transformed(box, getMatrix()));
}

RootMotionCallback::RootMotionCallback(const RootMotionCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop)
{
}

void RootMotionCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    if (auto* character = dynamic_cast<AnimatedCharacter*>(node))
    {
        const osg::Matrixd motion = character->takeRootMotion();
        if (!motion.isIdentity()) character->preMult(motion);
    }
    traverse(node, visitor);
}

AnimatedCharacter* findCharacter(osg::Node& node)
{
    return findBelow<AnimatedCharacter>(node);
}

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    const EntryBoxes boxes = entryBoxesOf(character, character.getAnimationSet());
    CompactedCharacter result;
    result.longestSide = longestSide(character.getAnimationSet(), boxes);
    result.tolerance = fraction * result.longestSide;
    Result<CompactedSet> compacted = compactClips(character.getAnimationSet(), boxes, {result.tolerance});
    if (!compacted) return compacted.error();
    const Result<void> taken = character.setAnimationSet(compacted.value().set);
    if (!taken) return taken.error();
    result.errors = compacted.value().errors;
    return result;
}

} // namespace osgGpuAnimation
