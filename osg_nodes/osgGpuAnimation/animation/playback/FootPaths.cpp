// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/playback/FootPaths.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

constexpr double lowestShare = 0.2;      ///< of a joint's lift: it may be on the ground
constexpr double speedShare = 1.0 / 3.0; ///< of its largest speed relative to the ground: it may be on the ground
constexpr double minLift = 0.01;         ///< of the skeleton's height: less is no step
constexpr double footHeight = 0.1;       ///< of the skeleton's height: feet come closer to the ground
constexpr double shortest = 0.03;        ///< of a round: shorter contacts and gaps do not count
constexpr double nearMedian = 0.15;      ///< of the median speed: steps of feet that are firmly on the ground

glm::dvec3 originOf(const AffineMatrix& matrix)
{
    return {matrix.rows[0].w, matrix.rows[1].w, matrix.rows[2].w};
}

bool isLower(const glm::dvec3& a, const glm::dvec3& b)
{
    return a.y < b.y;
}

double lowestOf(const FootPaths::Path& path)
{
    return std::min_element(path.begin(), path.end(), isLower)->y;
}

/// Joints that move vertices, as far as the set knows; all, if it knows none.
std::vector<bool> movingJoints(const AnimationSet& set)
{
    std::vector<bool> isMoving(set.skeleton().jointCount(), set.skins().empty() && set.rigidJoints().empty());
    for (const Skin& skin : set.skins())
        for (const int joint : skin.joints)
            isMoving[joint] = true;
    for (const int joint : set.rigidJoints())
        isMoving[joint] = true;
    return isMoving;
}

/// Replaces runs of a value that are shorter than `least`; the samples are a circle or a line.
void fillShortRuns(std::vector<bool>& samples, bool value, std::size_t min, bool isRound)
{
    const std::size_t count = samples.size();
    const auto first = std::find(samples.begin(), samples.end(), !value);
    if (first == samples.end()) return;
    const auto start = static_cast<std::size_t>(first - samples.begin());
    std::size_t length = 0;
    for (std::size_t i = 0; i <= count; ++i)
    {
        const std::size_t sample = (start + i) % count;
        const bool isLineEnd = !isRound && sample == 0 && i > 0;
        if (samples[sample] != value || isLineEnd)
        {
            for (std::size_t back = 1; length < min && back <= length; ++back)
                samples[(start + i - back) % count] = !value;
            length = 0;
        }
        if (samples[sample] == value) ++length;
    }
}

} // namespace

FootPaths::FootPaths(const AnimationSet& set, std::vector<double> times,
                     const std::function<PoseInstruction(std::size_t)>& poseAt, std::vector<std::size_t> joints)
    : _set(set), _times(std::move(times))
{
    const std::size_t all = set.skeleton().jointCount();
    _paths.resize(joints.empty() ? all : joints.size());
    std::vector<JointTransform> tracks;
    std::vector<AffineMatrix> jointToModel;
    for (std::size_t sample = 0; sample < _times.size(); ++sample)
    {
        Pose::mix(set, poseAt(sample), tracks);
        Pose::jointToModel(set, tracks, AffineMatrix(), jointToModel);
        for (std::size_t i = 0; i < _paths.size(); ++i)
            _paths[i].push_back(originOf(jointToModel[joints.empty() ? i : joints[i]]));
        if (sample > 0 || all == 0) continue;
        Path origins;
        std::transform(jointToModel.begin(), jointToModel.end(), std::back_inserter(origins), originOf);
        _height = lift(origins);
    }
}

double FootPaths::lift(const Path& path) const
{
    const auto [lowest, highest] = std::minmax_element(path.begin(), path.end(), isLower);
    return highest->y - lowest->y;
}

/// True if the path ends where it begins.
bool FootPaths::isRound(const Path& path) const
{
    return glm::distance(path.front(), path.back()) <= 0.02 * _height;
}

/// Along the ground, around the sample.
glm::dvec3 FootPaths::velocity(const Path& path, std::size_t sample) const
{
    const std::size_t last = path.size() - 1;
    const std::size_t next = std::min(sample + 1, last), before = sample > 0 ? sample - 1 : 0;
    glm::dvec3 way = path[next] - path[before];
    double seconds = _times[next] - _times[before];
    if (sample == 0 && isRound(path))
    {
        way += path[last] - path[last - 1];
        seconds += _times[last] - _times[last - 1];
    }
    way.y = 0.0;
    return seconds > 0.0 ? way / seconds : glm::dvec3(0.0);
}

