// SPDX-License-Identifier: MIT
#include "osganimation/CurveKeys.h"

#include <algorithm>
#include <tuple>

namespace osgGpuAnimation::osganimation
{

namespace
{

using KeyframeContainers =
    std::tuple<osgAnimation::FloatKeyframeContainer, osgAnimation::DoubleKeyframeContainer,
               osgAnimation::Vec2KeyframeContainer, osgAnimation::Vec3KeyframeContainer,
               osgAnimation::Vec4KeyframeContainer, osgAnimation::QuatKeyframeContainer,
               osgAnimation::MatrixKeyframeContainer, osgAnimation::FloatCubicBezierKeyframeContainer,
               osgAnimation::DoubleCubicBezierKeyframeContainer, osgAnimation::Vec2CubicBezierKeyframeContainer,
               osgAnimation::Vec3CubicBezierKeyframeContainer, osgAnimation::Vec4CubicBezierKeyframeContainer>;

template <class Container>
void addTimes(const osgAnimation::KeyframeContainer& keys, std::vector<double>& times)
{
    const auto* const typed = dynamic_cast<const Container*>(&keys);
    for (std::size_t i = 0; typed && i < typed->size(); ++i)
        times.push_back((*typed)[i].getTime());
}

template <class... Containers>
void addTimesOf(const osgAnimation::KeyframeContainer& keys, std::vector<double>& times, std::tuple<Containers...>*)
{
    (addTimes<Containers>(keys, times), ...);
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
            addTimesOf(*keys, times, static_cast<KeyframeContainers*>(nullptr));
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
