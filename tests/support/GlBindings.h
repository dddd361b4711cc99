// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/State>
#include <osg/TextureBuffer>
#include <osg/VertexArrayState>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Compares what a context has bound with what its osg::State has recorded, for code that binds past osg::State: the
/// next drawable of a host relies on the record. The context must be current; the comparison binds nothing.
class GlBindings
{
public:
    explicit GlBindings(osg::State& state) : _state(state), _gl(*state.get<osg::GLExtensions>())
    {
        osg::setGLExtensionFuncPtr(_getAttribute, "glGetVertexAttribiv");
        osg::setGLExtensionFuncPtr(_getIndexed, "glGetIntegeri_v");
    }

    /// Each difference, "array buffer: 7, recorded 0"; empty: none.
    std::vector<std::string> differences()
    {
        _found.clear();
        compareBuffers();
        compareTextures();
        const osg::Program::PerContextProgram* program = _state.getLastAppliedProgramObject();
        compare("program", integer(GL_CURRENT_PROGRAM), program ? program->getHandle() : 0);
        const GLuint arrayObject = _state.getCurrentVertexArrayObject();
        compare("vertex array object", integer(0x85B5), arrayObject); // GL_VERTEX_ARRAY_BINDING
        osg::VertexArrayState& arrays = *_state.getCurrentVertexArrayState();
        if (arrays.getVertexArrayObject() == arrayObject) compareArrays(arrays);
        return _found;
    }

    /// The framebuffer object that draws go to, which osg::State does not record.
    static GLint drawFramebuffer() { return static_cast<GLint>(integer(GL_DRAW_FRAMEBUFFER_BINDING_EXT)); }

private:
    static GLuint integer(GLenum name)
    {
        GLint value = 0;
        glGetIntegerv(name, &value);
        return static_cast<GLuint>(value);
    }

    static GLuint nameOf(const osg::GLBufferObject* buffer) { return buffer ? buffer->getGLObjectID() : 0; }

    void compare(const std::string& what, GLuint bound, GLuint recorded)
    {
        if (bound != recorded)
            _found.push_back(what + ": " + std::to_string(bound) + ", recorded " + std::to_string(recorded));
    }

    void compareBuffers()
    {
        osg::VertexArrayState& arrays = *_state.getCurrentVertexArrayState();
        compare("array buffer", integer(GL_ARRAY_BUFFER_BINDING_ARB), nameOf(arrays.getCurrentVertexBufferObject()));
        compare("pixel unpack buffer", integer(0x88EF), nameOf(_state.getCurrentPixelBufferObject()));
        compare("copy read buffer", integer(0x8F36), 0);
        compare("copy write buffer", integer(0x8F37), 0);
        constexpr GLenum feedback = 0x8C8F; // GL_TRANSFORM_FEEDBACK_BUFFER_BINDING
        compare("feedback buffer", integer(feedback), 0);
        for (GLuint i = 0; i < 4; ++i)
        {
            GLint buffer = 0;
            _getIndexed(feedback, i, &buffer);
            compare("feedback buffer " + std::to_string(i), static_cast<GLuint>(buffer), 0);
        }
    }

    void compareTextures()
    {
        constexpr std::pair<GLenum, GLenum> bindings[] = {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                                                          {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
                                                          {GL_TEXTURE_BUFFER, 0x8C2C}}; // GL_TEXTURE_BINDING_BUFFER
        const GLuint active = integer(GL_ACTIVE_TEXTURE) - GL_TEXTURE0;
        compare("active texture unit", active, _state.getActiveTextureUnit());
        for (GLuint unit = 0; unit < 32; ++unit)
        {
            const auto* recorded = dynamic_cast<const osg::Texture*>(
                _state.getLastAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE));
            const osg::Texture::TextureObject* object =
                recorded ? recorded->getTextureObject(_state.getContextID()) : nullptr;
            if (!object) continue; // without a record, OSG binds before it draws
            _gl.glActiveTexture(GL_TEXTURE0 + unit);
            for (const auto& [target, query] : bindings)
                if (recorded->getTextureTarget() == target)
                    compare("texture of unit " + std::to_string(unit), integer(query), object->id());
        }
        _gl.glActiveTexture(GL_TEXTURE0 + active);
    }

