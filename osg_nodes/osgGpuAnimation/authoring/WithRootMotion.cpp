// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr double pi = glm::pi<double>();

bool isNear(const glm::vec4& a, const glm::vec4& b, double max)
{
    return glm::all(glm::lessThanEqual(glm::dvec4(glm::abs(a - b)), glm::dvec4(max)));
}

bool isNear(const JointTransform& a, const JointTransform& b)
{
    const double size = 1.0 + static_cast<double>(glm::length(a.translation) + glm::length(a.scale));
    return isNear(a.translation, b.translation, 1e-6 * size) && isNear(a.rotation, b.rotation, 1e-6) &&
           isNear(a.scale, b.scale, 1e-6 * size);
}

/// True for a rotation with a uniform scale, without a mirror.
bool isSimilarity(const glm::dmat3& m)
{
    const double size = glm::length(m[0]);
    constexpr double tolerance = 1e-4;
    return size > 0.0 && std::isfinite(size) && std::abs(glm::length(m[1]) / size - 1.0) <= tolerance &&
           std::abs(glm::length(m[2]) / size - 1.0) <= tolerance &&
           glm::length(glm::cross(m[0], m[1]) / (size * size) - m[2] / size) <= tolerance;
}

} // namespace

/// Removes the motion of one joint from clips, see withRootMotion().
class RootMotionExtractor
{
public:
    RootMotionExtractor(const Skeleton& skeleton, std::size_t joint, const RootMotionAxes& axes)
        : _skeleton(skeleton), _joint(joint), _axes(axes)
    {
        _axes.up = glm::normalize(_axes.up);
    }

    Result<Clip> extract(const Clip& clip)
    {
        if (const RootMotionCurve* taken = clip.rootMotion())
            return Error{"clip \"" + clip.name() + "\" has had its root motion taken out already, from joint \"" +
                         _skeleton.joint(taken->joint).name + "\""};
        const Result<void> hasParent = findParent(clip);
        if (!hasParent) return hasParent.error();
        Clip stripped = clip;
        stripped._compactTracks = nullptr;
        stripped._data = std::make_shared<std::vector<JointTransform>>(clip.data());
        auto curve = std::make_shared<RootMotionCurve>();
        curve->joint = _joint;
        curve->up = _axes.up;
        curve->keys.resize(clip.keyframeCount());
        removeTranslation(stripped, *curve);
        if (_axes.yaw) removeYaw(stripped, *curve);
        stripped._rootMotion = std::move(curve);
        return stripped;
    }

private:
    bool isStill(const Clip& clip, std::size_t joint) const
    {
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
        {
            const JointTransform* here = clip.at(k, joint);
            if (!isNear(*clip.at(0, joint), *here)) return false;
            for (std::size_t tangent = 1; tangent < clip.transformsPerTrack(); ++tangent)
                if (!isNear(noTangent, here[tangent])) return false;
        }
        return true;
    }

    Result<void> findParent(const Clip& clip)
    {
        for (int j = _skeleton.joint(_joint).parent; j >= 0; j = _skeleton.joint(j).parent)
        {
            const auto joint = static_cast<std::size_t>(j);
            if (!isStill(clip, joint))
                return Error{"clip \"" + clip.name() + "\" moves joint \"" + _skeleton.joint(joint).name +
                             "\" above \"" + _skeleton.joint(_joint).name + "\", whose motion is to be taken out"};
            const JointTransform& local = *clip.at(0, joint);
            _parentToModel = local.toMatrix().toColumns() * _parentToModel;
            _parentRotation = Rotation::unitQuaternion(local.rotation) * _parentRotation;
        }
        if (!isSimilarity(glm::dmat3(_parentToModel)))
            return Error{"joint \"" + _skeleton.joint(_joint).name +
                         "\" is under a scale that is not the same in all directions: its motion cannot be taken out"};
        return {};
    }

    /// The part of a rotation in model space that turns about up (its twist), in [-pi, pi].
    double yawOf(const glm::dquat& rotation) const
    {
        const double along = glm::dot(glm::dvec3(rotation.x, rotation.y, rotation.z), _axes.up);
        if (along == 0.0 && rotation.w == 0.0) return 0.0;
        const double angle = 2.0 * std::atan2(along, rotation.w);
        return angle > pi ? angle - 2.0 * pi : angle < -pi ? angle + 2.0 * pi : angle;
    }

