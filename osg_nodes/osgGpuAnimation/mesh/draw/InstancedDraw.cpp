// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/draw/InstancedDraw.h>

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>

#include <layout.glsl>

#include <osg/ContextData>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/Program>

#include <algorithm>
#include <atomic>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

/// OSG confuses a new array with a deleted one at the same address.
void forgetArrays(osg::VertexArrayState& arrays)
{
    for (osg::VertexArrayState::ArrayDispatch* array : arrays._activeDispatchers)
    {
        array->array = nullptr;
        array->modifiedCount = ~0u;
    }
}

constexpr unsigned int attributeLocations[] = {POSE_INSTANCE_ROW_0_LOCATION, POSE_INSTANCE_ROW_1_LOCATION,
                                               POSE_INSTANCE_ROW_2_LOCATION, POSE_INSTANCE_POSE_LOCATION};

std::size_t poseOf(const InstanceTransform& placement)
{
    return static_cast<std::size_t>(placement.pose);
}

/// GL_NONE: an indirect kind.
GLenum indexType(const osg::DrawElements& elements)
{
    switch (elements.getType())
    {
    case osg::PrimitiveSet::DrawElementsUBytePrimitiveType:
        return GL_UNSIGNED_BYTE;
    case osg::PrimitiveSet::DrawElementsUShortPrimitiveType:
        return GL_UNSIGNED_SHORT;
    case osg::PrimitiveSet::DrawElementsUIntPrimitiveType:
        return GL_UNSIGNED_INT;
    default:
        return GL_NONE;
    }
}

void drawElements(osg::State& state, const osg::DrawElements& elements, int count, bool usesBuffers)
{
    const GLvoid* indices = elements.getDataPointer();
    osg::GLBufferObject* buffer = usesBuffers ? elements.getOrCreateGLBufferObject(state.getContextID()) : nullptr;
    if (buffer)
    {
        state.getCurrentVertexArrayState()->bindElementBufferObject(buffer);
        indices = reinterpret_cast<const GLvoid*>(buffer->getOffset(elements.getBufferIndex()));
    }
    else
        state.getCurrentVertexArrayState()->unbindElementBufferObject();
    state.get<osg::GLExtensions>()->glDrawElementsInstanced(
        elements.getMode(), static_cast<GLsizei>(elements.getNumIndices()), indexType(elements), indices, count);
}

} // namespace

MeshVertexArrays::MeshVertexArrays(osg::State& state)
    : _state(state), _isContextsOwn(state.getCurrentVertexArrayState()->getVertexArrayObject() == 0 ||
                                    state.getCurrentVertexArrayState()->_state != &state)
{
    if (!_isContextsOwn) return;
    // A later context with the same number finds the object of the first.
    state.getCurrentVertexArrayState()->_vertexArrayObject = 0;
    _state.unbindVertexArrayObject();
    _state.setCurrentToGlobalVertexArrayState();
    forgetArrays(*_state.getCurrentVertexArrayState());
}

MeshVertexArrays::~MeshVertexArrays()
{
    // GL's array buffer is no part of a vertex array object: the next geometry with client arrays would read from it.
    _state.getCurrentVertexArrayState()->unbindVertexBufferObject();
    if (_isContextsOwn) _state.getCurrentVertexArrayState()->unbindElementBufferObject();
    // Another context may write the palette next; FeedbackScope unbinds it in its own context alone.
    if (isNumberShared(_state)) bindBufferTexture(_state, POSE_PALETTE_UNIT, 0);
    // A vertex array that stays bound would lose its element buffer when OSG compiles objects between frames.
    _state.unbindVertexArrayObject();
}

bool MeshVertexArrays::isNumberShared(const osg::State& state)
{
    const osg::ContextData* data = osg::getContextData(state.getContextID());
    return data && data->getNumContexts() > 1;
}

void MeshVertexArrays::removeObject(osg::VertexArrayState& arrays)
{
    arrays.deleteVertexArrayObject();
    arrays._vertexArrayObject = 0; // OSG does not reset it
}

void bindPalette(osg::State& state, const PalettePlace& place, int influences, int rigidEntry)
{
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return;
    static const unsigned int paletteName = osg::Uniform::getNameID("posePalette");
    static const unsigned int strideName = osg::Uniform::getNameID("poseStride");
    static const unsigned int instanceName = osg::Uniform::getNameID("poseInstance");
    static const unsigned int influencesName = osg::Uniform::getNameID("poseInfluences");
    static const unsigned int tintsName = osg::Uniform::getNameID("poseTints");
    static const unsigned int tintedName = osg::Uniform::getNameID("poseTinted");
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    const auto set = [&](unsigned int name, int value)
    {
        if (const GLint location = program->getUniformLocation(name); location >= 0) gl->glUniform1i(location, value);
    };
    bindBufferTexture(state, POSE_PALETTE_UNIT, place.texture);
    set(paletteName, POSE_PALETTE_UNIT);
    set(strideName, place.stride);
    set(instanceName, place.instance);
    set(influencesName, influences);
    if (rigidEntry >= 0)
    {
        gl->glVertexAttrib4f(POSE_ENTRIES_0_LOCATION, static_cast<GLfloat>(rigidEntry), 0, 0, 0);
        gl->glVertexAttrib4f(POSE_WEIGHTS_0_LOCATION, 1, 0, 0, 0);
    }
    set(tintsName, POSE_TINT_UNIT);
    set(tintedName, place.tints != 0 ? 1 : 0);
    if (place.tints != 0) bindBufferTexture(state, POSE_TINT_UNIT, place.tints);
}

