// SPDX-License-Identifier: MIT
#pragma once

#include <osg/CameraView>
#include <osg/Group>
#include <osg/LightSource>
#include <osg/observer_ptr>
#include <osg/StateSet>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class AnimationSet;
struct PoseInstruction;

// The properties of a file that clips animate beside joints and morph weights: factors and texture transforms of
// materials, lights, cameras, and the visibility of nodes. The set has their curves (see MorphWeights); the import
// marks the objects of the scene that they change.

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
    float least = 0.0f;           ///< smaller numbers count as this
    float most = 1.0f;            ///< larger numbers count as this
    bool isBoolean = false;       ///< 0: false
    std::string group{};          ///< members of one group are set together: a set has all or none; empty: no group
    const char* uniform = "";     ///< of a material: the uniform that holds it
    std::size_t component = 0;    ///< its first number there
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

// The marks of the import: user values, so that OSG's own serializers keep them. The numbers are the file's.
void markMaterial(osg::StateSet& stateSet, int material); ///< a material with animated properties
void markLight(osg::LightSource& source, int light);      ///< an animated light, a PunctualLight
void markCamera(osg::CameraView& view, int camera);       ///< an animated camera
bool isMarked(const osg::CameraView& view);               ///< by markCamera()
/// A drawable or a light. nodes: it is visible while all these nodes are.
void markVisibility(osg::Node& node, const std::vector<int>& nodes);

/// The name of the user value (double, scene units) that an osg::CameraView has if its projection is parallel: the
/// height of what it shows. OSG's CameraView has only fields of view.
constexpr const char* orthographicHeightName = "orthographicHeight";

/// Sets the matrix that a material applies to its texture coordinates: a uniform and the define of character.vert.
/// number: of the coordinates, 0 to 2. offset, rotation (radians), scale: of KHR_texture_transform.
void setTextureTransform(osg::StateSet& stateSet, int number, const float* offset, float rotation, const float* scale);

/// Adds the meshes that are direct children of a character to a crowd. In place of those that the character animates,
/// copies over the same arrays, which keep the present material and visibility.
void addUnanimated(const osg::Group& character, osg::Group& crowd);

/// The properties of one character. It writes to StateSets, lights and camera views of its own, so that copies of the
/// character show other times. A character whose set has no properties has none of these objects.
class AnimatedProperties
{
public:
    /// Null if the set has no properties.
    static std::unique_ptr<AnimatedProperties> of(const AnimationSet& set);

    /// Gives the character its own StateSets, lights and camera views in place of those that are marked. Direct
    /// children that other characters have too are replaced by copies over the same arrays. The next apply() sets all
    /// values.
    void bind(osg::Group& character);
    bool isBound() const { return _isBound; }

    /// Sets the values of the instruction. The set is that of the construction.
    void apply(const AnimationSet& set, const PoseInstruction& instruction);

private:
    struct Property
    {
        PropertyPointer pointer;
        std::size_t first; ///< of its numbers in _numbers
    };
    struct Material
    {
        int index;
        osg::ref_ptr<osg::StateSet> state;
    };
    struct Light
    {
        int index; ///< -1: only its visibility is animated
        osg::ref_ptr<osg::LightSource> source;
        osg::ref_ptr<osg::Light> shown; ///< the light while it is visible
        std::vector<int> nodes;         ///< see markVisibility()
        bool isVisible = true;
    };
    struct Camera
    {
        int index;
        osg::ref_ptr<osg::CameraView> view;
    };
    struct Hidable
    {
        osg::ref_ptr<osg::Node> node;
        std::vector<int> nodes;
        osg::Node::NodeMask mask = ~0u; ///< while it is visible
    };

    AnimatedProperties() = default;
    using OwnStates = std::map<const osg::StateSet*, osg::ref_ptr<osg::StateSet>>; ///< by the marked one
    void bindChildren(osg::Group& group, OwnStates& owned);
    void bindMesh(osg::Drawable& mesh);
    void bindBelow(osg::Node& node);
    /// The numbers that are shown, or the default; within the member's range.
    std::array<float, 4> valueOf(const PropertyMember& member, int index) const;
    bool isVisible(const std::vector<int>& nodes) const;
    void setMaterial(osg::StateSet& state, const PropertyPointer& pointer) const;
    void setLight(Light& light, bool hasChanged) const;
    void setCamera(osg::CameraView& view, const PropertyPointer& pointer) const;
    void setVisibility();

    std::vector<Property> _properties;
    std::map<std::pair<const PropertyMember*, int>, std::size_t> _firstNumbers; ///< by member and index, in _numbers
    std::vector<Material> _materials;
    std::vector<Light> _lights;
    std::vector<Camera> _cameras;
    std::vector<Hidable> _hidables;
    std::vector<float> _numbers, _shown; ///< of all properties
    bool _isBound = false;
};

} // namespace osgGpuAnimation
