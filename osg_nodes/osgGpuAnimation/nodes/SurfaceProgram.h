// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/SurfaceState.h>

#include <osg/observer_ptr>
#include <osg/Program>
#include <osg/Texture2D>

#include <map>
#include <mutex>

namespace osgGpuAnimation
{

/// An object that all users share, made by the first. It lives as long as some scene has it: OSG releases the GL
/// objects of what is in scenes when a context is closed, and an object that outlives them would keep stale ones.
template <typename Object>
class SharedObject
{
public:
    template <typename Make>
    osg::ref_ptr<Object> get(Make make)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        osg::ref_ptr<Object> object;
        if (_object.lock(object)) return object;
        object = make();
        _object = object.get();
        return object;
    }

private:
    std::mutex _mutex;
    osg::observer_ptr<Object> _object;
};

/// The attribute behind characterProgram(): a program for each SurfaceState there is, made when it is first met. It
/// reads the state each time that a StateSet with it is applied. Every permutation links the shaders, and binds the
/// attributes, of this program; the first shader is skin.glsl.
///
/// It is meant to be set PROTECTED, so that programs that override from above (osgShadow's casting cameras, osgFX)
/// do not draw the bind pose. One that overrides and links skin.glsl itself is given way to.
class SurfaceProgram : public osg::Program
{
public:
    SurfaceProgram() = default;
    /// Shares the shaders; programs are made anew.
    SurfaceProgram(const SurfaceProgram& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);

    /// osg::State's default for the type of attribute: no program.
    osg::Object* cloneType() const override { return new osg::Program; }
    osg::Object* clone(const osg::CopyOp& copyop) const override { return new SurfaceProgram(*this, copyop); }
    bool isSameKindAs(const osg::Object* object) const override
    {
        return dynamic_cast<const SurfaceProgram*>(object) != nullptr;
    }
    const char* libraryName() const override { return "osgGpuAnimation"; }
    const char* className() const override { return "SurfaceProgram"; }

    void apply(osg::State& state) const override;
    void compileGLObjects(osg::State& state) const override;
    void setThreadSafeRefUnref(bool threadSafe) override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

    /// The program for such a state.
    osg::ref_ptr<osg::Program> variant(const SurfaceState& surface) const;

protected:
    ~SurfaceProgram() override = default;

private:
    bool sharesSkin(const osg::Program& other) const;
    const osg::Program* overriding(osg::State& state) const;

    mutable std::mutex _mutex; ///< draw threads of several contexts make variants
    mutable std::map<SurfaceState, osg::ref_ptr<osg::Program>> _variants;
};

/// One white texel, shared by all: for meshes without a texture where another program samples unit 0.
osg::ref_ptr<osg::Texture2D> whiteTexture();

} // namespace osgGpuAnimation