void setOutset(osg::State& state, float outset)
{
    static const unsigned int name = osg::Uniform::getNameID("poseOutset");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    const GLint location = program ? program->getUniformLocation(name) : -1;
    if (location >= 0) state.get<osg::GLExtensions>()->glUniform1f(location, outset);
}

InstanceRuns::InstanceRuns(osg::State& state, const PosePipeline& pipeline, const PaletteBinding& binding)
    : _state(state), _pipeline(pipeline), _binding(binding)
{
    static const unsigned int paletteName = osg::Uniform::getNameID("posePalette");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    // A program of the kit's that does not link leaves none, and OSG says why: then nothing is drawn.
    _isDrawn = program || state.getLastAppliedAttribute(osg::StateAttribute::PROGRAM);
    _isSkinned = !_isDrawn || (program && program->getUniformLocation(paletteName) >= 0);
    if (binding.getPlaced()) findPlaced();
    if (!_isSkinned) _view = state.getModelViewMatrix();
    if (!binding.isInstanced()) return;
    _areAttributes = program && program->getAttribLocation("poseInstancePose") == POSE_INSTANCE_POSE_LOCATION;
    _transforms = &InstanceTransformBuffers::of(state).joined(binding.getInstanceLists(), _areAttributes);
}

InstanceRuns::~InstanceRuns()
{
    if (_areAttributes)
    {
        const osg::GLExtensions& gl = *_state.get<osg::GLExtensions>();
        for (const unsigned int location : attributeLocations)
        {
            gl.glDisableVertexAttribArray(location);
            gl.glVertexAttribDivisor(location, 0);
        }
    }
    else if (!_isSkinned || _transforms)
    {
        _state.applyModelViewMatrix(new osg::RefMatrix(_view));
        _state.applyModelViewAndProjectionUniformsIfRequired();
    }
}

/// Leaves the run without a palette if a buffer texture of the context cannot hold the placements or the poses.
void InstanceRuns::findPlaced()
{
    const std::shared_ptr<const PlacedInstances>& placed = _binding.getPlaced();
    const PalettePlace palette = _pipeline.place(*_binding.getAnimationSet(), _binding.getSlot(), 0);
    if (palette.texture == 0) return;
    if (palette.chunkEnd >= placed->poseCount)
        _textures = PlacedInstanceBuffers::of(_state).textures(placed, _pipeline.getMaxTexels());
    if (_textures.drawn == 0)
    {
        static std::atomic<bool> isReported{false};
        if (isReported.exchange(true)) return;
        OSG_WARN << "osgGpuAnimation: the buffer textures of this context hold " << _pipeline.getMaxTexels()
                 << " texels, fewer than a crowd needs that shares poses; it is drawn from the next frame on\n";
        return;
    }
    _placed = {palette, _binding.getInstanceCount()};
    _placed.place.instance = static_cast<int>(_binding.getInstance());
    if (_textures.placements != 0) _placed.place.tints = _textures.tints;
}

InstanceRuns::Run InstanceRuns::at(std::size_t first) const
{
    if (!_isDrawn) return {};
    Run run = _binding.getPlaced() ? _placed : _transforms ? runOfTransforms(first) : runOfBatch(first);
    if (!_isSkinned) run.count = std::min<std::size_t>(run.count, 1);
    return run;
}

InstanceRuns::Run InstanceRuns::runOfBatch(std::size_t first) const
{
    const std::size_t instance = _binding.getInstance() + first;
    const PalettePlace place = _pipeline.place(*_binding.getAnimationSet(), _binding.getSlot(), instance);
    if (place.texture == 0 || place.chunkEnd <= instance) return {};
    return {place, std::min(_binding.getInstanceCount() - first, place.chunkEnd - instance)};
}

InstanceRuns::Run InstanceRuns::runOfTransforms(std::size_t first) const
{
    const std::vector<InstanceTransform>& placements = _transforms->transforms;
    Run run{_pipeline.place(*_binding.getAnimationSet(), _binding.getSlot(), poseOf(placements[first])), 1};
    if (!_areAttributes || run.place.texture == 0) return run;
    const auto isInChunk = [&](std::size_t pose) { return pose >= run.place.chunkBegin && pose < run.place.chunkEnd; };
    while (first + run.count < placements.size() && isInChunk(poseOf(placements[first + run.count])))
        ++run.count;
    run.place.instance = -static_cast<int>(run.place.chunkBegin);
    return run;
}

