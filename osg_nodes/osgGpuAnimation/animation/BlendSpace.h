// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class AnimationSet;

/// A triangle, a segment or a single point of a triangulation.
struct PlaneCell
{
    std::size_t count = 0;               ///< corners: 1 to 3
    std::array<std::size_t, 3> points{}; ///< only the first count are used
};

/// Clips at positions on a line or in a plane: a layer that plays it mixes the clips around its parameter (the two
/// neighbours on a line, the three corners of a triangle in a plane) and keeps them in phase.
///
///     auto gaits = BlendSpace::create(set, {{"Walk", 1.4}, {"Run", 4.0}});
///     layer.play(gaits.value());
///     layer.setParameter(2.2); // metres a second, say
///
/// The weights sum to 1 and are continuous in the parameter. At the position of a clip that clip plays alone, exactly
/// as without a blend space. Outside the convex hull of the positions the nearest point of the hull counts.
///
/// All clips take the same time for a round: the mean of their durations by weight; clips of duration 0 (poses) do not
/// count. They have the same normalized time or, in LoopMode::Loop with sync markers, pass these markers together.
/// It is immutable; the layers of all characters share it.
class BlendSpace
{
public:
    /// A clip and its position. Spaces with one dimension leave y at 0.
    struct Position
    {
        std::string clip; ///< name of a clip of the set
        double x = 0.0;   ///< in the unit of the parameter
        double y = 0.0;   ///< in the unit of the parameter
    };
    /// A Position with its clip resolved.
    struct Point
    {
        std::size_t clip = 0;  ///< index in the set
        glm::dvec2 place{0.0}; ///< in the unit of the parameter
        /// Seconds of the clip, ascending, the last is the first + the duration: the times that all clips pass
        /// together.
        std::vector<double> stops;

        double duration() const { return stops.back() - stops.front(); } ///< seconds
        /// The time of the clip at a phase in [0, 1]; in [stops.front(), stops.back()].
        double timeAt(double phase) const;
        /// The phase, in [0, 1), at a time in [0, duration()].
        double phaseAt(double time) const;
    };
    /// The share of a point.
    struct Weight
    {
        std::size_t point = 0; ///< index in points()
        double weight = 0.0;   ///< in (0, 1]
    };
    /// The points that a parameter mixes.
    struct Mix
    {
        std::size_t count = 0;           ///< 1 to 3
        std::array<Weight, 3> weights{}; ///< ascending by weight; only the first count are used; they sum to 1
    };

    static constexpr std::size_t maxPositions = 256; ///< in one space

    /// Resolves and triangulates (Delaunay) the positions. Positions on a line, in any direction, make a space with one
    /// dimension. syncMarkers: names of markers that each clip (except those of duration 0) has, in the order of a
    /// round; the first marker of a name counts. Empty: clips have equal normalized times.
    /// Errors: no positions or more than maxPositions; no such clip; a coordinate that is not finite or beyond 1e9;
    /// positions that are equal or too close to each other; a clip without one of the markers or with another order.
    static Result<std::shared_ptr<const BlendSpace>> create(const AnimationSet& set,
                                                            const std::vector<Position>& positions,
                                                            const std::vector<std::string>& syncMarkers = {});

    const std::vector<Point>& points() const { return _points; }                 ///< in the order of the positions
    const std::vector<std::string>& syncMarkers() const { return _syncMarkers; } ///< as passed to create()
    /// The clips and weights at a parameter; NaN counts as 0.
    Mix mixAt(const glm::dvec2& parameter) const;
    /// The ground speed of the mix at a parameter, in the model's units a second at speed 1, see measureGroundSpeed().
    /// The mixes at the corners of a cell and halfway between them are measured once; the way of a round is
    /// interpolated. Safe to call from several threads. set: one that it fits.
    double groundSpeedAt(const AnimationSet& set, const glm::dvec2& parameter) const;
    /// True if its clips are clips of the set, with equal durations and markers.
    bool fits(const AnimationSet& set) const;
    /// As create(), with the clips by number, for example of another set. The points need no stops.
    static Result<std::shared_ptr<const BlendSpace>> create(const AnimationSet& set, std::vector<Point> points,
                                                            std::vector<std::string> syncMarkers);

private:
    BlendSpace() = default;

    double wayOf(const AnimationSet& set, std::size_t first, std::size_t second) const;

    std::vector<Point> _points;
    std::vector<std::string> _syncMarkers;
    std::vector<glm::dvec2> _places; ///< of the points
    std::vector<PlaneCell> _cells;
    mutable std::mutex _mutex;
    /// The way of a round on the ground, for the mixes of two points in halves, or of one with itself.
    mutable std::map<std::pair<std::size_t, std::size_t>, double> _ways;
};

/// The speed at which a clip walks on the spot: that of the ground below its feet, in the model's units a second at the
/// clip's own speed. Feet are joints that end a limb, come within a tenth of the skeleton's height of its lowest place
/// and lift again; they are on the ground as findFootContacts() says. 0: no feet, or they stand; the character's own
/// movement within the clip does not count. The set keeps the value, so later calls cost nothing. Safe to call from
/// several threads. clip: below set.clips().size().
double measureGroundSpeed(const AnimationSet& set, std::size_t clip);

} // namespace osgGpuAnimation
