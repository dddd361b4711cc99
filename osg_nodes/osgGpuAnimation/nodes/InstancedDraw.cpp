// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/InstancedDraw.h>

#include <osg/GLExtensions>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

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
