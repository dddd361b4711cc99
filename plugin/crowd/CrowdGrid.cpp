// SPDX-License-Identifier: MIT
#include "crowd/CrowdGrid.h"

#include "gltf/file/Report.h"

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/detail/StillParts.h>
#include <osgGpuAnimation/nodes/OutfitsFile.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>

namespace osgGpuAnimation::crowd
{

namespace
{

/// The gap between neighbours, as a fraction of the larger side.
constexpr double gap = 0.2;
constexpr std::size_t randomOutfitCount = 24;

/// Random in [0, 1), the same with every standard library (std::uniform_real_distribution is not).
double randomShare(std::mt19937& random)
{
    return static_cast<double>(random()) / 4294967296.0;
}

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

/// The larger horizontal side of a clip's box under the character's placement; nothing if the box is empty.
std::optional<double> widthOf(const AnimatedCharacter& character, const osg::Matrixd& placement, int clip, bool isYUp)
{
    osg::Matrixd turned = placement; // a box far from the origin would lose digits
    turned.setTrans(osg::Vec3d());
    const osg::BoundingBox box = transformed(character.getClipBounds(clip), turned);
    const osg::Vec3d size = box._max - box._min;
    const double width = std::max(size.x(), isYUp ? size.z() : size.y());
    return width > 0.0 ? std::optional(width) : std::nullopt; // that of an empty box is below 0
}

/// The width that half of the clips do not exceed: a few clips, such as a fall, do not spread out the crowd. 1 if the
/// boxes are empty.
double medianWidth(const AnimatedCharacter& character, const osg::Matrixd& placement,
                   const std::vector<std::size_t>& clips, bool isYUp)
{
    std::vector<double> widths;
    const auto add = [&](int clip)
    {
        if (const std::optional<double> width = widthOf(character, placement, clip, isYUp)) widths.push_back(*width);
    };
    if (clips.empty()) add(-1);
    for (const std::size_t clip : clips)
        add(static_cast<int>(clip));
    if (widths.empty()) return 1.0;
    std::sort(widths.begin(), widths.end());
    return widths[widths.size() / 2];
}

/// True if the model draws meshes that belong to no character and are no still parts of this one.
bool hasOtherMeshes(osg::Node& model, const AnimatedCharacter& character)
{
    const osg::Group* const still = StillParts::of(character);
    const auto isPart = [&](const osg::Node& node)
    { return &node == still || dynamic_cast<const AnimatedCharacter*>(&node) != nullptr; };
    return visitUntil(model, [&](osg::Node& node) { return node.asGeometry() && !findAbove(node, isPart); });
}

AnimationController randomController(const AnimatedCrowd& crowd, const std::vector<std::size_t>& clips,
                                     std::mt19937& random)
{
    AnimationController controller(crowd.getSharedAnimationSet());
    if (clips.empty()) return controller;
    const auto choice = static_cast<std::size_t>(randomShare(random) * static_cast<double>(clips.size()));
    if (controller.play(clips[choice])) controller.seek(randomShare(random) * controller.duration());
    return controller;
}

/// The joint that carries the part: a node with a mesh may be a joint itself, below the hand that holds it.
int carrierOf(const Skeleton& skeleton, int joint, const SkinnedGeometry& part)
{
    if (joint < 0) return joint;
    const Joint& own = skeleton.joint(static_cast<std::size_t>(joint));
    return own.name == part.getName() && own.parent >= 0 ? own.parent : joint;
}

/// True for materials that no tint suits.
bool isOfBodies(const std::string& material)
{
    const std::string name = osgDB::convertToLowerCase(material);
    constexpr const char* words[] = {"skin", "face", "head", "eye", "hair", "teeth", "mouth"};
    return std::any_of(std::begin(words), std::end(words),
                       [&](const char* word) { return name.find(word) != std::string::npos; });
}

/// hue: in [0, 1). saturation, value: in [0, 1].
osg::Vec4 colorOf(float hue, float saturation, float value)
{
    const auto channel = [&](float shift)
    {
        const float place = std::fmod(hue * 6.0f + shift, 6.0f);
        return value - value * saturation * std::clamp(std::min(place, 4.0f - place), 0.0f, 1.0f);
    };
    return {channel(5.0f), channel(3.0f), channel(1.0f), 1.0f};
}

/// Outfits for the option `outfits=random`. Rigid parts on one joint exclude each other: an outfit shows one of them or
/// none. If the crowd has several materials, each gets a tint of a random hue, but those whose names speak of
/// skin, faces, eyes or hair.
std::vector<OutfitShare> randomOutfits(const AnimatedCrowd& crowd, std::uint32_t seed)
{
    const std::vector<PaletteEntry>& palette = crowd.getAnimationSet().palette();
    std::map<int, std::set<std::string>> partsOfJoint;
    std::set<std::string> materials;
    forEachMesh(crowd,
                [&](const SkinnedGeometry& mesh)
                {
                    const auto entry = static_cast<std::size_t>(mesh.getRigidEntry()); // -1 becomes huge
                    if (entry < palette.size() && !mesh.getName().empty())
                        partsOfJoint[carrierOf(crowd.getAnimationSet().skeleton(), palette[entry].joint, mesh)].insert(
                            mesh.getName());
                    if (mesh.getStateSet() && !mesh.getStateSet()->getName().empty())
                        materials.insert(mesh.getStateSet()->getName());
                });
    std::mt19937 random(seed);
    const auto share = [&] { return static_cast<float>(randomShare(random)); };
    std::vector<OutfitShare> outfits;
    for (std::size_t i = 0; i < randomOutfitCount; ++i)
    {
        outfits.push_back({new Outfit});
        outfits.back().outfit->setName("random " + std::to_string(i + 1));
        for (const auto& [joint, parts] : partsOfJoint)
        {
            std::size_t chosen = random() % (parts.size() + 1); // the last: none
            for (const std::string& part : parts)
                outfits.back().outfit->setVisible(part, chosen-- == 0);
        }
        for (const std::string& material : materials)
            if (materials.size() > 1 && !isOfBodies(material))
                outfits.back().outfit->setColor(material,
                                                colorOf(share(), 0.15f + 0.35f * share(), 0.75f + 0.25f * share()));
    }
    return outfits;
}

/// The outfits that the options ask for, which the crowd then has.
Result<std::vector<OutfitShare>> addOutfits(AnimatedCrowd& crowd, const CrowdOptions& options)
{
    if (options.outfits.empty()) return std::vector<OutfitShare>();
    const OutfitReaders readers{[](const std::string& path) { return osgDB::readRefImageFile(path); },
                                [](const std::string& path) { return osgDB::readRefNodeFile(path); }};
    Result<std::vector<OutfitShare>> outfits =
        options.outfits == "random" ? randomOutfits(crowd, options.seed) : readOutfitsFile(options.outfits, readers);
    if (!outfits) return outfits;
    for (const OutfitShare& each : outfits.value())
        if (const Result<void> added = crowd.getOutfits().add(each.outfit); !added)
            return Error{options.outfits + ": " + added.error().message};
    return outfits;
}

/// outfits: not empty.
const OutfitShare& randomOutfit(const std::vector<OutfitShare>& outfits, std::mt19937& random)
{
    double all = 0.0;
    for (const OutfitShare& each : outfits)
        all += each.share;
    double place = randomShare(random) * all;
    for (const OutfitShare& each : outfits)
        if ((place -= each.share) < 0.0) return each;
    return outfits.back();
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
        options.spacing.value_or((1.0 + gap) * medianWidth(*character, placement, clips.value(), options.isYUp));
    if (const Result<void> taken = crowd->setOrigin(placement.getTrans()); !taken) return taken.error();
    const Result<std::vector<OutfitShare>> outfits = addOutfits(*crowd, options);
    if (!outfits) return outfits.error();
    std::mt19937 random(options.seed), ofOutfits(options.seed); // the same clips and times with outfits and without
    for (std::size_t place = 0; place < options.columns * options.rows; ++place)
    {
        const auto column = static_cast<double>(place % options.columns);
        const auto row = static_cast<double>(place / options.columns);
        const double x = spacing * (column - 0.5 * static_cast<double>(options.columns - 1));
        const double y = spacing * (row - 0.5 * static_cast<double>(options.rows - 1));
        const osg::Matrixd moved = osg::Matrixd::translate(x, options.isYUp ? 0.0 : y, options.isYUp ? -y : 0.0);
        const OutfitShare worn = outfits.value().empty() ? OutfitShare() : randomOutfit(outfits.value(), ofOutfits);
        const osg::Matrixd size = osg::Matrixd::scale(worn.size);
        const Result<AnimatedCrowd::Instance> added =
            crowd->add(size * placement * moved, randomController(*crowd, clips.value(), random));
        if (!added) return added.error();
        if (const Result<void> taken = crowd->setOutfit(added.value(), worn.outfit); !taken) return taken.error();
    }
    if (options.pixelError)
        if (const Result<void> taken = crowd->getMeshes().setPixelError(*options.pixelError); !taken)
            return taken.error();
    crowd->addEventCallback(new PoseStatistics);
    return crowd;
}

} // namespace osgGpuAnimation::crowd
