// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Light>
#include <osg/Vec3>
#include <osg/Vec4>

namespace osgGpuAnimation
{

/// A light of glTF's extension KHR_lights_punctual, in physical units, for an osg::LightSource. It shines along -Z of
/// the LightSource's space, from its origin.
///
///     osg::ref_ptr<PunctualLight> lamp = new PunctualLight(PunctualLight::Kind::Spot, 1);
///     lamp->setIntensity(osg::Vec3(1.0f, 0.8f, 0.6f), 40.0f);
///     lamp->setCone(15.0f, 30.0f);
///     osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
///     source->setLight(lamp);
///
/// A surface of albedo a that faces the light gets the radiance a * diffuse / distance²: osg::Light's diffuse is the
/// intensity divided by pi, and the attenuation is quadratic (scene units are metres; a scale above the light does not
/// change it). OpenGL's lights have no counterpart to the range and to the falloff from the inner to the outer cone.
/// Shaders get both from coneAndRange(); the fixed pipeline shows no range, and the spot exponent with which the same
/// light passes the cone.
class PunctualLight : public osg::Light
{
public:
    enum class Kind
    {
        Directional, ///< intensity in lux
        Point,       ///< intensity in candela, to all sides
        Spot         ///< intensity in candela, within setCone()
    };

    /// A directional light of number 0.
    PunctualLight() : PunctualLight(Kind::Directional, 0) {}
    /// A white light of intensity 1 and unlimited range. A spot has glTF's default cone: from 0 to 45 degrees.
    /// number: of OpenGL's lights, in [0, 7]. Viewers use 0 for their headlight.
    PunctualLight(Kind kind, unsigned int number);
    /// Copies all values.
    PunctualLight(const PunctualLight& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);

    osg::Object* cloneType() const override;
    osg::Object* clone(const osg::CopyOp& copyop) const override { return new PunctualLight(*this, copyop); }
    bool isSameKindAs(const osg::Object* object) const override
    {
        return dynamic_cast<const PunctualLight*>(object) != nullptr;
    }
    const char* libraryName() const override { return "osgGpuAnimation"; }
    const char* className() const override { return "PunctualLight"; }
    int compare(const osg::StateAttribute& other) const override;

    Kind getKind() const; ///< by the position and the cutoff

    /// Sets diffuse and specular to color * intensity / pi, and ambient to black.
    /// color: linear RGB, at least 0. intensity: lux or candela, at least 0, see Kind. Error: one, or their
    /// product, is negative or not finite.
    Result<void> setIntensity(const osg::Vec3& color, float intensity);

    /// Sets the cone of a spot: full intensity within the inner angle, none beyond the outer one (the cutoff). Sets the
    /// spot exponent, too.
    /// Both in degrees from the axis, 0 <= inner < outer <= 90. Error: others.
    Result<void> setCone(float innerAngle, float outerAngle);
    float getInnerConeAngle() const { return _innerConeAngle; } ///< degrees; 0 but for spots. Outer: getSpotCutoff()

    /// Sets the distance at which the light ends. range: scene units; 0: unlimited. Error: negative or not finite.
    Result<void> setRange(float range);
    float getRange() const { return _range; } ///< scene units; 0 (the default): unlimited

    /// (scale, offset, 1 / range², 0) of the extension's formulas; all but the offset 1 are 0 for a light without cone
    /// and range. At a distance d, with the cosine c between the light's axis and the way to the surface, the light is
    ///
    ///     cone = clamp(c * scale + offset, 0, 1);                        window = clamp(1 - (d * d / range²)², 0, 1);
    ///     diffuse * cone * cone * window / (d * d)
    ///
    /// Directional lights have neither. Source: KHR_lights_punctual, "Range Property" and "Inner and Outer Cone
    /// Angles".
    osg::Vec4 coneAndRange() const;

protected:
    ~PunctualLight() override = default;

private:
    float _innerConeAngle = 0.0f;
    float _range = 0.0f;
};

} // namespace osgGpuAnimation