void InstanceRuns::use(std::size_t first) const
{
    if (!_isSkinned) return usePiece(first);
    if (_binding.getPlaced()) usePlaced();
    if (_transforms) useTransforms(first);
}

void InstanceRuns::usePlaced() const
{
    const osg::Program::PerContextProgram* program = _state.getLastAppliedProgramObject();
    if (!program) return;
    static const unsigned int drawnName = osg::Uniform::getNameID("poseDrawn");
    static const unsigned int placementsName = osg::Uniform::getNameID("posePlacements");
    const auto bind = [&](unsigned int name, int unit, GLuint texture)
    {
        bindBufferTexture(_state, static_cast<unsigned int>(unit), texture);
        const GLint location = program->getUniformLocation(name);
        if (location >= 0) _state.get<osg::GLExtensions>()->glUniform1i(location, unit);
    };
    bind(drawnName, POSE_DRAWN_UNIT, _textures.drawn);
    if (_textures.placements != 0) bind(placementsName, POSE_PLACEMENT_UNIT, _textures.placements);
}

void InstanceRuns::useTransforms(std::size_t first) const
{
    if (!_areAttributes)
    {
        _state.applyModelViewMatrix(new osg::RefMatrix(toOsg(_transforms->transforms[first].toEye)));
        return _state.applyModelViewAndProjectionUniformsIfRequired();
    }
    // The buffer that is bound below is unknown to OSG.
    _state.getCurrentVertexArrayState()->unbindVertexBufferObject();
    std::size_t offset = first * sizeof(InstanceTransform);
    for (const unsigned int location : attributeLocations)
    {
        _transforms->buffer->bindAttributes(location, 1, sizeof(InstanceTransform), offset, 1);
        offset += BufferTexture::texelBytes;
    }
}

void InstanceRuns::usePiece(std::size_t first) const
{
    std::size_t pose = _binding.getInstance() + first;
    osg::Matrixd toEye = _view;
    if (const PlacedInstances* placed = _binding.getPlaced().get())
    {
        const PlacedInstances::Drawn& drawn = placed->drawn[pose];
        constexpr std::size_t blockSize = SharedBlocks<AffineMatrix>::blockSize;
        const std::size_t block = drawn.index() / blockSize;
        if (placed->placements && block < placed->placements->size())
            toEye.preMult(toOsg((*(*placed->placements)[block])[drawn.index() % blockSize]));
        pose = drawn.pose;
    }
    else if (_transforms)
    {
        const InstanceTransform& placement = _transforms->transforms[first];
        toEye = toOsg(placement.toEye);
        pose = poseOf(placement);
    }
    toEye.preMult(toOsg(_pipeline.rootMatrix(*_binding.getAnimationSet(), _binding.getSlot(), pose)));
    toEye.preMult(_meshToRoots);
    _state.applyModelViewMatrix(new osg::RefMatrix(toEye));
    _state.applyModelViewAndProjectionUniformsIfRequired();
}

bool InstanceRuns::isRefusedBy(const osg::Geometry& mesh)
{
    // Contexts may alias numbered attributes with texture coordinates and secondary colours.
    return mesh.getNumTexCoordArrays() > 1 || mesh.getSecondaryColorArray() ||
           std::any_of(std::begin(attributeLocations), std::end(attributeLocations),
                       [&](unsigned int location) { return mesh.getVertexAttribArray(location) != nullptr; });
}

void drawInstanced(osg::State& state, const osg::PrimitiveSet& primitives, int count, bool usesBuffers)
{
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    const GLenum mode = primitives.getMode();
    const osg::DrawElements* elements = primitives.getDrawElements();
    if (elements && indexType(*elements) != GL_NONE)
        drawElements(state, *elements, count, usesBuffers);
    else if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(&primitives))
        gl->glDrawArraysInstanced(mode, arrays->getFirst(), arrays->getCount(), count);
    else if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(&primitives))
    {
        GLint first = lengths->getFirst();
        for (const GLsizei length : *lengths)
        {
            gl->glDrawArraysInstanced(mode, first, length, count);
            first += length;
        }
    }
    else if (const auto* several = dynamic_cast<const osg::MultiDrawArrays*>(&primitives))
    {
        const std::size_t parts = std::min(several->getFirsts().size(), several->getCounts().size());
        for (std::size_t part = 0; part < parts; ++part)
            gl->glDrawArraysInstanced(mode, several->getFirsts()[part], several->getCounts()[part], count);
    }
    else
        primitives.draw(state, usesBuffers);
}

} // namespace osgGpuAnimation
