// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation
{

/// One property of an object of glTF's object model that the kit draws.
struct PropertyMember
{
    /// The kinds of objects.
    enum class Object
    {
        Material,
        Light, ///< of KHR_lights_punctual
        Camera,
        Node
    };

    Object object = Object::Material;
    std::string name;             ///< the pointer's part after the object, as `pbrMetallicRoughness/metallicFactor`
    std::size_t count = 1;        ///< numbers of a value, at most 4
    std::array<float, 4> rest{};  ///< the specification's default value
    float min = 0.0f;             ///< smaller numbers count as this
    float max = 1.0f;             ///< larger numbers count as this
    const char* uniform = "";     ///< of a material: the uniform that holds it
    std::size_t component = 0;    ///< its first number there
    std::string group{};          ///< members of one group are set together: a set has all or none; empty: no group
    bool isBoolean = false;       ///< 0: false
    std::string texture{};        ///< of a texture transform: the name of the texture, as `normalTexture`
    const char* define = nullptr; ///< likewise: the shader define with the number of its coordinates; null: number 0

    /// All that the kit draws.
    static const std::vector<PropertyMember>& all();
};

/// A pointer to a property: `/materials/0/alphaCutoff`.
struct PropertyPointer
{
    const PropertyMember* member = nullptr; ///< never null after parse()
    int index = 0;                          ///< of the file's materials, lights, cameras or nodes

    /// Nothing, if it is no pointer or points to nothing that the kit draws. Strict: no escapes, no leading zeros.
    static std::optional<PropertyPointer> parse(std::string_view pointer);
    /// The pointer to a member of an object.
    static std::string text(const PropertyMember& member, int index);
};

/// An index without sign and leading zeros, at most nine digits; nothing for any other text.
std::optional<int> parsePointerIndex(std::string_view text);

} // namespace osgGpuAnimation
