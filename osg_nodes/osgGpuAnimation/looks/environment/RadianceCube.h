// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Image>
#include <osg/Referenced>
#include <osg/TextureCubeMap>
#include <osg/Vec3f>

#include <array>
#include <vector>

namespace osgGpuAnimation
{

/// The brightest light of surroundings, for a shadow on level ground.
struct KeyLight
{
    osg::Vec3f towards{0, 1, 0}; ///< unit length, glTF's axes; at least 10 degrees above the horizon
    float share = 0.0f;          ///< of the ground's irradiance, in [0, 1]; 0: the surroundings are even
};

/// The radiance of surroundings, decoded from a picture: six square faces of linear RGB floats, laid out as GL samples
/// a cube map (OpenGL 4.6, table 8.19) in glTF's axes (+Y up). Immutable. Every component is in [0, 65504], the range
/// of half floats: components that are negative or not finite become 0, larger ones 65504.
///
/// Pictures have the pixel formats LUMINANCE, RED, LUMINANCE_ALPHA, RG, RGB, RGBA, BGR or BGRA. Floats and half floats
/// are linear; 8 and 16 bits are sRGB. Alpha is ignored.
class RadianceCube : public osg::Referenced
{
public:
    static constexpr int side = 256; ///< pixels of a face, each way

    /// From an equirectangular picture, twice as wide as high: the first row is the lowest (y = -1), and
    /// u = atan2(z, x) / 2 pi + 1/2. Errors: no pixels, another shape, a format that is not in the list above.
    static Result<osg::ref_ptr<const RadianceCube>> fromPanorama(const osg::Image& panorama);
    /// From the images of a cube map: square, of one size. Errors as above, with the name of the face.
    static Result<osg::ref_ptr<const RadianceCube>> fromFaces(const osg::TextureCubeMap& faces);

    /// The pixels of a face (0 to 5, as of osg::TextureCubeMap), by rows: side * side.
    const std::vector<osg::Vec3f>& face(int number) const { return _faces[static_cast<std::size_t>(number)]; }

    /// The irradiance divided by pi as nine coefficients of 1, y, z, x, xy, yz, 3zz - 1, xz, xx - yy (Ramamoorthi and
    /// Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
    std::array<osg::Vec3f, 9> harmonics() const;

    /// The light that brightens level ground most, see KeyLight.
    KeyLight keyLight() const;

    /// The unit direction of a place on a face. s, t: in [-1, 1]; t grows with the rows.
    static osg::Vec3f direction(int face, float s, float t);

private:
    RadianceCube() = default;
    ~RadianceCube() override = default;

    std::array<std::vector<osg::Vec3f>, 6> _faces;
};

} // namespace osgGpuAnimation
