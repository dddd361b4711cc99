// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/animation/ClipBuilder.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>
#include <osgGpuAnimation/nodes/frame/CullScopes.h>
#include <osgGpuAnimation/nodes/frame/PoseStage.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>
#include <osgGpuAnimation/nodes/mesh/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/OsgMatrix.h>
#include <osgGpuAnimation/nodes/picking/PosedMesh.h>

#include <osg/NodeVisitor>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

namespace
{

std::shared_ptr<const AnimationSet> emptySet()
{
    static const std::shared_ptr<const AnimationSet> set =
        AnimationSet::create({Skeleton::create({}).value(), {}, {}, {}, {}}).value();
    return set;
}

osg::BoundingBox toOsg(const Box& box)
{
    if (box.empty()) return {};
    return {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
}

} // namespace

AnimatedCharacter::AnimatedCharacter() : AnimatedCharacter(emptySet()) {}

AnimatedCharacter::AnimatedCharacter(std::shared_ptr<const AnimationSet> set)
    : _controller(std::make_unique<AnimationController>(std::move(set)))
{
    // Not static: the Optimizer must flatten neither this transform nor those above into the bind pose.
    setDataVariance(osg::Object::DYNAMIC);
    setUpdateCallback(new AnimationUpdateCallback);
}

AnimatedCharacter::AnimatedCharacter(const AnimatedCharacter& other, const osg::CopyOp& copyop)
    : osg::MatrixTransform(other, copyop), _controller(std::make_unique<AnimationController>(*other._controller)),
      _clipBounds(other._clipBounds), _mixBounds(other._mixBounds), _updateTime(other._updateTime),
      _isDrawnTogether(other._isDrawnTogether), _pixelError(other._pixelError)
{
    // osg::Node copies its other callbacks, but not these.
    setEventCallback(copyop(other.getEventCallback()));
}

AnimatedCharacter::~AnimatedCharacter() = default;

Result<bool> AnimatedCharacter::setAnimationSet(std::shared_ptr<const AnimationSet> newSet)
{
    const bool isFirst = getAnimationSet().paletteSize() == 0;
    if (!newSet || (!isFirst && newSet->paletteSize() != getAnimationSet().paletteSize()))
        return Error{"a set of " + std::to_string(newSet ? newSet->paletteSize() : 0) +
                     " palette entries for the meshes of one of " + std::to_string(getAnimationSet().paletteSize())};
    *_controller = AnimationController(std::move(newSet), *_controller);
    if (_clipBounds) computeClipBounds();
    // The clips that levels of detail are made by are others.
    SkinnedGeometryVisitor forget([](SkinnedGeometry& geometry) { geometry.forgetLodLevels(); });
    accept(forget);
    return setPixelError(_pixelError);
}

Result<bool> AnimatedCharacter::setPixelError(float pixels)
{
    const Result<bool> prepared = LodRange::prepare(pixels, *this, getAnimationSet());
    if (prepared) _pixelError = pixels;
    return prepared;
}

Result<osg::Matrixd> AnimatedCharacter::jointToModel(std::size_t joint) const
{
    const std::size_t count = getAnimationSet().skeleton().jointCount();
    if (joint >= count) return Error{"there is no joint " + std::to_string(joint) + " among " + std::to_string(count)};
    return toOsg(Pose::jointToModel(getAnimationSet(), _controller->instruction(), joint));
}

Result<osg::Matrixd> AnimatedCharacter::jointToModel(const std::string& joint) const
{
    const Result<std::size_t> index = getAnimationSet().skeleton().jointNamed(joint);
    if (!index) return index.error();
    return jointToModel(index.value());
}

void AnimatedCharacter::update(double simulationTime)
{
    if (_updateTime && simulationTime != *_updateTime) _controller->advance(simulationTime - *_updateTime);
    _updateTime = simulationTime;
    findPlayedClips(*_controller, _playedNow);
    if (_playedNow == _played) return;
    std::swap(_played, _playedNow);
    dirtyBound();
    if (_mixBounds) growMeshes(boundsOf(_played));
}

// The meshes' own boxes hold each clip. Clones share the meshes, so what a mix needs besides is added for all.
void AnimatedCharacter::growMeshes(const Box& box)
{
    if (box.empty()) return;
    SkinnedGeometryVisitor grow(
        [&](SkinnedGeometry& geometry)
        {
            osg::BoundingBox grown = geometry.getInitialBound();
            grown.expandBy(toOsg(box));
            if (grown != geometry.getInitialBound()) geometry.setInitialBound(grown);
        });
    accept(grow);
}

void AnimatedCharacter::computeClipBounds()
{
    PaletteEntryBounds reach(getAnimationSet());
    SkinnedGeometryVisitor collect([&](SkinnedGeometry& geometry) { reach.add(geometry); });
    accept(collect);
    PaletteEntryBounds withAdded(reach, maxLayers);
    SkinnedGeometryVisitor collectAdded([&](SkinnedGeometry& geometry) { withAdded.add(geometry); });
    if (!getAnimationSet().morphs().empty()) accept(collectAdded);

    auto bounds = std::make_shared<std::vector<Box>>(boundsOfClips(getAnimationSet(), reach.boxes()));
    Box all;
    for (const Box& box : *bounds)
        all.add(box);
    SkinnedGeometryVisitor setBox([&](SkinnedGeometry& geometry) { geometry.setInitialBound(toOsg(all)); });
    accept(setBox);
    _clipBounds = std::move(bounds);
    _mixBounds = std::make_shared<const MixBounds>(getAnimationSet(), reach.boxes(), withAdded.boxes());
    _played.clear();
    dirtyBound();
}

const Box& AnimatedCharacter::getClipBounds(int clip) const
{
    static const Box none;
    const std::size_t index = static_cast<std::size_t>(clip + 1);
    return _clipBounds && index < _clipBounds->size() ? (*_clipBounds)[index] : none;
}

osg::ref_ptr<osg::Geometry> AnimatedCharacter::getPosedMesh(const SkinnedGeometry& mesh) const
{
    std::call_once(_posedMeshesMade, [this] { _posedMeshes = std::make_unique<PosedMeshes>(); });
    return _posedMeshes->of(mesh, _controller->sharedSet(), _controller->instruction(), AffineMatrix());
}

void AnimatedCharacter::acceptPosed(osg::PrimitiveFunctor& functor)
{
    SkinnedGeometryVisitor accepting([&](SkinnedGeometry& geometry) { getPosedMesh(geometry)->accept(functor); });
    accept(accepting);
}

void AnimatedCharacter::traverse(osg::NodeVisitor& visitor)
{
    osgUtil::CullVisitor* cullVisitor = visitor.asCullVisitor();
    if (!cullVisitor || getNumChildren() == 0 || getAnimationSet().paletteSize() == 0)
    {
        if (!keepFlattenedPlace(*this, visitor)) osg::MatrixTransform::traverse(visitor);
        return;
    }
    const DepthPass pass(*cullVisitor);
    PoseStage::draw(*cullVisitor, {*this, *_controller, _pixelError, _isDrawnTogether});
}

Box AnimatedCharacter::boundsOf(const std::vector<PlayedClip>& played) const
{
    const bool isAlone = played.size() == 1 && played.front().part == PlayedClip::Part::Mixed;
    if (isAlone || !_mixBounds) return getClipBounds(isAlone ? played.front().clip : _controller->clip());
    return _mixBounds->box(played);
}

Box AnimatedCharacter::getCurrentBounds() const
{
    std::vector<PlayedClip> played;
    findPlayedClips(*_controller, played);
    return boundsOf(played);
}

osg::BoundingSphere AnimatedCharacter::computeBound() const
{
    osg::BoundingBox box = toOsg(getCurrentBounds());
    if (!box.valid()) return osg::MatrixTransform::computeBound();
    osg::BoundingSphere others;
    for (const osg::ref_ptr<osg::Node>& child : _children)
    {
        // Meshes are asked for theirs, too: cameras that cull at once must find all bounds computed.
        const osg::BoundingSphere& bound = child->getBound();
        if (!dynamic_cast<const SkinnedGeometry*>(child.get())) others.expandBy(bound);
    }
    if (others.valid()) box.expandBy(others);
    osg::BoundingBox placed;
    for (unsigned int corner = 0; corner < 8; ++corner)
        placed.expandBy(box.corner(corner) * getMatrix());
    return osg::BoundingSphere(placed);
}

AnimatedCharacter* findCharacter(osg::Node& node)
{
    class Finder : public osg::NodeVisitor
    {
    public:
        Finder() : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::MatrixTransform& transform) override
        {
            if (!found) found = dynamic_cast<AnimatedCharacter*>(&transform);
            if (!found) traverse(transform);
        }
        AnimatedCharacter* found = nullptr;
    };
    Finder finder;
    node.accept(finder);
    return finder.found;
}

namespace
{

EntryBoxes entryBoxesOf(AnimatedCharacter& character)
{
    PaletteEntryBounds reach(character.getAnimationSet());
    SkinnedGeometryVisitor collect([&](SkinnedGeometry& mesh) { reach.add(mesh); });
    character.accept(collect);
    return reach.boxes();
}

} // namespace

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    const EntryBoxes boxes = entryBoxesOf(character);
    CompactedCharacter result;
    result.longestSide = longestSide(character.getAnimationSet(), boxes);
    result.tolerance = fraction * result.longestSide;
    Result<CompactedSet> compacted = compactClips(character.getAnimationSet(), boxes, {result.tolerance});
    if (!compacted) return compacted.error();
    const Result<bool> taken = character.setAnimationSet(compacted.value().set);
    if (!taken) return taken.error();
    result.errors = compacted.value().errors;
    return result;
}

} // namespace osgGpuAnimation
