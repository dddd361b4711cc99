// SPDX-License-Identifier: MIT
#include "crowd/CrowdGrid.h"

#include "gltf/file/ProgressLine.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/detail/StillParts.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>

#include <algorithm>
#include <random>

namespace osgGpuAnimation::crowd
{

namespace
{

/// The gap between neighbours, as a fraction of the larger side.
constexpr double gap = 0.2;

Result<std::size_t> findClip(const AnimationSet& set, const std::string& nameOrNumber)
{
    const Result<std::size_t> named = set.clipNamed(nameOrNumber);
    if (named) return named;
    const std::optional<std::size_t> number = gltf::parsedNumber<std::size_t>(nameOrNumber);
    return number ? set.clipAt(*number) : named;
}

Result<std::vector<std::size_t>> findClips(const AnimationSet& set, const std::vector<std::string>& wanted)
{
    std::vector<std::size_t> clips;
    for (const std::string& name : wanted)
    {
        const Result<std::size_t> clip = findClip(set, name);
        if (!clip) return clip.error();
        clips.push_back(clip.value());
    }
    if (wanted.empty())
        for (std::size_t clip = 0; clip < set.clips().size(); ++clip)
            clips.push_back(clip);
    return clips;
}

/// The larger horizontal side of the clips' boxes under the character's placement; 1 if the boxes are empty.
double widthOf(const AnimatedCharacter& character, const osg::Matrixd& placement, const std::vector<std::size_t>& clips,
               bool isYUp)
{
    osg::BoundingBoxd placed;
    const auto add = [&](int clip)
    {
        const osg::BoundingBox box = character.getClipBounds(clip);
        for (unsigned int i = 0; i < 8 && box.valid(); ++i)
            placed.expandBy(osg::Vec3d(box.corner(i)) * placement);
    };
    if (clips.empty()) add(-1);
    for (const std::size_t clip : clips)
        add(static_cast<int>(clip));
    if (!placed.valid()) return 1.0;
    const osg::Vec3d size = placed._max - placed._min;
    const double width = std::max(size.x(), isYUp ? size.z() : size.y());
    return width > 0.0 ? width : 1.0;
}

/// True if the model draws meshes that belong to no character and are no still parts of this one.
bool hasOtherMeshes(osg::Node& model, const AnimatedCharacter& character)
{
    const osg::Group* const still = StillParts::of(character);
    const auto isPart = [&](const osg::Node& node)
    { return &node == still || dynamic_cast<const AnimatedCharacter*>(&node) != nullptr; };
    return visitUntil(model, [&](osg::Node& node) { return node.asGeometry() && !findAbove(node, isPart); });
}

/// Random in [0, 1), the same with every standard library (std::uniform_real_distribution is not).
double share(std::mt19937& random)
{
    return static_cast<double>(random()) / 4294967296.0;
}

AnimationController randomController(const AnimatedCrowd& crowd, const std::vector<std::size_t>& clips,
                                     std::mt19937& random)
{
    AnimationController controller(crowd.getSharedAnimationSet());
    if (clips.empty()) return controller;
    const auto choice = static_cast<std::size_t>(share(random) * static_cast<double>(clips.size()));
    if (controller.play(clips[choice])) controller.seek(share(random) * controller.duration());
    return controller;
}

} // namespace

Result<osg::ref_ptr<AnimatedCrowd>> makeCrowd(osg::Node& model, const CrowdOptions& options)
{
    const AnimatedCharacter* character = findCharacter(model);
    if (!character) return Error{"the model has no animated character"};
    const Result<std::vector<std::size_t>> clips = findClips(character->getAnimationSet(), options.clips);
    if (!clips) return clips.error();

    const std::vector<MorphWeights>& morphs = character->getAnimationSet().morphs();
    if (std::any_of(morphs.begin(), morphs.end(), [](const MorphWeights& morph) { return morph.isProperty(); }))
        OSG_WARN << "osgGpuAnimation: \"" << character->getName()
                 << "\" has animated materials, lights or visibility; a crowd shows them at rest" << std::endl;
    if (hasOtherMeshes(model, *character))
        OSG_WARN << "osgGpuAnimation: \"" << character->getName() << "\": meshes that are no part of it are left out"
                 << std::endl;
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const osg::Matrixd placement = character->getWorldMatrices().front();
    const double spacing =
        options.spacing.value_or((1.0 + gap) * widthOf(*character, placement, clips.value(), options.isYUp));
    if (const Result<void> taken = crowd->setOrigin(placement.getTrans()); !taken) return taken.error();
    std::mt19937 random(options.seed);
    for (std::size_t place = 0; place < options.columns * options.rows; ++place)
    {
        const auto column = static_cast<double>(place % options.columns);
        const auto row = static_cast<double>(place / options.columns);
        const double x = spacing * (column - 0.5 * static_cast<double>(options.columns - 1));
        const double y = spacing * (row - 0.5 * static_cast<double>(options.rows - 1));
        const osg::Matrixd moved = osg::Matrixd::translate(x, options.isYUp ? 0.0 : y, options.isYUp ? -y : 0.0);
        const Result<AnimatedCrowd::Instance> added =
            crowd->add(placement * moved, randomController(*crowd, clips.value(), random));
        if (!added) return added.error();
    }
    if (options.pixelError)
    {
        const gltf::ProgressLine progress("computing levels of detail");
        if (const Result<void> taken = crowd->getMeshes().setPixelError(*options.pixelError); !taken)
            return taken.error();
    }
    crowd->addEventCallback(new PoseStatistics);
    return crowd;
}

} // namespace osgGpuAnimation::crowd
