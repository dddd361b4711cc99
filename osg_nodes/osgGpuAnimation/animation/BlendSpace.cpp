// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/BlendSpace.h>

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/playback/FootPaths.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

namespace osgGpuAnimation
{

namespace
{

/// The point of a cell that is nearest to a given one.
struct NearestInCell
{
    std::array<double, 3> weights{}; ///< of the cell's corners, in [0, 1], with the sum 1; 0 beyond its corners
    double squaredDistance = 0.0;
};

using Points = std::vector<glm::dvec2>;
using Corners = std::array<std::size_t, 3>; ///< counterclockwise

/// Twice the area of a triangle of points of a unit square; smaller ones count as points on a line.
constexpr double flatArea = 1e-10;

double cross(const glm::dvec2& a, const glm::dvec2& b)
{
    return a.x * b.y - a.y * b.x;
}

/// Twice the area; positive: counterclockwise.
double signedArea(const Points& points, std::size_t a, std::size_t b, std::size_t c)
{
    return cross(points[b] - points[a], points[c] - points[a]);
}

/// The points in a unit square.
Points inUnitSquare(const Points& points)
{
    glm::dvec2 min = points.front(), max = min;
    for (const glm::dvec2& point : points)
    {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    const double size = std::max({max.x - min.x, max.y - min.y, 1e-300});
    Points scaled;
    for (const glm::dvec2& point : points)
        scaled.push_back((point - min) / size);
    return scaled;
}

/// The order of the points by their first coordinate, then by their second.
std::vector<std::size_t> sweepOrder(const Points& points)
{
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto isBefore = [&](std::size_t a, std::size_t b)
    { return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y); };
    std::sort(order.begin(), order.end(), isBefore);
    return order;
}

/// Triangles of points in an order in which each lies outside the hull of those before it: those before the apex lie on
/// one line. Connects each later point to the edges of the hull that it sees; create() reports a point that
/// sees none.
std::vector<Corners> sweep(const Points& points, const std::vector<std::size_t>& order, std::size_t apex)
{
    std::vector<Corners> triangles;
    std::set<std::pair<std::size_t, std::size_t>> edges; // directed: those of the hull have no opposite
    const auto add = [&](std::size_t from, std::size_t to, std::size_t point)
    {
        triangles.push_back({from, to, point});
        edges.insert({{from, to}, {to, point}, {point, from}});
    };
    const bool isLeft = signedArea(points, order.front(), order[apex - 1], order[apex]) > 0.0;
    for (std::size_t i = 1; i < apex; ++i)
        add(order[isLeft ? i - 1 : i], order[isLeft ? i : i - 1], order[apex]);
    for (std::size_t i = apex + 1; i < order.size(); ++i)
    {
        std::vector<std::pair<std::size_t, std::size_t>> seen;
        for (const auto& [from, to] : edges)
            if (edges.count({to, from}) == 0 && signedArea(points, from, to, order[i]) < -flatArea)
                seen.emplace_back(from, to);
        for (const auto& [from, to] : seen)
            add(to, from, order[i]);
    }
    return triangles;
}

/// True if the point lies inside the circle around the counterclockwise triangle by more than rounding.
bool isInCircle(const Points& points, const Corners& triangle, std::size_t point)
{
    const glm::dvec2 a = points[triangle[0]] - points[point], b = points[triangle[1]] - points[point],
                     c = points[triangle[2]] - points[point];
    return glm::dot(a, a) * cross(b, c) + glm::dot(b, b) * cross(c, a) + glm::dot(c, c) * cross(a, b) > 1e-12;
}

/// Flips the diagonal of two neighbours to the shorter circles. False: no flip was needed anywhere.
bool flipOnce(const Points& points, std::vector<Corners>& triangles)
{
    std::map<std::pair<std::size_t, std::size_t>, std::pair<std::size_t, std::size_t>> owners; // by directed edge
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            owners[{triangles[t][i], triangles[t][(i + 1) % 3]}] = {t, triangles[t][(i + 2) % 3]};
    std::vector<bool> isChanged(triangles.size(), false);
    bool hasFlipped = false;
    for (const auto& [edge, owner] : owners)
    {
        const auto other = owners.find({edge.second, edge.first});
        if (other == owners.end() || isChanged[owner.first] || isChanged[other->second.first]) continue;
        const std::size_t near = owner.second, far = other->second.second;
        const bool isConvex = signedArea(points, near, edge.first, far) > flatArea &&
                              signedArea(points, near, far, edge.second) > flatArea;
        if (!isConvex || !isInCircle(points, {edge.first, edge.second, near}, far)) continue;
        triangles[owner.first] = {near, edge.first, far};
        triangles[other->second.first] = {near, far, edge.second};
        isChanged[owner.first] = isChanged[other->second.first] = hasFlipped = true;
    }
    return hasFlipped;
}

std::vector<PlaneCell> chain(const std::vector<std::size_t>& order)
{
    if (order.size() == 1) return {{1, {order[0]}}};
    std::vector<PlaneCell> cells;
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
        cells.push_back({2, {order[i], order[i + 1]}});
    return cells;
}

/// The Delaunay triangulation: the cells cover the convex hull of the points. Points on one line give the segments
/// between neighbours, a single point one cell of its own. points: different and finite.
/// Source: Sloan, "A fast algorithm for constructing Delaunay triangulations in the plane" (1987), with points added in
/// the order of their coordinates; O(n² log n).
std::vector<PlaneCell> triangulate(const std::vector<glm::dvec2>& points)
{
    if (points.empty()) return {};
    const Points scaled = inUnitSquare(points);
    const std::vector<std::size_t> order = sweepOrder(scaled);
    std::size_t apex = 2;
    while (apex < order.size() && std::abs(signedArea(scaled, order[0], order[apex - 1], order[apex])) <= flatArea)
        ++apex;
    if (apex >= order.size()) return chain(order);
    std::vector<Corners> triangles = sweep(scaled, order, apex);
    for (std::size_t round = 0; round < points.size() && flipOnce(scaled, triangles); ++round)
        continue;
    std::vector<PlaneCell> cells;
    for (const Corners& corners : triangles)
        cells.push_back({3, corners});
    return cells;
}

NearestInCell nearestOnSegment(const Points& points, const PlaneCell& cell, std::size_t from, std::size_t to,
                               const glm::dvec2& point)
{
    const glm::dvec2 a = points[cell.points[from]], along = points[cell.points[to]] - a;
    const double share = std::clamp(glm::dot(point - a, along) / glm::dot(along, along), 0.0, 1.0);
    const glm::dvec2 away = point - a - along * share;
    NearestInCell nearest;
    nearest.weights[from] = 1.0 - share;
    nearest.weights[to] = share;
    nearest.squaredDistance = glm::dot(away, away);
    return nearest;
}

/// Empty: the point is outside the triangle.
std::optional<NearestInCell> insideTriangle(const Points& points, const PlaneCell& cell, const glm::dvec2& point)
{
    const auto corner = [&](std::size_t i) { return points[cell.points[i]] - point; };
    const double whole = cross(corner(1) - corner(0), corner(2) - corner(0));
    NearestInCell inside;
    inside.weights[0] = cross(corner(1), corner(2)) / whole;
    inside.weights[1] = cross(corner(2), corner(0)) / whole;
    inside.weights[2] = 1.0 - inside.weights[0] - inside.weights[1];
    const bool isInside = std::all_of(inside.weights.begin(), inside.weights.end(), [](double w) { return w >= 0.0; });
    return isInside ? std::optional(inside) : std::nullopt;
}

/// Projects a point into a cell.
NearestInCell nearestIn(const PlaneCell& cell, const std::vector<glm::dvec2>& points, const glm::dvec2& point)
{
    if (cell.count == 1)
    {
        const glm::dvec2 away = point - points[cell.points[0]];
        return {{1.0}, glm::dot(away, away)};
    }
    if (cell.count == 3)
        if (const std::optional<NearestInCell> inside = insideTriangle(points, cell, point)) return *inside;
    NearestInCell nearest = nearestOnSegment(points, cell, 0, 1, point);
    for (std::size_t from = 1; from < cell.count && cell.count == 3; ++from)
    {
        const NearestInCell other = nearestOnSegment(points, cell, from, (from + 1) % 3, point);
        if (other.squaredDistance < nearest.squaredDistance) nearest = other;
    }
    return nearest;
}

std::optional<std::string> findFaultInPlaces(const std::vector<BlendSpace::Point>& points)
{
    constexpr double max = 1e9;
    double extent = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const glm::dvec2& place = points[i].place;
        if (!(std::abs(place.x) <= max && std::abs(place.y) <= max))
            return "position " + std::to_string(i) + " is (" + std::to_string(place.x) + ", " +
                   std::to_string(place.y) + "), which is not finite or beyond 1e9";
        extent = std::max(extent, glm::distance(place, points.front().place));
    }
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (glm::distance(points[i].place, points[j].place) <= extent * 1e-6)
                return "positions " + std::to_string(j) + " and " + std::to_string(i) + " are equal or too close";
    return std::nullopt;
}

/// The stops of a clip. Error: the markers are not all there, in this order of a round.
Result<std::vector<double>> stopsOf(const Clip& clip, const std::vector<std::string>& markers)
{
    if (markers.empty() || !(clip.duration() > 0.0)) return std::vector<double>{0.0, clip.duration()};
    std::vector<double> stops;
    for (const std::string& name : markers)
    {
        const auto marker = std::find_if(clip.markers().begin(), clip.markers().end(),
                                         [&](const ClipMarker& known) { return known.name == name; });
        if (marker == clip.markers().end())
            return Error{"clip \"" + clip.name() + "\" has no marker \"" + name + "\"; its markers are " +
                         quotedNames(clip.markers())};
        double time = marker->time;
        if (!stops.empty() && time < stops.back()) time += clip.duration();
        if (!stops.empty() && (time < stops.back() || time >= stops.front() + clip.duration()))
            return Error{"clip \"" + clip.name() + "\" passes its marker \"" + name + "\" in another order"};
        stops.push_back(time);
    }
    stops.push_back(stops.front() + clip.duration());
    return stops;
}

/// Sets the stops of all points.
Result<void> findStops(const AnimationSet& set, std::vector<BlendSpace::Point>& points,
                       const std::vector<std::string>& markers)
{
    for (BlendSpace::Point& point : points)
    {
        const Result<std::size_t> clip = set.clipAt(point.clip);
        if (!clip) return clip.error();
        const Result<std::vector<double>> stops = stopsOf(set.clips()[point.clip], markers);
        if (!stops) return stops.error();
        point.stops = stops.value();
        if (!(point.duration() > 0.0)) point.stops.assign(markers.empty() ? 2 : markers.size() + 1, 0.0);
    }
    return {};
}

} // namespace

