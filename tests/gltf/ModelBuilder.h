// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The value of an extension from its JSON.
tinygltf::Value valueOf(const std::string& json);

/// Puts small glTF documents together for tests, in memory or as the text of a .gltf.
///
///     ModelBuilder file;
///     const int mesh = file.triangle();
///     const int node = file.node("arm", -1, mesh);
///     file.slidingClip("wave", node);
class ModelBuilder
{
public:
    ModelBuilder();

    tinygltf::Model model;

    int floats(int type, const std::vector<float>& numbers);
    int integers(int type, int componentType, const std::vector<unsigned int>& numbers);

    /// A mesh of one primitive over these attributes; indices -1: none.
    int mesh(const std::map<std::string, int>& attributes, int mode = TINYGLTF_MODE_TRIANGLES, int indices = -1);
    /// A mesh of one triangle, (0,0,0) (1,0,0) (0,1,0), with normals.
    int triangle();
    /// The same triangle with JOINTS_0 (first and second joint) and WEIGHTS_0 (0.5 each).
    int skinnedTriangle();
    tinygltf::Primitive& primitive(int mesh) { return model.meshes[static_cast<std::size_t>(mesh)].primitives[0]; }

    /// A node below the parent; -1: a root of the scene.
    int node(const std::string& name, int parent = -1, int mesh = -1);
    tinygltf::Node& at(int node) { return model.nodes[static_cast<std::size_t>(node)]; }
    /// A node with a light, or with one more place of a light of the file.
    int lamp(const tinygltf::Light& light, const std::string& name = "lamp", const std::vector<double>& place = {},
             int parent = -1);
    int lamp(int light, const std::string& name, const std::vector<double>& place = {}, int parent = -1);
    /// A texture of that picture, which text() leaves out; of none, for materials that need texture coordinates.
    int texture(const std::string& picture = "");
    /// A skin without inverse binds.
    int skin(const std::vector<int>& joints);
    /// An animation without channels.
    int animation(const std::string& name);
    /// Adds a channel with its own sampler to the last animation.
    void channel(int node, const std::string& path, const std::vector<float>& times, int type,
                 const std::vector<float>& values, const std::string& interpolation = "LINEAR");
    /// A translation from 0 to (1, 0, 0) in one second.
    void slide(int node) { channel(node, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0}); }

    /// An animation that slides the node.
    void slidingClip(const std::string& name, int node)
    {
        animation(name);
        slide(node);
    }

    /// The text of a .gltf file with its buffers inside.
    std::string text() const;

private:
    int accessor(int type, int componentType, std::size_t count, const void* data, std::size_t bytes);
};

} // namespace osgGpuAnimation::gltf
