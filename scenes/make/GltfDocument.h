// SPDX-License-Identifier: MIT
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// What one mesh primitive is made of; an array that stays empty is not written.
struct PrimitiveArrays
{
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec4> tangents; ///< w: 1 or -1, the bitangent's side (glTF 2.0, 3.7.2.1)
    std::vector<glm::dvec2> textureCoordinates;
    std::vector<glm::dvec3> colours;                 ///< linear, [0, 1]
    std::vector<std::array<std::uint8_t, 4>> joints; ///< places in the skin's joint list
    std::vector<std::array<double, 4>> weights;      ///< sum 1
    std::vector<std::uint32_t> indices;              ///< triangles
};

/// A glTF 2.0 document with one buffer, built up element by element and written as a GLB.
/// All functions that add give the index of what they added. Numbers are rounded to steps of 2^-20, so that the
/// last bits of a machine's sine do not show in the file; times are written as given.
class GltfDocument
{
public:
    explicit GltfDocument(const std::string& sceneName);

    int addNode(const std::string& name, int parent, const glm::dvec3& translation = glm::dvec3(0.0),
                const glm::dquat& rotation = glm::dquat(1.0, 0.0, 0.0, 0.0));
    tinygltf::Node& node(int index) { return _model.nodes[index]; }

    /// A PNG picture with a mipmapped sampler. repeats: the picture repeats outside of [0, 1]; else its edge does.
    int addTexture(const std::string& name, const std::vector<std::uint8_t>& png, bool repeats = false);
    /// Records the material's extensions as used by the file.
    int addMaterial(const tinygltf::Material& material);

    /// A variant of KHR_materials_variants.
    int addVariant(const std::string& name);
    /// The material of the mesh's last primitive in a variant.
    void setVariantMaterial(int mesh, int variant, int material);

    int addMesh(const std::string& name);
    void addPrimitive(int mesh, const PrimitiveArrays& arrays, int material);
    /// A mesh with the vertices of another one's first primitive, and a material of its own.
    int addMeshLike(const std::string& name, int other, int material);
    /// skeleton: the node that all joints hang on.
    int addSkin(const std::string& name, const std::vector<int>& joints, const std::vector<glm::dmat4>& inverseBinds,
                int skeleton);

    /// times: seconds, shared by all channels of a clip; the sampler input that addChannel takes.
    int addTimes(const std::vector<double>& times);
    int addAnimation(const std::string& name);
    /// Into the animation's extras: {"markers": [{"name": …, "time": seconds}, …]}.
    void addMarker(int animation, double time, const std::string& name);
    void addTranslations(int animation, int node, int times, const std::vector<glm::dvec3>& values);
    void addRotations(int animation, int node, int times, const std::vector<glm::dquat>& values);

    /// Throws std::runtime_error where the file cannot be written.
    void write(const std::string& path);

private:
    int addView(const void* data, std::size_t bytes, int target);
    int addAccessor(int view, int componentType, int type, std::size_t count);
    int addFloats(const std::vector<double>& values, int type, int target, bool bounds);
    void addChannel(int animation, int node, const std::string& path, int times, int values);

    tinygltf::Model _model;
};

} // namespace osgGpuAnimation::scenes
