// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

namespace osgGpuAnimation
{

/// The surroundings that light everything below the node (image-based light): the materials of PbrMaterial, drawn by
/// the character program or the surface program. They replace the ambient light of OSG's lights; the lights themselves
/// still shine. Without an Environment, the ambient light is an even surrounding.
///
///     osg::ref_ptr<Environment> environment = new Environment;
///     environment->setIntensity(0.8f);
///     environment->addChild(model);
///
/// The surroundings are in the node's space, +Z up. An inner Environment replaces an outer one.
class Environment : public osg::Group
{
public:
    /// The studio: a formula without textures, with a gradient from below to above and three soft lights.
    Environment();
    Environment(const Environment& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, Environment)

    /// Multiplies the radiance; 0 or more; default 1.
    void setIntensity(float intensity);
    float getIntensity() const { return _intensity; }

    /// Turns the surroundings about +Z, counter-clockwise from above; radians; default 0.
    void setRotation(float radians) { _rotation = radians; }
    float getRotation() const { return _rotation; }

    /// Khronos PBR Neutral tone mapping of everything below; default false: colours above 1 are clamped.
    void setToneMapping(bool isOn);
    bool getToneMapping() const { return _toneMapping; }

    void traverse(osg::NodeVisitor& visitor) override;

protected:
    ~Environment() override = default;

private:
    float _intensity = 1.0f;
    float _rotation = 0.0f; ///< radians
    bool _toneMapping = false;
};

} // namespace osgGpuAnimation
