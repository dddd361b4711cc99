// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Referenced>
#include <osg/State>
#include <osg/StateSet>

#include <array>
#include <map>
#include <mutex>
#include <tuple>

namespace osgGpuAnimation
{

/// The state in which meshes are skinned once for all that draw them: skin.glsl with once.vert, captured by transform
/// feedback, nothing being rasterized. All meshes share one, and it lives as long as any of them: so OSG, which has
/// scenes release their GL objects when a context is closed, has this one do so too.
class SkinOncePass : public osg::Referenced
{
public:
    /// What meshes differ in.
    struct Variant
    {
        int influences; ///< of a vertex, at most
        bool hasMorphs;
        bool hasNormals; ///< they are captured behind the positions

        bool operator<(const Variant& other) const
        {
            return std::tie(influences, hasMorphs, hasNormals) <
                   std::tie(other.influences, other.hasMorphs, other.hasNormals);
        }
    };

    static osg::ref_ptr<SkinOncePass> shared();

    osg::StateSet* state(const Variant& variant);
    /// Whether the program can be linked in the state's context.
    bool works(osg::State& state, const Variant& variant);

    void releaseGLObjects(osg::State* state);
    void resizeGLObjectBuffers(unsigned int maxSize);

private:
    SkinOncePass();

    std::array<osg::ref_ptr<osg::Program>, 2> _programs; ///< without and with normals
    std::mutex _mutex;                                   ///< several contexts' draw threads ask
    std::map<Variant, osg::ref_ptr<osg::StateSet>> _states;
};

} // namespace osgGpuAnimation
