// SPDX-License-Identifier: MIT
#pragma once

#include "ReferenceKit.h"
#include "StagedViewer.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

#include <set>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// Many characters of one subject in a square, as AnimatedCharacter nodes.
struct CharacterScene
{
    CharacterScene(const Subject& subject, std::size_t count);

    void pause();                     ///< all characters
    void setPixelError(float pixels); ///< of all characters
    /// Requires palettes that agree with the CPU twin's after a frame, with its GL state.
    void check(osg::State& state) const;

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<osg::ref_ptr<AnimatedCharacter>> characters;
};

constexpr std::size_t outfitCount = 24;

/// The parts that each of 24 outfits hides: a third of them, at random. Empty: the subject has less than four parts.
std::vector<std::set<std::string>> hiddenParts(const Subject& subject);

/// The same characters, placements and clips in one AnimatedCrowd.
osg::ref_ptr<AnimatedCrowd> makeCrowd(const Subject& subject, std::size_t count);

/// The same characters with osgAnimation.
struct ReferenceScene
{
    ReferenceScene(const Subject& subject, const ReferenceKit& kit, ReferenceMode mode, std::size_t count);

    /// Runs only the update traversal, at that simulation time in seconds.
    void update(double time);
    /// Requires characters that agree with the CPU twin's at that time.
    void check(const Subject& subject, double time);

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<ReferenceCharacter> characters;
};

/// The meshes in bind pose, without skinning.
osg::ref_ptr<osg::Group> makeUnskinnedScene(const Subject& subject, std::size_t count, Shading shading);

constexpr std::size_t columns = 316; ///< of a field, and as many rows
constexpr std::size_t places = columns * columns;
constexpr float fieldPixelError = 0.5f;

/// A field of 99,856 places, on which everybody loops some clip of the file from some time on.
class Field
{
public:
    /// Takes each step-th place from the first on.
    explicit Field(const Subject& subject, std::size_t step = 1, std::size_t first = 0);

    /// Scales the field so that neighbours are 1 unit apart, and moves everyone that far along y.
    void walk(double way);

    AnimatedCrowd& node() const { return *_crowd; }

private:
    struct Member
    {
        std::size_t place;
        AnimatedCrowd::Instance instance;
    };

    double _spacing;
    osg::ref_ptr<AnimatedCrowd> _crowd;
    std::vector<Member> _members;
};

/// From before the field over half of it.
void lookAcross(StagedViewer& viewer, const osg::BoundingSphere& field);

} // namespace osgGpuAnimation::benchmark
