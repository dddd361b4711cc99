// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/environment/RadianceCube.h>

#include <osg/Image>
#include <osg/Math>
#include <osg/TextureCubeMap>

#include <cmath>

namespace osgGpuAnimation
{

/// The radiance of the studio of environment.glsl. direction: unit length, glTF's axes.
inline osg::Vec3f studioRadiance(const osg::Vec3f& direction)
{
    struct Lobe
    {
        osg::Vec3f towards;
        float sharpness;
        osg::Vec3f color;
    };
    const Lobe lobes[] = {{{0.6f, 1.1f, 0.9f}, 40.0f, {9.0f, 8.6f, 8.0f}},
                          {{-1.0f, 0.35f, 0.5f}, 16.0f, {1.0f, 1.15f, 1.4f}},
                          {{-0.3f, 0.6f, -1.0f}, 60.0f, {7.0f, 7.0f, 7.0f}}};
    const float height = 0.5f + 0.5f * direction.y(), share = height * height * (3.0f - 2.0f * height);
    osg::Vec3f sum = osg::Vec3f(0.22f, 0.21f, 0.20f) * (1.0f - share) + osg::Vec3f(0.62f, 0.66f, 0.72f) * share;
    for (const Lobe& lobe : lobes)
        sum += lobe.color *
               std::exp(lobe.sharpness * (direction * lobe.towards / static_cast<float>(lobe.towards.length()) - 1.0f));
    return sum;
}

/// An equirectangular picture of floats. radiance: osg::Vec3f(const osg::Vec3f& direction).
template <typename Radiance>
osg::ref_ptr<osg::Image> makePanorama(int width, Radiance radiance)
{
    const int height = width / 2;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_FLOAT);
    auto* pixel = reinterpret_cast<osg::Vec3f*>(image->data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            const float latitude = ((static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 0.5f) * osg::PIf;
            const float longitude = ((static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 0.5f) * 2 * osg::PIf;
            *pixel++ = radiance(osg::Vec3f(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                                           std::cos(latitude) * std::sin(longitude)));
        }
    return image;
}

/// The same as six pictures of floats.
template <typename Radiance>
osg::ref_ptr<osg::TextureCubeMap> makeFaces(int side, Radiance radiance)
{
    osg::ref_ptr<osg::TextureCubeMap> faces = new osg::TextureCubeMap;
    for (int face = 0; face < 6; ++face)
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(side, side, 1, GL_RGB, GL_FLOAT);
        auto* pixel = reinterpret_cast<osg::Vec3f*>(image->data());
        const auto place = [side](int at)
        { return (static_cast<float>(at) + 0.5f) * 2.0f / static_cast<float>(side) - 1.0f; };
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                *pixel++ = radiance(RadianceCube::direction(face, place(x), place(y)));
        faces->setImage(static_cast<unsigned int>(face), image);
    }
    return faces;
}

} // namespace osgGpuAnimation