    void removeTranslation(Clip& clip, RootMotionCurve& curve) const
    {
        const glm::dmat3 toModel(_parentToModel);
        const glm::dmat3 toParent = glm::inverse(toModel);
        const auto taken = [&](const glm::dvec3& v)
        {
            const glm::dvec3 along = _axes.up * glm::dot(_axes.up, v);
            return (_axes.horizontal ? v - along : glm::dvec3(0.0)) + (_axes.vertical ? along : glm::dvec3(0.0));
        };
        const std::size_t perTrack = clip.transformsPerTrack();
        JointTransform* key = &(*clip._data)[_joint * perTrack];
        const glm::dvec3 first(key->translation);
        for (std::size_t k = 0; k < curve.keys.size(); ++k, key += clip.keyframeStride())
            for (std::size_t part = 0; part < perTrack; ++part)
            {
                const glm::dvec3 own(key[part].translation);
                const glm::dvec3 way = toModel * (part == 0 ? own - first : own);
                const glm::dvec3 gone = taken(way);
                const glm::dvec3 left = own - toParent * gone;
                key[part].translation = glm::vec4(glm::vec3(left), key[part].translation.w);
                RootMotionCurve::Key& out = curve.keys[k];
                const auto place = part == 0   ? &RootMotionCurve::Point::value
                                   : part == 1 ? &RootMotionCurve::Point::in
                                               : &RootMotionCurve::Point::out;
                out.displacement.*place = gone;
                out.pivot.*place = glm::dvec3(_parentToModel * glm::dvec4(left, part == 0 ? 1.0 : 0.0));
            }
    }

    void removeYaw(Clip& clip, RootMotionCurve& curve) const
    {
        const std::size_t perTrack = clip.transformsPerTrack(), stride = clip.keyframeStride();
        JointTransform* keys = &(*clip._data)[_joint * perTrack];
        const glm::dquat first = _parentRotation * Rotation::unitQuaternion(keys->rotation);
        for (std::size_t k = 0; k < curve.keys.size(); ++k)
        {
            const double yaw =
                yawOf(_parentRotation * Rotation::unitQuaternion(keys[k * stride].rotation) * glm::conjugate(first));
            const double before = k == 0 ? 0.0 : curve.keys[k - 1].yaw;
            curve.keys[k].yaw = yaw + 2.0 * pi * std::round((before - yaw) / (2.0 * pi));
        }
        const glm::dvec3 axis = glm::conjugate(_parentRotation) * _axes.up;
        for (std::size_t k = 0; k < curve.keys.size(); ++k)
        {
            JointTransform* key = keys + k * stride;
            const double yaw = curve.keys[k].yaw;
            const glm::dquat back = glm::angleAxis(-yaw, axis);
            const glm::dquat value = back * Rotation::quaternion(glm::dvec4(key->rotation));
            const bool isSpline = perTrack == 3 && key->translation.w == 0.0f;
            for (std::size_t part = 1; isSpline && part < 3; ++part)
            {
                // Product rule: the tangent itself, and the yaw that changes within that piece.
                const std::size_t from = part == 1 ? (k == 0 ? 0 : k - 1) : k;
                const std::size_t to = std::min(from + 1, curve.keys.size() - 1);
                const double slope = part == 1 && k == 0 ? 0.0 : curve.keys[to].yaw - curve.keys[from].yaw;
                key[part].rotation = Rotation::toFloats(back * Rotation::quaternion(glm::dvec4(key[part].rotation)) -
                                                        glm::dquat(0.0, axis) * value * (0.5 * slope));
            }
            key->rotation = Rotation::toFloats(value);
        }
    }

    const Skeleton& _skeleton;
    std::size_t _joint;
    RootMotionAxes _axes; ///< up is unit
    // From the space of the joint's parent to model space.
    glm::dmat4 _parentToModel{1.0};
    glm::dquat _parentRotation = glm::identity<glm::dquat>();
};

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
