// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/PosedMeshSource.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/shading/Mipmaps.h>
#include <osgGpuAnimation/mesh/draw/InstancedDraw.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MorphDeltas.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/MeshVisits.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/State>

#include <algorithm>
#include <cassert>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

static_assert(PaletteBinding::allTriangles == LodLevels::allTriangles, "one value for all triangles");

constexpr unsigned int entriesLocation(unsigned int influenceSet)
{
    return influenceSet == 0 ? POSE_ENTRIES_0_LOCATION : POSE_ENTRIES_1_LOCATION;
}

constexpr unsigned int weightsLocation(unsigned int influenceSet)
{
    return influenceSet == 0 ? POSE_WEIGHTS_0_LOCATION : POSE_WEIGHTS_1_LOCATION;
}

/// The number of influences per vertex up to the last weight that is not 0.
int influencesUsed(const osg::Vec4Array& weights)
{
    int used = 0;
    for (const osg::Vec4& weight : weights)
        for (int i = used; i < 4; ++i)
            if (weight[i] != 0.0f) used = i + 1;
    return used;
}

osg::ref_ptr<osg::StateSet> makeMeshState(SkinnedGeometry::Colors colors)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setDefine("POSE_SKINNED");
    if (colors != SkinnedGeometry::Colors::White)
        state->setDefine("POSE_COLORED", colors == SkinnedGeometry::Colors::Array ? "1" : "2");
    return state;
}

void reportRestPose(const SkinnedGeometry& mesh)
{
    static std::atomic<bool> isReported{false};
    if (isReported.exchange(true)) return;
    OSG_WARN << "osgGpuAnimation: the program of mesh \"" << mesh.getName()
             << "\" does not skin, so it shows the rest pose; see \"Inside a host\" in osg_nodes/doc/shading.md"
             << std::endl;
}

/// The nearest source of posed meshes on the visitor's path, or null.
const PosedMeshSource* posedMeshSource(const osg::NodeVisitor& visitor)
{
    const osg::NodePath& path = visitor.getNodePath();
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (const auto* source = dynamic_cast<const PosedMeshSource*>(*node)) return source;
    return nullptr;
}

using Deltas = osg::ref_ptr<osg::Vec3Array> MorphTarget::*;

glm::dvec3 morphedVector(const SkinnedGeometry& mesh, const osg::Vec3& bind, std::size_t vertex, Deltas deltas,
                         const std::vector<AffineMatrix>& palette)
{
    const std::vector<MorphTarget>& targets = mesh.getMorphTargets();
    glm::dvec3 sum(bind.x(), bind.y(), bind.z());
    for (std::size_t target = 0; target < targets.size(); ++target)
    {
        const osg::Vec3Array* ofTarget = (targets[target].*deltas).get();
        const std::size_t entry =
            static_cast<std::size_t>(mesh.getMorphEntry()) + target / MorphWeights::weightsPerBlock;
        if (!ofTarget || vertex >= ofTarget->size() || entry >= palette.size()) continue;
        const std::size_t place = target % MorphWeights::weightsPerBlock;
        const double weight = palette[entry].rows[place / 4][static_cast<int>(place % 4)];
        const osg::Vec3& delta = (*ofTarget)[vertex];
        sum += weight * glm::dvec3(delta.x(), delta.y(), delta.z());
    }
    return sum;
}

template <typename Move>
void poseVectors(const SkinnedGeometry& mesh, const osg::Array* bind, Deltas deltas,
                 const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& out, Move move)
{
    out.clear();
    const auto* vectors = dynamic_cast<const osg::Vec3Array*>(bind);
    if (!vectors || vectors->size() != mesh.getVertexCount()) return;
    out.reserve(vectors->size());
    for (std::size_t vertex = 0; vertex < vectors->size(); ++vertex)
    {
        glm::dmat4 bindToPose(0.0);
        mesh.forEachInfluence(vertex,
                              [&](std::size_t entry, float weight)
                              {
                                  if (entry < palette.size()) bindToPose += double(weight) * palette[entry].toColumns();
                              });
        out.push_back(move(bindToPose, morphedVector(mesh, (*vectors)[vertex], vertex, deltas, palette)));
    }
}