Result<std::shared_ptr<const BlendSpace>> BlendSpace::create(const AnimationSet& set,
                                                             const std::vector<Position>& positions,
                                                             const std::vector<std::string>& syncMarkers)
{
    std::vector<Point> points;
    for (const Position& position : positions)
    {
        const Result<std::size_t> clip = set.clipNamed(position.clip);
        if (!clip) return Error{"a blend space: " + clip.error().message};
        points.push_back({clip.value(), {position.x, position.y}, {}});
    }
    return create(set, std::move(points), syncMarkers);
}

Result<std::shared_ptr<const BlendSpace>> BlendSpace::create(const AnimationSet& set, std::vector<Point> points,
                                                             std::vector<std::string> syncMarkers)
{
    if (points.empty() || points.size() > maxPositions)
        return Error{"a blend space of " + std::to_string(points.size()) + " positions: 1 to " +
                     std::to_string(maxPositions) + " are possible"};
    if (const auto fault = findFaultInPlaces(points)) return Error{"a blend space: " + *fault};
    if (const Result<void> found = findStops(set, points, syncMarkers); !found)
        return Error{"a blend space: " + found.error().message};
    std::shared_ptr<BlendSpace> space(new BlendSpace);
    for (const Point& point : points)
        space->_places.push_back(point.place);
    space->_points = std::move(points);
    space->_syncMarkers = std::move(syncMarkers);
    space->_cells = triangulate(space->_places);
    for (std::size_t i = 0; i < space->_points.size(); ++i)
        if (const Mix mix = space->mixAt(space->_places[i]); mix.count != 1 || mix.weights[0].point != i)
            return Error{"a blend space: position " + std::to_string(i) + " is too close to a line of others"};
    return std::shared_ptr<const BlendSpace>(std::move(space));
}

