// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/environment/RadianceCube.h>

#include <osg/TextureCubeMap>

namespace osgGpuAnimation
{

/// A cube map of surroundings as GGX reflects them, for environment.glsl: level 0 is the mirror's, each further level
/// that of a rougher surface, up to roughness 1 in the last. RGBA16F, in glTF's axes.
///
/// The GPU makes the levels when the texture is first applied in a graphics context, from then on it is only bound.
/// That first time, GL is asked for its state, and the state is restored. A context needs OpenGL 3.3; in others, the
/// map is black, and one message reports it.
class PrefilteredMap : public osg::TextureCubeMap
{
public:
    static constexpr int levels = 6; ///< of 256 to 8 pixels; level i has the roughness i / (levels - 1)

    explicit PrefilteredMap(const RadianceCube& radiance);

    void apply(osg::State& state) const override;

    const RadianceCube& getRadiance() const { return *_radiance; } ///< what it is made of

protected:
    ~PrefilteredMap() override = default;

private:
    osg::ref_ptr<const RadianceCube> _radiance; ///< kept for further contexts
};

} // namespace osgGpuAnimation