/// The palette entry, in the rest pose, that moves most of the mesh.
AffineMatrix restMatrix(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    std::vector<AffineMatrix> jointToModel, palette;
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), jointToModel);
    Pose::palette(set, set.restPose(), jointToModel, palette);
    std::vector<double> shares(palette.size() + 1); // at least one
    for (std::size_t vertex = 0; vertex < mesh.getVertexCount(); ++vertex)
        mesh.forEachInfluence(vertex,
                              [&](std::size_t entry, float weight)
                              {
                                  if (entry < palette.size()) shares[entry] += double(weight);
                              });
    const auto largest = std::max_element(shares.begin(), shares.end());
    const std::size_t entry = static_cast<std::size_t>(largest - shares.begin());
    return entry < palette.size() ? palette[entry] : AffineMatrix();
}

} // namespace

SkinnedGeometry::SkinnedGeometry() : _morphDeltas(std::make_unique<MorphDeltas>()), _lod(std::make_unique<MeshLod>())
{
    setUseDisplayList(false);
    setUseVertexBufferObjects(true);
    // Not only for speed: without its own vertex array object a geometry shares OSG's record of bound arrays, which
    // compares addresses and misses a new array at the address of a deleted one.
    setUseVertexArrayObject(true);
}

SkinnedGeometry::SkinnedGeometry(const SkinnedGeometry& other, const osg::CopyOp& copyop)
    : osg::Geometry(other, copyop), _influences(other._influences), _rigidEntry(other._rigidEntry),
      _morphTargets(other._morphTargets), _morphDeltas(std::make_unique<MorphDeltas>(*other._morphDeltas)),
      _morph(other._morph), _morphEntry(other._morphEntry), _lod(std::make_unique<MeshLod>(*other._lod))
{
}

SkinnedGeometry::~SkinnedGeometry() = default;

const osg::TextureBuffer* SkinnedGeometry::getMorphDeltas() const
{
    return _morphDeltas->texture.get();
}

void SkinnedGeometry::accept(osg::NodeVisitor& visitor)
{
    if (!visitor.validNodeMask(*this)) return;
    const bool isIntersection = visitor.getVisitorType() == osg::NodeVisitor::INTERSECTION_VISITOR;
    if (const bool isWriter = isFileWriter(visitor); isWriter || isIntersection)
    {
        if (const PosedMeshSource* source = posedMeshSource(visitor))
            return visitPosed(visitor, *this, *source->getPosedMesh(*this, isWriter));
    }
    osgUtil::CullVisitor* cullVisitor = visitor.asCullVisitor();
    const MeshDrawScope* scope = cullVisitor ? MeshDrawScope::current() : nullptr;
    if (scope && posedMeshSource(visitor) == &scope->source()) return scope->draw(*this);
    std::optional<BoxNearFar> boxes;
    if (cullVisitor) boxes.emplace(*cullVisitor);
    osg::StateSet* state = cullVisitor ? meshState() : nullptr;
    if (state) cullVisitor->pushStateSet(state);
    visitor.pushOntoNodePath(this);
    visitor.apply(static_cast<osg::Drawable&>(*this));
    visitor.popFromNodePath();
    if (state) cullVisitor->popStateSet();
}

osg::StateSet* SkinnedGeometry::meshState() const
{
    static const osg::ref_ptr<osg::StateSet> white = makeMeshState(Colors::White),
                                             ofArray = makeMeshState(Colors::Array),
                                             ofTargets = makeMeshState(Colors::Targets);
    static const std::string influences = "POSE_INFLUENCES";
    const Colors colors = getColors();
    if (colors == Colors::White)
        return _stateset && _stateset->getDefineList().count(influences) ? nullptr : white.get();
    return colors == Colors::Array ? ofArray : ofTargets;
}

osg::BoundingBox SkinnedGeometry::computeBoundingBox() const
{
    return getInitialBound().valid() ? getInitialBound() : osg::Geometry::computeBoundingBox();
}

void SkinnedGeometry::addTo(osgUtil::CullVisitor& visitor, osg::RefMatrix* toEye, float depth)
{
    osg::StateSet* states[] = {meshState(), getStateSet()};
    for (osg::StateSet* state : states)
        if (state) visitor.pushStateSet(state);
    visitor.addDrawableAndDepth(this, toEye, depth);
    for (osg::StateSet* state : states)
        if (state) visitor.popStateSet();
}

void SkinnedGeometry::setInfluences(unsigned int influenceSet, osg::Vec4usArray* entries, osg::Vec4Array* weights)
{
    assert(influenceSet < maxInfluenceSets && "influences come in two sets of four");
    setVertexAttribArray(entriesLocation(influenceSet), entries, osg::Array::BIND_PER_VERTEX);
    setVertexAttribArray(weightsLocation(influenceSet), weights, osg::Array::BIND_PER_VERTEX);
    _influences = 1;
    _rigidEntry = -1;
    for (unsigned int i = 0; i < maxInfluenceSets; ++i)
    {
        const int used = getWeights(i) ? influencesUsed(*getWeights(i)) : 0;
        if (used > 0) _influences = std::max(_influences, static_cast<int>(4 * i) + used);
    }
    _lod->forget();
    dirtyBound();
}

