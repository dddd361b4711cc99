// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/studio/Backdrop.h>

#include <osgGpuAnimation/nodes/studio/KeyShadow.h>

#include <osg/ClipPlane>
#include <osg/Depth>
#include <osg/PolygonMode>
#include <osg/Program>
#include <osg/Uniform>

#include <ShaderSources.h>

#include <string>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int cornerLocation = 0;
constexpr unsigned int mapUnit = 0;

osg::ref_ptr<osg::Program> makeProgram()
{
    const std::string version = "#version 140\n";
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgGpuAnimation studio");
    program->addShader(new osg::Shader(osg::Shader::VERTEX, version + shaders::studio_vert));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, version + shaders::color_glsl + shaders::studio_frag));
    program->addBindAttribLocation("corner", cornerLocation);
    return program;
}

/// A function of the place in the picture, both in [-1, 1]: in the middle, a unit to the right, a unit up.
osg::ref_ptr<osg::Uniform> affineUniform(const char* name, const osg::Vec3d& left, const osg::Vec3d& right,
                                         const osg::Vec3d& upperLeft)
{
    osg::ref_ptr<osg::Uniform> uniform = new osg::Uniform(osg::Uniform::FLOAT_VEC3, name, 3);
    const osg::Vec3d across = (right - left) * 0.5, up = (upperLeft - left) * 0.5;
    uniform->setElement(0, osg::Vec3(left + across + up));
    uniform->setElement(1, osg::Vec3(across));
    uniform->setElement(2, osg::Vec3(up));
    return uniform;
}

/// The rays of the picture's corners in the ground's space. toClip: from there.
void addRays(osg::StateSet& state, const osg::Matrixd& toClip)
{
    const osg::Matrixd fromClip = osg::Matrixd::inverse(toClip);
    osg::Vec3d starts[3], directions[3];
    for (int corner = 0; corner < 3; ++corner) // lower left, lower right, upper left
    {
        const double x = corner == 1 ? 1.0 : -1.0, y = corner == 2 ? 1.0 : -1.0;
        starts[corner] = osg::Vec3d(x, y, -1.0) * fromClip;
        directions[corner] = osg::Vec3d(x, y, 1.0) * fromClip - starts[corner];
    }
    const double scale = 1.0 / directions[0].length(); // small numbers: they become floats
    for (osg::Vec3d& direction : directions)
        direction *= scale;
    state.addUniform(affineUniform("rayStarts", starts[0], starts[1], starts[2]));
    state.addUniform(affineUniform("rayDirections", directions[0], directions[1], directions[2]));
    const osg::Vec4 depth(osg::Vec4d(toClip(0, 3), toClip(1, 3), toClip(2, 3), toClip(3, 3)));
    state.addUniform(new osg::Uniform("eyeDepth", depth));
}

/// What the program needs to draw the ground for one camera and frame.
osg::ref_ptr<osg::StateSet> groundState(const osg::Matrixd& studioToClip, const Ground& ground, const KeyShadow& shadow)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    const osg::Matrixd toStudio =
        osg::Matrixd::scale(ground.unit, ground.unit, ground.unit) * osg::Matrixd::translate(ground.middle);
    state->setDefine("STUDIO_GROUND");
    addRays(*state, toStudio * studioToClip);
    state->addUniform(new osg::Uniform("mapFromGround", osg::Matrixf(toStudio * shadow.toMap())));
    state->addUniform(new osg::Uniform("mapSize", osg::Vec3(shadow.getSize() / ground.unit)));
    state->addUniform(new osg::Uniform("modelHeight", static_cast<float>(ground.height / ground.unit)));
    state->addUniform(new osg::Uniform("shade", static_cast<float>(ground.shade)));
    state->setTextureAttribute(mapUnit, &shadow.getMap(), osg::StateAttribute::PROTECTED);
    state->addUniform(new osg::Uniform("shadowMap", static_cast<int>(mapUnit)));
    return state;
}

} // namespace

Backdrop::Backdrop() : _rectangle(new osg::Geometry)
{
    osg::ref_ptr<osg::Vec2Array> corners = new osg::Vec2Array;
    for (const float y : {-1.0f, 1.0f})
        for (const float x : {-1.0f, 1.0f})
            corners->push_back(osg::Vec2(x, y));
    // No vertex array: without bounds, the rectangle has no part in near and far planes.
    _rectangle->setVertexAttribArray(cornerLocation, corners, osg::Array::BIND_PER_VERTEX);
    _rectangle->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    _rectangle->setUseDisplayList(false);
    _rectangle->setUseVertexBufferObjects(true);
    _rectangle->setCullingActive(false);
    constexpr osg::StateAttribute::GLModeValue off = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;
    constexpr osg::StateAttribute::GLModeValue on = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;
    osg::StateSet* state = _rectangle->getOrCreateStateSet();
    state->setAttributeAndModes(makeProgram(), on);
    state->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false), on);
    state->setAttribute(new osg::PolygonMode, osg::StateAttribute::PROTECTED);
    for (const GLenum mode : {GL_CULL_FACE, GL_BLEND, GL_FRAMEBUFFER_SRGB})
        state->setMode(mode, off);
    for (unsigned int plane = 0; plane < 6; ++plane)
        state->setMode(GL_CLIP_PLANE0 + plane, off);
    state->setRenderBinDetails(-1000, "RenderBin", osg::StateSet::PROTECTED_RENDERBIN_DETAILS);
}

void Backdrop::cull(osgUtil::CullVisitor& visitor, const std::optional<Ground>& ground, const KeyShadow& shadow) const
{
    if (ground)
        // A new one for each camera and frame: the draw threads still use that of the frame before.
        visitor.pushStateSet(
            groundState(*visitor.getModelViewMatrix() * *visitor.getProjectionMatrix(), *ground, shadow).get());
    _rectangle->accept(visitor);
    if (ground) visitor.popStateSet();
}

} // namespace osgGpuAnimation
