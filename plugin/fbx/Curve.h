// SPDX-License-Identifier: MIT
#pragma once

#include "fbx/Document.h"

#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <vector>

namespace osgGpuAnimation::fbx
{

/// An animation curve: one number over time, with keys that are stepped, linear or cubic (weighted tangents included).
/// Before the first key and after the last one, it holds their values.
///
///     Curve curve = Curve::of(*element, ticksPerSecond);
///     double percent = curve.at(0.5);
class Curve
{
public:
    /// element: an AnimationCurve. Keys that go back in time, and numbers that are not finite, are left out.
    static Curve of(const Element& element, double ticksPerSecond);

    bool isEmpty() const { return _keys.empty(); }
    /// seconds: of the file. before: the limit from earlier times, which differs where a stepped key ends.
    double at(double seconds, bool before = false) const;
    /// Appends the times of the keys.
    void appendTimes(std::vector<double>& times) const;

private:
    enum class Interpolation
    {
        Stepped,     ///< holds the value of the key
        SteppedNext, ///< has the value of the next key at once
        Linear,
        Cubic
    };

    struct Key
    {
        double time; ///< seconds
        double value;
        Interpolation interpolation = Interpolation::Linear; ///< up to the next key
        double slope = 0.0, nextSlope = 0.0;                 ///< of this key to the right, of the next one to the left
        double weight = 1.0 / 3.0, nextWeight = 1.0 / 3.0;   ///< length of the tangents, as a part of the interval
    };

    static double cubic(const Key& key, const Key& next, double seconds);
    void readTangents(const Element& element);
    double automaticSlope(std::size_t key) const;

    std::vector<Key> _keys;
};

/// Three numbers that curves of one or more layers animate: a translation, Euler angles, factors of scale.
struct AnimatedVector
{
    /// The curves of a layer; a component without a curve has the constant, if the layer has one.
    struct Layer
    {
        std::array<std::optional<Curve>, 3> curves;
        std::array<std::optional<double>, 3> constants;
        double weight = 1.0; ///< 0 to 1
        bool isOverride = true;
    };

    glm::dvec3 rest{0.0};  ///< without curves
    bool isFactor = false; ///< additive layers multiply
    std::vector<Layer> layers;

    glm::dvec3 at(double seconds, bool before = false) const;
    void appendTimes(std::vector<double>& times) const;
};

} // namespace osgGpuAnimation::fbx