const osg::Vec4usArray* SkinnedGeometry::getEntries(unsigned int influenceSet) const
{
    return dynamic_cast<const osg::Vec4usArray*>(getVertexAttribArray(entriesLocation(influenceSet)));
}

const osg::Vec4Array* SkinnedGeometry::getWeights(unsigned int influenceSet) const
{
    return dynamic_cast<const osg::Vec4Array*>(getVertexAttribArray(weightsLocation(influenceSet)));
}

void SkinnedGeometry::setRigidEntry(unsigned short entry)
{
    for (unsigned int i = 0; i < maxInfluenceSets; ++i)
    {
        setVertexAttribArray(entriesLocation(i), nullptr);
        setVertexAttribArray(weightsLocation(i), nullptr);
    }
    _rigidEntry = entry;
    _influences = 1;
    _lod->forget();
    dirtyBound();
}

void SkinnedGeometry::setMorphTargets(const AnimationSet& set, std::size_t morph, std::vector<MorphTarget> targets)
{
    const int entry = targets.empty() ? -1 : set.entryOfMorph(morph);
    setMorphTargets(static_cast<int>(morph), entry, std::move(targets));
}

void SkinnedGeometry::setMorphTargets(int morph, int entry, std::vector<MorphTarget> targets)
{
    const std::size_t vertexCount = getVertexArray() ? getVertexArray()->getNumElements() : 0;
    _morphTargets = std::move(targets);
    _morph = _morphTargets.empty() ? -1 : morph;
    _morphEntry = _morphTargets.empty() ? -1 : entry;
    _morphDeltas->texture = nullptr; // packed again unless another mesh uses them: the arrays may have changed
    *_morphDeltas = packMorphTargets(_morphTargets, vertexCount);
    if (_morph < 0) _morphDeltas->texture = nullptr;
    _lod->forget();
    dirtyBound();
}

void SkinnedGeometry::computePositions(const std::vector<AffineMatrix>& palette,
                                       std::vector<glm::dvec3>& outPositions) const
{
    poseVectors(*this, getVertexArray(), &MorphTarget::positions, palette, outPositions,
                [](const glm::dmat4& bindToPose, const glm::dvec3& position)
                { return glm::dvec3(bindToPose * glm::dvec4(position, 1.0)); });
}

void SkinnedGeometry::computeNormals(const std::vector<AffineMatrix>& palette,
                                     std::vector<glm::dvec3>& outNormals) const
{
    const auto turned = [](const glm::dmat4& bindToPose, const glm::dvec3& normal)
    {
        const glm::dmat3 linear(bindToPose);
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        return (glm::dot(linear[0], cofactors[0]) < 0.0 ? -1.0 : 1.0) * (cofactors * normal);
    };
    poseVectors(*this, getNormalArray(), &MorphTarget::normals, palette, outNormals, turned);
}

SkinnedGeometry::Colors SkinnedGeometry::getColors() const
{
    const bool areMorphed = _morphDeltas->channels[2] >= 0;
    const osg::Array* array = getColorArray();
    const int binding = array ? array->getBinding() : osg::Array::BIND_UNDEFINED;
    if (binding == osg::Array::BIND_UNDEFINED || binding == osg::Array::BIND_OFF)
        return areMorphed ? Colors::Targets : Colors::White; // OSG ignores arrays with these bindings
    const auto* overall = binding == osg::Array::BIND_OVERALL ? dynamic_cast<const osg::Vec4Array*>(array) : nullptr;
    const bool isWhite = overall && !overall->empty() && overall->front() == osg::Vec4(1, 1, 1, 1);
    return isWhite && !areMorphed ? Colors::White : Colors::Array;
}

