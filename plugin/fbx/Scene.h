// SPDX-License-Identifier: MIT
#pragma once

#include "fbx/Curve.h"
#include "fbx/Model.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::fbx
{

struct ModelTracks
{
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
    double begin = 0.0, end = 0.0;             ///< seconds of the file
    std::map<std::size_t, ModelTracks> models; ///< by the number of the model
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