    void compareArrays(const osg::VertexArrayState& arrays)
    {
        compare("element array buffer", integer(GL_ELEMENT_ARRAY_BUFFER_BINDING_ARB),
                nameOf(const_cast<osg::VertexArrayState&>(arrays).getCurrentElementBufferObject()));
        std::map<GLuint, bool> recorded;
        for (GLuint i = 0; i < arrays._vertexAttribArrays.size(); ++i)
            recorded[i] = isActive(arrays._vertexAttribArrays[i].get());
        if (_state.getUseVertexAttributeAliasing())
        {
            const auto record = [&](const osg::VertexArrayState::ArrayDispatch* array, GLuint alias)
            { recorded[alias] = recorded[alias] || isActive(array); };
            record(arrays._vertexArray.get(), _state.getVertexAlias()._location);
            record(arrays._normalArray.get(), _state.getNormalAlias()._location);
            record(arrays._colorArray.get(), _state.getColorAlias()._location);
            for (GLuint unit = 0; unit < arrays._texCoordArrays.size(); ++unit)
                record(arrays._texCoordArrays[unit].get(), _state.getTexCoordAliasList()[unit]._location);
        }
        else if (integer(0x9126) != 1) // GL_CONTEXT_PROFILE_MASK: the core profile has no legacy arrays
            compareLegacyArrays(arrays);
        for (GLuint location = 0; location < integer(0x8869); ++location) // GL_MAX_VERTEX_ATTRIBS
        {
            const std::string name = "vertex attribute " + std::to_string(location);
            compare(name, attribute(location, 0x8622), recorded[location]); // GL_VERTEX_ATTRIB_ARRAY_ENABLED
            compare(name + "'s divisor", attribute(location, 0x88FE), 0);
        }
    }

    static bool isActive(const osg::VertexArrayState::ArrayDispatch* array) { return array && array->active; }

    void compareLegacyArrays(const osg::VertexArrayState& arrays)
    {
        const auto compareArray = [&](const char* name, GLenum array, const auto& dispatch)
        { compare(name, glIsEnabled(array), isActive(dispatch.get())); };
        compareArray("vertex array", GL_VERTEX_ARRAY, arrays._vertexArray);
        compareArray("normal array", GL_NORMAL_ARRAY, arrays._normalArray);
        compareArray("colour array", GL_COLOR_ARRAY, arrays._colorArray);
        compareArray("second colour array", GL_SECONDARY_COLOR_ARRAY, arrays._secondaryColorArray);
        compareArray("fog coordinate array", GL_FOG_COORDINATE_ARRAY, arrays._fogCoordArray);
        const GLuint active = integer(GL_CLIENT_ACTIVE_TEXTURE) - GL_TEXTURE0;
        for (GLuint unit = 0; unit < arrays._texCoordArrays.size(); ++unit)
        {
            _gl.glClientActiveTexture(GL_TEXTURE0 + unit);
            compareArray("texture coordinate array", GL_TEXTURE_COORD_ARRAY, arrays._texCoordArrays[unit]);
        }
        _gl.glClientActiveTexture(GL_TEXTURE0 + active);
    }

    GLuint attribute(GLuint location, GLenum name) const
    {
        GLint value = 0;
        _getAttribute(location, name, &value);
        return static_cast<GLuint>(value);
    }

    osg::State& _state;
    osg::GLExtensions& _gl;
    void(GL_APIENTRY* _getAttribute)(GLuint, GLenum, GLint*) = nullptr;
    void(GL_APIENTRY* _getIndexed)(GLenum, GLuint, GLint*) = nullptr;
    std::vector<std::string> _found;
};

} // namespace osgGpuAnimation