void SkinnedGeometry::drawImplementation(osg::RenderInfo& renderInfo) const
{
    osg::State& state = *renderInfo.getState();
    const auto* binding =
        static_cast<const PaletteBinding*>(state.getLastAppliedAttribute(PaletteBinding::bindingType));
    if (!binding || !binding->getAnimationSet()) return;
    const PosePipeline* pipeline = PosePipeline::of(state);
    if (!pipeline) return;
    const MeshVertexArrays scope(state);
    InstanceRuns runs(state, *pipeline, *binding);
    if (!runs.isSkinned())
    {
        reportRestPose(*this);
        runs.moveAsOnePiece(restMatrix(*this, *binding->getAnimationSet()));
    }
    // As osg::Geometry::drawImplementation from here on, except for the primitives, which would draw their own number
    // of instances instead of the frame's.
    InstanceRuns::Run run = runs.at(0);
    if (run.place.texture == 0 || containsDeprecatedData()) return;
    bindPalette(state, run.place); // before the arrays: the upload of morph targets binds a buffer
    const bool usesBuffers = state.useVertexBufferObject(_supportsVertexBufferObjects && _useVertexBufferObjects);
    const bool usesArrayObject = usesBuffers && state.useVertexArrayObject(_useVertexArrayObject);
    osg::VertexArrayState* arrays = state.getCurrentVertexArrayState();
    arrays->setVertexBufferObjectSupported(usesBuffers);
    drawVertexArraysImplementation(renderInfo);
    for (std::size_t first = 0; run.place.texture != 0;)
    {
        runs.use(first);
        drawPrimitives(state, static_cast<int>(run.count), binding->getLevel());
        first += run.count;
        if (first >= binding->getDrawnCount()) break;
        run = runs.at(first);
        bindPalette(state, run.place);
    }
    if (usesBuffers && !usesArrayObject)
    {
        arrays->unbindVertexBufferObject();
        arrays->unbindElementBufferObject();
    }
}

osg::VertexArrayState* SkinnedGeometry::createVertexArrayStateImplementation(osg::RenderInfo& renderInfo) const
{
    osg::VertexArrayState* arrays = osg::Geometry::createVertexArrayStateImplementation(renderInfo);
    if (MeshVertexArrays::isNumberShared(*renderInfo.getState())) MeshVertexArrays::removeObject(*arrays);
    return arrays;
}

void SkinnedGeometry::compileGLObjects(osg::RenderInfo& renderInfo) const
{
    // Without a vertex array object to prepare, the first draw creates the buffers.
    if (MeshVertexArrays::isNumberShared(*renderInfo.getState())) return;
    osg::Geometry::compileGLObjects(renderInfo);
    // OSG unbinds the array buffer and leaves it in the record.
    if (osg::VertexArrayState* arrays = _vertexArrayStateList[renderInfo.getContextID()].get())
        arrays->setCurrentVertexBufferObject(nullptr);
}

void SkinnedGeometry::drawPrimitives(osg::State& state, int count, int level) const
{
    const bool usesBuffers = state.useVertexBufferObject(_supportsVertexBufferObjects && _useVertexBufferObjects);
    std::shared_ptr<const LodLevels> levels;
    if (level != LodLevels::allTriangles) levels = _lod->known(*this);
    for (std::size_t i = 0; i < _primitives.size(); ++i)
    {
        const LodLevels::Step* reduced = levels ? &levels->reduced(i, level) : nullptr;
        setOutset(state, reduced ? reduced->outset : 0.0f);
        if (reduced && reduced->elements)
            drawInstanced(state, *reduced->elements, count, usesBuffers);
        else if (_primitives[i])
            drawInstanced(state, *_primitives[i], count, usesBuffers);
    }
}

void SkinnedGeometry::bindPalette(osg::State& state, const PalettePlace& place) const
{
    osgGpuAnimation::bindPalette(state, place, _influences, _rigidEntry);
    if (bindMorphTargets(state, *_morphDeltas, _morphTargets.size(), _morphEntry)) return;
    if (_isMorphLimitReported.exchange(true)) return;
    OSG_WARN << "osgGpuAnimation: the morph targets of mesh \"" << getName() << "\" need a buffer of "
             << getMorphDeltas()->getImage()->s() << " texels, more than this context takes; it is drawn unmorphed\n";
}

void SkinnedGeometry::releaseGLObjects(osg::State* state) const
{
    osg::Geometry::releaseGLObjects(state);
    generateMipmaps(_stateset);
    if (_morphDeltas->texture) _morphDeltas->texture->releaseGLObjects(state);
    if (const auto levels = _lod->known(*this)) levels->releaseGLObjects(state);
    releaseVariantStates(*this, state);
}

void SkinnedGeometry::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Geometry::resizeGLObjectBuffers(maxSize);
    generateMipmaps(_stateset);
    if (_morphDeltas->texture) _morphDeltas->texture->resizeGLObjectBuffers(maxSize);
    if (const auto levels = _lod->known(*this)) levels->resizeGLObjectBuffers(maxSize);
    resizeVariantStates(*this, maxSize);
}

} // namespace osgGpuAnimation
