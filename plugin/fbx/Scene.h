// SPDX-License-Identifier: MIT
#pragma once

#include "fbx/Curve.h"

#include <glm/ext/quaternion_double.hpp>
#include <glm/mat4x4.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation::fbx
{

/// Where a model is in its parent: L = T · R · S. The chain of FBX always has this form.
struct Placement
{
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
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
    std::string uniqueName;
    double percent = 0.0; ///< at rest
    std::size_t targets = 0;
    std::vector<double> fullPercents; ///< of each target; Blender's, of another number, say nothing about targets

    /// Between the targets before and after the percentage; 0 % is the mesh without targets. Beyond the outermost
    /// targets, the weights go on.
    double weight(std::size_t target, double atPercent) const;
};

struct ModelTracks
{
    std::size_t model;
    AnimatedVector translation, rotation, scale;
};

struct ShapeTrack
{
    std::size_t channel;
    Curve percent;
};

/// An animation of the file, cut at its ends.
struct Take
{
    std::string name;
    double begin = 0.0, end = 0.0;   ///< seconds of the file
    std::vector<ModelTracks> models; ///< ascending
    std::vector<ShapeTrack> shapes;
};

/// What Assimp loses of an FBX file (versions 7.0 to 7.7): pivots, animations as they are, the weights of shapes, the
/// visibility. Meshes, skins and materials are Assimp's part, which reads bytesForAssimp.
class Scene
{
public:
    /// Errors: those of Document::parse(); a version below 7.
    static Result<Scene> read(std::string bytes);

    std::vector<Model> models;
    std::vector<ShapeChannel> channels;
    std::vector<Take> takes;
    double metresPerUnit = 0.01;
    /// The file with other names of the same length where several models (or shapes) have the same, and without what
    /// ends the process in asserts of Assimp: takes, and properties of type KTime.
    std::string bytesForAssimp;
    std::vector<std::string> warnings; ///< what is lost, by name
};

} // namespace osgGpuAnimation::fbx
