// SPDX-License-Identifier: MIT
#include "Subject.h"

#include "gltf/file/ModelBytes.h"

#include <cmath>
#include <filesystem>

namespace osgGpuAnimation::benchmark
{

namespace
{

std::size_t drivenJoints(const AnimationSet& set, const Clip& clip)
{
    std::size_t count = 0;
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
        if (isDriven(set, clip, joint, &JointTransform::translation) ||
            isDriven(set, clip, joint, &JointTransform::rotation) || isDriven(set, clip, joint, &JointTransform::scale))
            ++count;
    return count;
}

} // namespace

Result<Subject> loadSubject(const std::string& fileName, bool fixedLighting, double compact)
{
    gltf::ImportOptions options;
    options.fixedLighting = fixedLighting;
    options.noKeys = true;
    if (compact > 0.0) options.compact = compact;
    const Result<std::string> bytes = gltf::readModelFile(fileName, options);
    if (!bytes) return bytes.error();
    Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), fileName, options);
    if (!model) return model.error();
    Subject subject{std::filesystem::path(fileName).stem().string(), fileName, std::move(model).value(), 0};
    if (!subject.model.set || subject.set().clips().empty()) return Error{"nothing moves"};
    std::size_t most = 0;
    for (std::size_t clip = 0; clip < subject.set().clips().size(); ++clip)
    {
        const std::size_t driven = drivenJoints(subject.set(), subject.set().clips()[clip]);
        if (driven <= most) continue;
        most = driven;
        subject.clip = clip;
    }
    return subject;
}

bool isDriven(const AnimationSet& set, const Clip& clip, std::size_t joint, glm::vec4 JointTransform::*part)
{
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
        if (glm::vec3 difference(clip.at(keyframe, joint)->*part - set.restPose()[joint].*part);
            difference != glm::vec3(0.0f))
            return true;
    return false;
}

double phaseOf(std::size_t character, double duration)
{
    // Multiples of the golden ratio are evenly distributed for any count.
    return duration * std::fmod(0.618033988749895 * static_cast<double>(character + 1), 1.0);
}

} // namespace osgGpuAnimation::benchmark
