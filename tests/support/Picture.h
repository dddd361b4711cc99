// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Image>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

/// Keeps the last picture of a camera.
class Picture : public osg::Camera::DrawCallback
{
public:
    Picture() : _image(new osg::Image) {}

    void operator()(osg::RenderInfo& renderInfo) const override
    {
        const osg::Viewport* viewport = renderInfo.getCurrentCamera()->getViewport();
        _image->readPixels(0, 0, static_cast<int>(viewport->width()), static_cast<int>(viewport->height()), GL_RGBA,
                           GL_UNSIGNED_BYTE);
    }

    const osg::Image& image() const { return *_image; }
    osg::ref_ptr<osg::Image> copy() const { return new osg::Image(*_image, osg::CopyOp::DEEP_COPY_ALL); }

    /// The number of pixels that differ from the colour of the lower left corner, the background.
    int pixelsDrawn() const { return pixelsDrawn(*_image); }
    static int pixelsDrawn(const osg::Image& image)
    {
        int count = 0;
        for (int y = 0; y < image.t(); ++y)
            for (int x = 0; x < image.s(); ++x)
                if (image.getColor(x, y) != image.getColor(0, 0)) ++count;
        return count;
    }
    /// The mean colour of these pixels.
    static osg::Vec4 meanColor(const osg::Image& image)
    {
        osg::Vec4 sum;
        for (int y = 0; y < image.t(); ++y)
            for (int x = 0; x < image.s(); ++x)
                if (image.getColor(x, y) != image.getColor(0, 0)) sum += image.getColor(x, y);
        return sum / std::max(static_cast<float>(pixelsDrawn(image)), 1.0f);
    }

    /// The number of pixels of two pictures that differ by more than the tolerance (0 to 1) in any channel.
    static int pixelsDifferent(const osg::Image& a, const osg::Image& b, float tolerance = 0.02f)
    {
        int count = a.s() == b.s() && a.t() == b.t() ? 0 : a.s() * a.t() + 1;
        for (int y = 0; y < a.t() && count <= a.s() * a.t(); ++y)
            for (int x = 0; x < a.s(); ++x)
            {
                const osg::Vec4 d = a.getColor(x, y) - b.getColor(x, y);
                for (int channel = 0; channel < 3; ++channel)
                    if (std::abs(d[channel]) > tolerance)
                    {
                        ++count;
                        break;
                    }
            }
        return count;
    }

    /// The mean of the channels' differences, 0 to 1, over all pixels that differ from the background in either
    /// picture; a's lower left corner is the background.
    static double meanDifference(const osg::Image& a, const osg::Image& b)
    {
        double sum = 0.0, count = 0.0;
        for (int y = 0; y < a.t(); ++y)
            for (int x = 0; x < a.s(); ++x)
            {
                const osg::Vec4 first = a.getColor(x, y), second = b.getColor(x, y), background = a.getColor(0, 0);
                if (first == background && second == background) continue;
                for (int channel = 0; channel < 3; ++channel)
                    sum += std::abs(first[channel] - second[channel]) / 3.0;
                count += 1.0;
            }
        return count > 0.0 ? sum / count : 1.0;
    }

private:
    osg::ref_ptr<osg::Image> _image;
};

} // namespace osgGpuAnimation