/// One entry per sample without the last, which ends the round.
std::vector<bool> FootPaths::samplesOnGround(const Path& path) const
{
    const std::size_t count = path.size() - 1;
    const double lowest = lowestOf(path), lifted = lift(path);
    if (lifted < minLift * _height) return std::vector<bool>(count, true);
    glm::dvec3 ground(0.0);
    double lowSamples = 0.0, fastest = 0.0;
    for (std::size_t sample = 0; sample < count; ++sample)
    {
        if (path[sample].y > lowest + 0.5 * lowestShare * lifted) continue;
        ground += velocity(path, sample);
        lowSamples += 1.0;
    }
    ground /= lowSamples;
    for (std::size_t sample = 0; sample < count; ++sample)
        fastest = std::max(fastest, glm::length(velocity(path, sample) - ground));
    std::vector<bool> isOnGround;
    for (std::size_t sample = 0; sample < count; ++sample)
        isOnGround.push_back(path[sample].y <= lowest + lowestShare * lifted &&
                             glm::length(velocity(path, sample) - ground) <= speedShare * fastest);
    const auto min = static_cast<std::size_t>(shortest * static_cast<double>(count));
    fillShortRuns(isOnGround, false, min, isRound(path));
    fillShortRuns(isOnGround, true, min, isRound(path));
    return isOnGround;
}

FootPaths::Contacts FootPaths::contactsOf(std::size_t index) const
{
    const Path& path = _paths[index];
    const std::vector<bool> isOnGround = samplesOnGround(path);
    const std::size_t count = isOnGround.size();
    Contacts contacts;
    for (std::size_t sample = 0; sample < count; ++sample)
    {
        if (!isOnGround[sample]) continue;
        const std::size_t first = sample;
        while (sample < count && isOnGround[sample])
            ++sample;
        contacts.emplace_back(first, sample);
    }
    const bool joins = contacts.size() > 1 && contacts.front().first == 0 && contacts.back().second == count;
    if (!joins || !isRound(path)) return contacts;
    contacts.back().second += contacts.front().second;
    contacts.erase(contacts.begin());
    return contacts;
}

std::vector<std::size_t> FootPaths::feet() const
{
    const std::vector<bool> isMoving = movingJoints(_set);
    std::vector<bool> isEnd = isMoving;
    double lowest = HUGE_VAL;
    for (std::size_t joint = isMoving.size(); joint-- > 0;)
    {
        if (!isMoving[joint]) continue;
        lowest = std::min(lowest, lowestOf(_paths[joint]));
        for (int above = _set.skeleton().joint(joint).parent; above >= 0; above = _set.skeleton().joint(above).parent)
            isEnd[above] = false;
    }
    std::vector<std::size_t> found;
    for (std::size_t joint = 0; joint < isMoving.size(); ++joint)
        if (isEnd[joint] && lift(_paths[joint]) >= minLift * _height &&
            lowestOf(_paths[joint]) <= lowest + footHeight * _height)
            found.push_back(joint);
    return found;
}

double FootPaths::groundSpeed(const std::vector<std::size_t>& joints) const
{
    struct Step
    {
        glm::dvec3 way;
        double seconds, speed;
    };
    std::vector<Step> steps;
    glm::dvec3 direction(0.0);
    for (const std::size_t joint : joints)
    {
        const Path& path = _paths[joint];
        const std::vector<bool> isOnGround = samplesOnGround(path);
        for (std::size_t sample = 0; sample < isOnGround.size(); ++sample)
        {
            const double seconds = _times[sample + 1] - _times[sample];
            if (!isOnGround[sample] || !(seconds > 0.0)) continue;
            const glm::dvec3 way = path[sample + 1] - path[sample];
            steps.push_back({glm::dvec3(way.x, 0.0, way.z), seconds, 0.0});
            direction += steps.back().way;
        }
    }
    if (!(glm::length(direction) > 0.0)) return 0.0;
    direction = glm::normalize(direction);
    for (Step& step : steps)
        step.speed = glm::dot(step.way, direction) / step.seconds;
    // The feet slow down before they lift and after they touch: only steps near the median count.
    const auto middle = steps.begin() + steps.size() / 2;
    std::nth_element(steps.begin(), middle, steps.end(),
                     [](const Step& a, const Step& b) { return a.speed < b.speed; });
    const double median = middle->speed;
    double way = 0.0, seconds = 0.0;
    for (const Step& step : steps)
    {
        if (std::abs(step.speed - median) > nearMedian * std::abs(median)) continue;
        way += step.speed * step.seconds;
        seconds += step.seconds;
    }
    return std::max(way / seconds, 0.0);
}

} // namespace osgGpuAnimation