bool BlendSpace::fits(const AnimationSet& set) const
{
    std::vector<Point> points = _points;
    return findStops(set, points, _syncMarkers) &&
           std::equal(points.begin(), points.end(), _points.begin(),
                      [](const Point& a, const Point& b) { return a.stops == b.stops; });
}

double BlendSpace::Point::timeAt(double phase) const
{
    const std::size_t stretches = stops.size() - 1;
    const double place = phase * static_cast<double>(stretches);
    const std::size_t stretch = std::min(static_cast<std::size_t>(std::max(place, 0.0)), stretches - 1);
    const double share = place - static_cast<double>(stretch);
    return stops[stretch] + share * (stops[stretch + 1] - stops[stretch]);
}

double BlendSpace::Point::phaseAt(double time) const
{
    const std::size_t stretches = stops.size() - 1;
    if (!(duration() > 0.0)) return 0.0;
    while (time < stops.front())
        time += duration();
    while (time >= stops.back())
        time -= duration();
    const auto next = std::upper_bound(stops.begin(), stops.end() - 1, time);
    const auto stretch = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - stops.begin(), 1)) - 1;
    const double share = (time - stops[stretch]) / (stops[stretch + 1] - stops[stretch]);
    return (static_cast<double>(stretch) + std::clamp(share, 0.0, 1.0)) / static_cast<double>(stretches);
}

