// SPDX-License-Identifier: MIT
#include "crowd/RandomOutfits.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace osgGpuAnimation::crowd
{

namespace
{

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

} // namespace

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

} // namespace osgGpuAnimation::crowd
