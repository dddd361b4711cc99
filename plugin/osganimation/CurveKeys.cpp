// SPDX-License-Identifier: MIT
#include "osganimation/CurveKeys.h"

#include <algorithm>

namespace osgGpuAnimation::osganimation
{

namespace
{

template <class... Values>
void addTimesOf(const osgAnimation::KeyframeContainer& keys, std::vector<double>& times)
{
    const auto add = [&](const auto* typed)
    {
        for (std::size_t i = 0; typed && i < typed->size(); ++i)
            times.push_back((*typed)[i].getTime());
    };
    (add(dynamic_cast<const osgAnimation::TemplateKeyframeContainer<Values>*>(&keys)), ...);
}

} // namespace

std::vector<double> keyTimesOf(const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels)
{
    std::vector<double> times;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : channels)
    {
        // Without a const KeyframeContainer in osgAnimation.
        osgAnimation::Sampler* const sampler = channel->getSampler();
        if (const osgAnimation::KeyframeContainer* const keys = sampler->getKeyframeContainer())
            addTimesOf<float, double, osg::Vec2, osg::Vec3, osg::Vec4, osg::Quat, osg::Matrixf,
                       osgAnimation::FloatCubicBezier, osgAnimation::DoubleCubicBezier, osgAnimation::Vec2CubicBezier,
                       osgAnimation::Vec3CubicBezier, osgAnimation::Vec4CubicBezier>(*keys, times);
    }
    // Times of a clip are floats.
    for (double& time : times)
        time = static_cast<double>(static_cast<float>(time));
    times.erase(
        std::remove_if(times.begin(), times.end(), [](double time) { return !(time >= 0.0) || !std::isfinite(time); }),
        times.end());
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

} // namespace osgGpuAnimation::osganimation