BlendSpace::Mix BlendSpace::mixAt(const glm::dvec2& parameter) const
{
    static constexpr double max = 1e12; // squares stay finite
    const auto number = [](double value) { return std::isnan(value) ? 0.0 : std::clamp(value, -max, max); };
    const glm::dvec2 wanted(number(parameter.x), number(parameter.y));
    const PlaneCell* nearestCell = &_cells.front();
    NearestInCell nearest = nearestIn(*nearestCell, _places, wanted);
    for (const PlaneCell& cell : _cells)
    {
        const NearestInCell other = nearestIn(cell, _places, wanted);
        if (!(other.squaredDistance < nearest.squaredDistance)) continue;
        nearest = other;
        nearestCell = &cell;
    }
    constexpr double negligibleWeight = 1e-9;
    const auto isLighter = [](const Weight& a, const Weight& b)
    { return a.weight < b.weight || (a.weight == b.weight && a.point > b.point); };
    Mix mix;
    double whole = 0.0;
    for (std::size_t corner = 0; corner < nearestCell->count; ++corner)
    {
        const Weight added{nearestCell->points[corner], nearest.weights[corner]};
        if (added.weight < negligibleWeight) continue;
        std::size_t place = mix.count++;
        for (; place > 0 && isLighter(added, mix.weights[place - 1]); --place)
            mix.weights[place] = mix.weights[place - 1];
        mix.weights[place] = added;
        whole += added.weight;
    }
    for (Weight& weight : mix.weights)
        weight.weight /= whole;
    return mix;
}

