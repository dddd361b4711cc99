// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/PunctualLight.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgGpuAnimation
{

namespace
{

constexpr float noCutoff = 180.0f; ///< OpenGL's value for lights that are no spots
constexpr double maxExponent = 128.0;

double cosineOf(float degrees)
{
    return std::cos(osg::DegreesToRadians(static_cast<double>(degrees)));
}

/// The exponent e with which OpenGL's falloff, cosine to the power of e, passes as much light through the cone as the
/// extension's.
float exponentOf(double cosInner, double cosOuter)
{
    const double flux = 1.0 - cosInner + (cosInner - cosOuter) / 3.0;
    const auto fluxOf = [cosOuter](double e) { return (1.0 - std::pow(cosOuter, e + 1.0)) / (e + 1.0); };
    double low = 0.0, high = maxExponent; // the flux falls with the exponent
    for (int step = 0; step < 40; ++step)
    {
        const double middle = 0.5 * (low + high);
        (fluxOf(middle) > flux ? low : high) = middle;
    }
    return static_cast<float>(low);
}

bool isFiniteAndNotNegative(float number)
{
    return std::isfinite(number) && number >= 0.0f;
}

} // namespace

PunctualLight::PunctualLight(Kind kind, unsigned int number) : osg::Light(number)
{
    setPosition(
        osg::Vec4(0.0f, 0.0f, kind == Kind::Directional ? 1.0f : 0.0f, kind == Kind::Directional ? 0.0f : 1.0f));
    setDirection(osg::Vec3(0.0f, 0.0f, -1.0f));
    setConstantAttenuation(kind == Kind::Directional ? 1.0f : 0.0f);
    setQuadraticAttenuation(kind == Kind::Directional ? 0.0f : 1.0f);
    static_cast<void>(setIntensity(osg::Vec3(1.0f, 1.0f, 1.0f), 1.0f));
    if (kind == Kind::Spot) static_cast<void>(setCone(0.0f, 45.0f));
}

PunctualLight::PunctualLight(const PunctualLight& other, const osg::CopyOp& copyop)
    : osg::Light(other, copyop), _innerConeAngle(other._innerConeAngle), _range(other._range)
{
}

osg::Object* PunctualLight::cloneType() const
{
    return new PunctualLight(Kind::Directional, static_cast<unsigned int>(getLightNum()));
}

int PunctualLight::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(PunctualLight, other);
    const int difference = osg::Light::compare(other);
    if (difference != 0) return difference;
    COMPARE_StateAttribute_Parameter(_innerConeAngle);
    COMPARE_StateAttribute_Parameter(_range);
    return 0;
}

PunctualLight::Kind PunctualLight::getKind() const
{
    if (getPosition().w() == 0.0f) return Kind::Directional;
    return getSpotCutoff() < noCutoff ? Kind::Spot : Kind::Point;
}

Result<void> PunctualLight::setIntensity(const osg::Vec3& color, float intensity)
{
    const osg::Vec3 radiance = color * (intensity / static_cast<float>(osg::PI));
    for (const float number : {color.x(), color.y(), color.z(), intensity, radiance.x(), radiance.y(), radiance.z()})
        if (!isFiniteAndNotNegative(number)) return Error{"a light's color or intensity is " + std::to_string(number)};
    setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    setDiffuse(osg::Vec4(radiance, 1.0f));
    setSpecular(osg::Vec4(radiance, 1.0f));
    return {};
}

Result<void> PunctualLight::setCone(float innerAngle, float outerAngle)
{
    if (!(innerAngle >= 0.0f && innerAngle < outerAngle && outerAngle <= 90.0f))
        return Error{"a light's cone is from " + std::to_string(innerAngle) + " to " + std::to_string(outerAngle) +
                     " degrees, not from at least 0 to more and at most 90"};
    _innerConeAngle = innerAngle;
    setSpotCutoff(outerAngle);
    setSpotExponent(exponentOf(cosineOf(innerAngle), cosineOf(outerAngle)));
    return {};
}

Result<void> PunctualLight::setRange(float range)
{
    if (!isFiniteAndNotNegative(range)) return Error{"a light's range is " + std::to_string(range)};
    _range = range;
    return {};
}

osg::Vec4 PunctualLight::coneAndRange() const
{
    double scale = 0.0, offset = 1.0;
    if (getKind() == Kind::Spot)
    {
        const double cosOuter = cosineOf(getSpotCutoff());
        scale = 1.0 / std::max(0.001, cosineOf(_innerConeAngle) - cosOuter);
        offset = -cosOuter * scale;
    }
    const double square = static_cast<double>(_range) * static_cast<double>(_range);
    // Of ranges so small that the square has no inverse in float: no light.
    const double inverse = square > 0.0 ? std::min(1.0 / square, 1e30) : 0.0;
    return osg::Vec4(static_cast<float>(scale), static_cast<float>(offset), static_cast<float>(inverse), 0.0f);
}

} // namespace osgGpuAnimation
