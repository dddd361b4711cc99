// SPDX-License-Identifier: MIT
#include "Street.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/OutfitsFile.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t peopleCount = 2000, talkers = 400;
constexpr double halfWidth = 15.0, length = 104.0; ///< of the street, in metres

struct Passer
{
    const char* clip;
    double start; ///< seconds of the clip
    osg::Vec2d place;
    double heading; ///< radians; 0: towards -Y
};

/// Places people who do not touch each other.
class Street
{
public:
    std::vector<Passer> people()
    {
        for (int tries = 0; tries < 4000 && _people.size() < talkers; ++tries)
            addGroup();
        for (int tries = 0; tries < 400000 && _people.size() < peopleCount; ++tries)
            addWalker();
        return _people;
    }

    double between(double low, double high)
    {
        return low + (high - low) * static_cast<double>(_random()) / 4294967296.0;
    }

private:
    bool isFree(const osg::Vec2d& place, double radius) const
    {
        return std::none_of(_people.begin(), _people.end(),
                            [&](const Passer& passer) { return (passer.place - place).length() < radius; });
    }

    /// Two to four who stand in a circle, mostly at the sides of the street.
    void addGroup()
    {
        const double side = between(-1.0, 1.0);
        const osg::Vec2d centre(0.94 * halfWidth * std::copysign(std::sqrt(std::abs(side)), side),
                                between(0.0, length));
        const int count = 2 + static_cast<int>(between(0.0, 3.0));
        const double radius = count == 2 ? 0.5 : count == 3 ? 0.58 : 0.72, first = between(0.0, 2.0 * osg::PI);
        if (!isFree(centre, 1.1 + radius)) return;
        for (int i = 0; i < count; ++i)
        {
            const double angle = first + 2.0 * osg::PI * i / count;
            const char* clip = between(0.0, 1.0) < 0.12 ? "Wave" : "Idle";
            _people.push_back({clip, between(0.0, 5.0), centre + osg::Vec2d(std::cos(angle), std::sin(angle)) * radius,
                               angle - osg::PI_2});
        }
    }

    /// Those on the right come, the others go.
    void addWalker()
    {
        const osg::Vec2d place(between(-halfWidth, halfWidth), between(0.0, length));
        if (!isFree(place, 1.0)) return;
        const bool comes = place.x() + between(-1.5, 1.5) > -2.0;
        _people.push_back({"Walk", between(0.0, 5.0), place, (comes ? 0.0 : osg::PI) + between(-0.16, 0.16)});
    }

    std::mt19937 _random{7};
    std::vector<Passer> _people;
};

Result<void> add(AnimatedCrowd& crowd, const osg::Matrixd& placement, const char* clip, double start,
                 const Outfit* outfit)
{
    AnimationController controller(crowd.getSharedAnimationSet());
    if (const Result<void> playing = controller.play(clip); !playing) return playing;
    controller.seek(start);
    const Result<AnimatedCrowd::Instance> added = crowd.add(placement, controller);
    return added ? crowd.setOutfit(added.value(), outfit) : added.error();
}

} // namespace

Result<osg::ref_ptr<osg::Node>> makeStreet(osg::Node& model, const std::string& outfits)
{
    const AnimatedCharacter* person = findCharacter(model);
    if (!person) return Error{"the model has no animated character"};
    const Result<std::vector<OutfitShare>> shares = readOutfitsFile(outfits);
    if (!shares) return shares.error();
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*person);
    double all = 0.0;
    for (const OutfitShare& each : shares.value())
    {
        if (const Result<void> added = crowd->getOutfits().add(each.outfit); !added) return added.error();
        all += each.share;
    }
    Street street;
    for (const Passer& passer : street.people())
    {
        double place = street.between(0.0, all);
        auto worn = shares.value().begin();
        while (std::next(worn) != shares.value().end() && (place -= worn->share) >= 0.0)
            ++worn;
        const osg::Matrixd placement = osg::Matrixd::scale(worn->size) *
                                       osg::Matrixd::rotate(passer.heading, osg::Vec3d(0, 0, 1)) *
                                       osg::Matrixd::translate(osg::Vec3d(passer.place, 0.0));
        if (const Result<void> added = add(*crowd, placement, passer.clip, passer.start, worn->outfit); !added)
            return added.error();
    }
    return osg::ref_ptr<osg::Node>(crowd);
}

Result<std::vector<osg::ref_ptr<osg::Node>>> makeOutfitRows(osg::Node& model, const std::string& outfits)
{
    constexpr std::size_t inARow = 8;
    constexpr double gap = 1.28; // metres
    const AnimatedCharacter* person = findCharacter(model);
    if (!person) return Error{"the model has no animated character"};
    const Result<std::vector<OutfitShare>> shares = readOutfitsFile(outfits);
    if (!shares) return shares.error();
    std::vector<osg::ref_ptr<osg::Node>> rows;
    osg::ref_ptr<AnimatedCrowd> row;
    for (std::size_t i = 0; i < shares.value().size(); ++i)
    {
        if (i % inARow == 0) rows.emplace_back(row = new AnimatedCrowd(*person));
        Outfit* const outfit = shares.value()[i].outfit;
        if (const Result<void> known = row->getOutfits().add(outfit); !known) return known.error();
        const double x = gap * (static_cast<double>(i % inARow) - 0.5 * (inARow - 1));
        const osg::Matrixd placement =
            osg::Matrixd::rotate(osg::DegreesToRadians(30.0), osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(x, 0, 0);
        const double start = 0.23 * static_cast<double>(i);
        if (const Result<void> added = add(*row, placement, "Walk", start, outfit); !added) return added.error();
    }
    return rows;
}

} // namespace osgGpuAnimation