namespace
{

constexpr std::size_t samplesOfARound = 120;

/// The ground speed of clips in equal shares, at phases that they reach together.
double groundSpeedOfMix(const AnimationSet& set, const std::vector<BlendSpace::Point>& points)
{
    double moving = 0.0; // poses do not count in the time of a round
    for (const BlendSpace::Point& point : points)
        moving += point.duration() > 0.0 ? 1.0 : 0.0;
    if (!(moving > 0.0)) return 0.0;
    const auto phaseAt = [](std::size_t sample) { return static_cast<double>(sample) / samplesOfARound; };
    std::vector<double> times;
    for (std::size_t sample = 0; sample <= samplesOfARound; ++sample)
    {
        double seconds = 0.0;
        for (const BlendSpace::Point& point : points)
            seconds += (point.timeAt(phaseAt(sample)) - point.stops.front()) / moving;
        times.push_back(seconds);
    }
    const auto poseAt = [&](std::size_t sample)
    {
        PoseInstruction instruction;
        instruction.sampleCount = 0;
        for (const BlendSpace::Point& point : points)
        {
            const double time = point.timeAt(phaseAt(sample)), duration = point.duration();
            BlendSample& mixed = instruction.samples[instruction.sampleCount++];
            mixed = set.sampleAt(static_cast<int>(point.clip), time > duration ? time - duration : time);
            mixed.weight = 1.0f / static_cast<float>(points.size());
        }
        return instruction;
    };
    const FootPaths paths(set, std::move(times), poseAt);
    return paths.groundSpeed(paths.feet());
}

double meanDuration(const std::vector<BlendSpace::Weight>& weights, const std::vector<BlendSpace::Point>& points)
{
    double seconds = 0.0, whole = 0.0;
    for (const BlendSpace::Weight& weight : weights)
    {
        const double duration = points[weight.point].duration();
        seconds += weight.weight * duration;
        whole += duration > 0.0 ? weight.weight : 0.0;
    }
    return whole > 0.0 ? seconds / whole : 0.0;
}

} // namespace

double BlendSpace::wayOf(const AnimationSet& set, std::size_t first, std::size_t second) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto key = std::minmax(first, second);
    if (const auto known = _ways.find(key); known != _ways.end()) return known->second;
    std::vector<Point> points{_points[first]};
    if (second != first) points.push_back(_points[second]);
    const double seconds = meanDuration({{first, 0.5}, {second, 0.5}}, _points);
    return _ways[key] = groundSpeedOfMix(set, points) * seconds;
}

double BlendSpace::groundSpeedAt(const AnimationSet& set, const glm::dvec2& parameter) const
{
    const Mix mix = mixAt(parameter);
    const std::vector<Weight> weights(mix.weights.begin(), mix.weights.begin() + mix.count);
    double way = 0.0; // quadratic, through the corners and the middles of the edges
    for (std::size_t i = 0; i < weights.size(); ++i)
    {
        const double weight = weights[i].weight;
        if (weight != 0.5) way += weight * (2.0 * weight - 1.0) * wayOf(set, weights[i].point, weights[i].point);
        for (std::size_t j = 0; j < i; ++j)
            way += 4.0 * weight * weights[j].weight * wayOf(set, weights[i].point, weights[j].point);
    }
    const double seconds = meanDuration(weights, _points);
    return seconds > 0.0 ? std::max(way, 0.0) / seconds : 0.0;
}

double measureGroundSpeed(const AnimationSet& set, std::size_t clip)
{
    if (const std::optional<double> known = set.knownGroundSpeed(clip)) return *known;
    const double speed = groundSpeedOfMix(set, {{clip, glm::dvec2(0.0), {0.0, set.clips()[clip].duration()}}});
    set.keepGroundSpeed(clip, speed);
    return speed;
}

} // namespace osgGpuAnimation
