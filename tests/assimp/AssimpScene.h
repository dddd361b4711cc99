// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A file as Assimp has it, evaluated key by key in double precision: an opinion on poses that shares nothing with the
/// conversion.
class AssimpScene
{
public:
    explicit AssimpScene(const std::string& file);

    const aiScene* scene() const { return _scene; } ///< null: Assimp cannot read it
    double duration(unsigned int animation) const;  ///< seconds from the first key to the last
    /// The first key's time, in seconds.
    double start(unsigned int animation) const;

    /// The matrices of all nodes to the scene, by name; time: seconds of the animation.
    std::map<std::string, glm::dmat4> nodes(unsigned int animation, double time) const;
    /// The skinned vertices of a mesh of a node.
    std::vector<glm::dvec3> vertices(const aiMesh& mesh, const std::string& node,
                                     const std::map<std::string, glm::dmat4>& nodes) const;

private:
    Assimp::Importer _importer;
    const aiScene* _scene;
};

} // namespace osgGpuAnimation
