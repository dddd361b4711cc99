// SPDX-License-Identifier: MIT
#pragma once

#include <glm/ext/quaternion_double.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation::fbx
{

/// Euler angles in degrees, with a rotation order of FBX: 0 is XYZ, X first; then XZY, YZX, YXZ, ZXY, ZYX.
glm::dquat rotationOf(const glm::dvec3& angles, int order);

/// Where a model is in its parent: L = T · R · S. The chain of FBX always has this form.
struct Placement
{
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
};

/// A bone of a mesh, where they were bound.
struct Binding
{
    std::size_t bone; ///< model
    glm::dmat4 meshToBone;
};

/// A node of the file.
struct Model
{
    std::string name;                                       ///< as the file has it; several may have the same
    std::string uniqueName;                                 ///< in Scene::bytesForAssimp
    int parent = -1;                                        ///< model; -1: none
    glm::dvec3 translation{0.0}, rotation{0.0}, scale{1.0}; ///< "Lcl …": file units, degrees, factors
    int rotationOrder = 0;                                  ///< 0: XYZ, X first; then XZY, YZX, YXZ, ZXY, ZYX
    glm::dvec3 rotationOffset{0.0}, rotationPivot{0.0}, scalingOffset{0.0}, scalingPivot{0.0};
    glm::dvec3 preRotation{0.0}, postRotation{0.0};
    bool compensatesScale = false;   ///< Segment Scale Compensate: without the scale of the parent
    bool isHidden = false;           ///< Visibility 0
    glm::dmat4 geometric{1.0};       ///< moves the meshes of the model, not its children
    std::vector<Binding> bindings;   ///< of its meshes' skins
    std::vector<std::size_t> shapes; ///< channels of its meshes, once for each shape, in the order of the file

    /// T · Roff · Rp · Rpre · R · Rpost⁻¹ · Rp⁻¹ · Soff · Sp · S · Sp⁻¹ of the FBX SDK.
    Placement placement(const glm::dvec3& lclTranslation, const glm::dvec3& lclRotation,
                        const glm::dvec3& lclScaling) const;
    Placement rest() const { return placement(translation, rotation, scale); }
    bool hasPivots() const; ///< the translation depends on the rotation or the scale
};

/// A blend shape with one target, or several with the percentages at which they are full.
struct ShapeChannel
{
    std::string name;
    std::string uniqueName; ///< without points: Assimp 5.4 appends a point and the target's name, where there are none
    std::vector<std::string> targetNames; ///< unique, too
    double percent = 0.0;                 ///< at rest
    std::vector<double> fullPercents;     ///< of each target; Blender's, of another number, say nothing about targets

    /// Between the targets before and after the percentage; 0 % is the mesh without targets. Beyond the outermost
    /// targets, the weights go on.
    std::size_t targets() const { return targetNames.size(); }
    double weight(std::size_t target, double atPercent) const;
};

} // namespace osgGpuAnimation::fbx
