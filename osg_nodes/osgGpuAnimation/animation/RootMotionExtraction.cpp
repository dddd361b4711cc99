// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/RootMotionExtraction.h>

#include <osgGpuAnimation/animation/RootMotionExtractor.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace osgGpuAnimation
{

Result<std::shared_ptr<const AnimationSet>> withRootMotion(const AnimationSet& set, const std::string& joint,
                                                           const RootMotionAxes& axes)
{
    const Result<std::size_t> index = set.skeleton().jointNamed(joint);
    if (!index) return index.error();
    const double length = glm::length(axes.up);
    if (!(length > 0.0) || !std::isfinite(length)) return Error{"an up axis that has no direction"};

    std::vector<Clip> clips;
    for (const Clip& clip : set.clips())
    {
        Result<Clip> stripped = RootMotionExtractor(set.skeleton(), index.value(), axes).extract(clip);
        if (!stripped) return stripped.error();
        clips.push_back(std::move(stripped).value());
    }
    return set.withClips(std::move(clips));
}

} // namespace osgGpuAnimation
