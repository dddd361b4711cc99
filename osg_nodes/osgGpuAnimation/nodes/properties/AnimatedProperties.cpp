// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/PosedMeshSource.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Drawable>
#include <osg/LOD>
#include <osg/Material>
#include <osg/Math>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace osgGpuAnimation
{

namespace
{

using Object = PropertyMember::Object;

const char* const maskKey = "osgGpuAnimation.nodeMask";
const char* const transformsName = "textureTransforms";

const char* const emissiveStrengthName = "extensions/KHR_materials_emissive_strength/emissiveStrength";
const char* const iorName = "extensions/KHR_materials_ior/ior";
const char* const specularColorName = "extensions/KHR_materials_specular/specularColorFactor";

/// name: one of PropertyMember::all().
const PropertyMember& memberNamed(Object object, std::string_view name)
{
    static const auto members = []
    {
        std::map<std::pair<Object, std::string_view>, const PropertyMember*> byName;
        for (const PropertyMember& member : PropertyMember::all())
            byName[{member.object, member.name}] = &member;
        return byName;
    }();
    return *members.at({object, name});
}

/// Writes numbers into a uniform of floats or vectors; nothing if there is none.
void setNumbers(osg::StateSet& state, const char* name, std::size_t first, std::size_t count, const float* numbers)
{
    osg::Uniform* uniform = state.getUniform(name);
    osg::FloatArray* array = uniform ? uniform->getFloatArray() : nullptr;
    if (!array || array->size() < first + count) return;
    std::copy_n(numbers, count, array->begin() + static_cast<std::ptrdiff_t>(first));
    uniform->dirty();
}

/// The coordinates of the map; nothing if the material does not show it.
std::optional<int> coordinatesOf(const osg::StateSet& state, const char* define)
{
    if (!define) return 0;
    const auto found = state.getDefineList().find(define);
    if (found == state.getDefineList().end()) return std::nullopt;
    return parsePointerIndex(found->second.first);
}

/// A StateSet whose uniforms and material are its own.
osg::ref_ptr<osg::StateSet> ownState(const osg::StateSet& state)
{
    osg::ref_ptr<osg::StateSet> own = new osg::StateSet(state, osg::CopyOp::DEEP_COPY_UNIFORMS);
    if (const osg::StateAttribute* material = state.getAttribute(osg::StateAttribute::MATERIAL))
        own->setAttribute(osg::clone(material, osg::CopyOp::SHALLOW_COPY));
    own->setDataVariance(osg::Object::DYNAMIC); // the next update waits until it is drawn
    return own;
}

/// The mask that the application gives the mesh: 0 hides it whatever the clips do.
osg::Node::NodeMask applicationMask(const osg::Node& mesh)
{
    unsigned int mask = ~0u; // of hidden meshes as they are imported
    if (mesh.getNodeMask() != 0) return mesh.getNodeMask();
    return mesh.getUserValue(maskKey, mask) ? mask : ~0u;
}

/// For applicationMask() while the mesh has the node mask 0. Copies and stored scenes keep it.
void storeMask(osg::Node& mesh, osg::Node::NodeMask mask)
{
    unsigned int stored = 0;
    if (mesh.getUserValue(maskKey, stored) && stored == mask) return;
    const osg::UserDataContainer* data = mesh.getUserDataContainer();
    if (data && data->referenceCount() > 1) ownUserData(mesh);
    mesh.setUserValue(maskKey, static_cast<unsigned int>(mask));
}

/// A hidden light keeps the shown one as a user object.
osg::Light* shownLight(osg::Light& light)
{
    const osg::UserDataContainer* data = light.getUserDataContainer();
    for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
        if (const auto* shown = dynamic_cast<const osg::Light*>(data->getUserObject(i)))
            return const_cast<osg::Light*>(shown);
    return nullptr;
}

/// Calls visit for the lights and camera views at and below a node, but for those of other characters below.
template <typename Visit>
class MarkedNodes : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    explicit MarkedNodes(Visit visit) : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN), _visit(std::move(visit))
    {
        setNodeMaskOverride(~0u);
    }
    void apply(osg::Group& group) override
    {
        if (!dynamic_cast<PosedMeshSource*>(&group)) traverse(group);
    }
    void apply(osg::LightSource& source) override
    {
        if (markOf(source, lightMark) || !visibilityOf(source).empty()) _visit(source);
        traverse(source);
    }
    void apply(osg::CameraView& view) override
    {
        if (markOf(view, cameraMark)) _visit(view);
        traverse(view);
    }

private:
    Visit _visit;
};

template <typename Visit>
void forEachMarked(osg::Node& node, Visit visit)
{
    MarkedNodes<Visit> visitor(std::move(visit));
    node.accept(visitor);
}

} // namespace

void setTextureTransform(osg::StateSet& stateSet, int number, const float* offset, float rotation, const float* scale)
{
    constexpr int rows = 6; // two for each of three coordinates
    osg::Uniform* uniform = stateSet.getUniform(transformsName);
    if (!uniform)
    {
        uniform = new osg::Uniform(osg::Uniform::FLOAT_VEC3, transformsName, rows);
        for (unsigned int row = 0; row < rows; ++row)
            uniform->setElement(row, row % 2 == 0 ? osg::Vec3(1, 0, 0) : osg::Vec3(0, 1, 0));
        stateSet.addUniform(uniform);
        stateSet.setDefine("MATERIAL_TEXTURE_TRANSFORM", "1");
    }
    // Of the specification's u and v, which runs down: the vertices have 1 - v, and so has the result.
    const float u[] = {std::cos(rotation) * scale[0], std::sin(rotation) * scale[1], offset[0]};
    const float v[] = {-std::sin(rotation) * scale[0], std::cos(rotation) * scale[1], offset[1]};
    const auto row = static_cast<unsigned int>(2 * number);
    if (row + 1 >= uniform->getNumElements()) return;
    uniform->setElement(row, osg::Vec3(u[0], -u[1], u[1] + u[2]));
    uniform->setElement(row + 1, osg::Vec3(-v[0], v[1], 1.0f - v[1] - v[2]));
}

UnanimatedMeshes::UnanimatedMeshes(const AnimationSet& set) : _properties(AnimatedProperties::of(set)) {}

UnanimatedMeshes::~UnanimatedMeshes() = default;

osg::StateSet* UnanimatedMeshes::stateAtRest(osg::StateSet* state)
{
    const std::optional<int> material = state ? markOf(*state, materialMark) : std::nullopt;
    if (!material) return state;
    osg::ref_ptr<osg::StateSet>& own = _states[state];
    if (own) return own;
    own = ownState(*state);
    own->setDataVariance(osg::Object::STATIC);
    removeMark(*own, materialMark);
    if (!_properties) return own;
    for (const AnimatedProperties::Property& property : _properties->_properties)
        if (property.pointer.member->object == Object::Material && property.pointer.index == *material)
            _properties->setMaterial(*own, property.pointer);
    return own;
}

void UnanimatedMeshes::release(osg::Geometry& copy)
{
    const std::vector<std::string> names = variantNamesOf(copy);
    bool isMarked = isMeshMarked(copy);
    const auto stateOf = [&](const std::string& variant)
    {
        osg::StateSet* state = variantState(copy, variant);
        const osg::ref_ptr<osg::StateSet> atRest = stateAtRest(state);
        isMarked = isMarked || atRest != state;
        return atRest;
    };
    const osg::ref_ptr<osg::StateSet> defaultState = stateOf("");
    std::vector<VariantState> variants;
    for (const std::string& name : names)
        variants.push_back({name, stateOf(name)});
    if (!isMarked) return;
    if (const std::vector<int> nodes = visibilityOf(copy); !nodes.empty())
    {
        const bool isShown = !_properties || _properties->isVisible(nodes);
        copy.setNodeMask(isShown ? applicationMask(copy) : 0);
    }
    copy.setStateSet(stateAtRest(copy.getStateSet()));
    removeMark(copy, visibilityMark); // gives the copy its own user data, which the variants belong to
    if (!names.empty()) setVariantStates(copy, defaultState, variants);
}

void addUnanimated(const osg::Group& character, const AnimationSet& set, osg::Group& crowd)
{
    UnanimatedMeshes unanimated(set);
    forEachMesh(character,
                [&](const SkinnedGeometry& mesh)
                {
                    osg::ref_ptr<SkinnedGeometry> added = const_cast<SkinnedGeometry*>(&mesh);
                    if (isMeshMarked(mesh)) added = osg::clone(&mesh, osg::CopyOp::SHALLOW_COPY);
                    if (added != &mesh) unanimated.release(*added);
                    crowd.addChild(added);
                });
}

std::unique_ptr<AnimatedProperties> AnimatedProperties::of(const AnimationSet& set)
{
    std::unique_ptr<AnimatedProperties> made;
    std::size_t first = 0;
    for (const MorphWeights& morph : set.morphs())
    {
        if (!morph.isProperty()) continue;
        if (!made) made.reset(new AnimatedProperties);
        // A saved scene may hold any set.
        const std::optional<PropertyPointer> pointer = PropertyPointer::parse(morph.name);
        if (pointer && pointer->member->count == morph.defaults.size())
        {
            made->_properties.push_back({*pointer, first});
            made->_firstNumbers[{pointer->member, pointer->index}] = first;
        }
        first += morph.defaults.size();
        made->_numbers.insert(made->_numbers.end(), morph.defaults.begin(), morph.defaults.end());
    }
    return made;
}

void AnimatedProperties::bind(osg::Group& character)
{
    _materials.clear();
    _lights.clear();
    _cameras.clear();
    _hidables.clear();
    _shown.clear();
    _isBound = true;
    OwnStates owned;
    bindChildren(character, owned);
    _hasApplicationMasks = false;
}

void AnimatedProperties::restoreMasks()
{
    for (const Hidable& hidable : _hidables)
        hidable.mesh->setNodeMask(applicationMask(*hidable.mesh));
    _hasApplicationMasks = _isBound;
}

void AnimatedProperties::bindChildren(osg::Group& character, OwnStates& owned)
{
    for (unsigned int i = 0; i < character.getNumChildren(); ++i)
    {
        osg::ref_ptr<osg::Node> child = character.getChild(i);
        osg::Drawable* mesh = child->asDrawable();
        bool isNeeded = mesh && isMeshMarked(*mesh);
        if (!mesh) forEachMarked(*child, [&](osg::Node&) { isNeeded = true; });
        auto* levels = dynamic_cast<osg::LOD*>(child.get()); // of one mesh of the file
        for (unsigned int level = 0; levels && level < levels->getNumChildren(); ++level)
            isNeeded = isNeeded ||
                       (levels->getChild(level)->asDrawable() && isMeshMarked(*levels->getChild(level)->asDrawable()));
        if (!isNeeded) continue;
        if (child->getNumParents() > 1)
        {
            child = osg::clone(child.get(), mesh ? osg::CopyOp::SHALLOW_COPY : osg::CopyOp::DEEP_COPY_NODES);
            character.setChild(i, child);
            mesh = child->asDrawable();
        }
        if (!mesh)
        {
            if (auto* own = dynamic_cast<osg::LOD*>(child.get())) bindChildren(*own, owned);
            bindBelow(*child);
            continue;
        }
        osg::StateSet* state = mesh->getStateSet();
        if (const auto material = state ? markOf(*state, materialMark) : std::nullopt)
        {
            osg::ref_ptr<osg::StateSet>& own = owned[state];
            if (!own)
            {
                own = ownState(*state);
                _materials.push_back({*material, own});
            }
            mesh->setStateSet(own);
        }
        if (std::vector<int> nodes = visibilityOf(*mesh); !nodes.empty())
        {
            if (_hasApplicationMasks && mesh->getNodeMask() == 0) storeMask(*mesh, 0);
            _hidables.push_back({mesh, std::move(nodes)});
        }
    }
}

void AnimatedProperties::bindBelow(osg::Node& node)
{
    forEachMarked(node,
                  [&](osg::Node& marked)
                  {
                      if (auto* view = dynamic_cast<osg::CameraView*>(&marked))
                          return _cameras.push_back({*markOf(*view, cameraMark), view});
                      auto& source = static_cast<osg::LightSource&>(marked);
                      osg::Light* light = source.getLight();
                      if (!light) return;
                      osg::Light* shown = shownLight(*light);
                      _lights.push_back({markOf(source, lightMark).value_or(-1), &source, shown ? shown : light,
                                         visibilityOf(source), shown == nullptr});
                  });
}

std::array<float, 4> AnimatedProperties::valueOf(const PropertyMember& member, int index) const
{
    std::array<float, 4> value = member.rest;
    const auto first = _firstNumbers.find({&member, index});
    for (std::size_t i = 0; first != _firstNumbers.end() && i < member.count; ++i)
        value[i] = std::clamp(_numbers[first->second + i], member.min, member.max);
    return value;
}

bool AnimatedProperties::isVisible(const std::vector<int>& nodes) const
{
    static const PropertyMember& visible = memberNamed(Object::Node, "extensions/KHR_node_visibility/visible");
    return std::all_of(nodes.begin(), nodes.end(), [&](int node) { return valueOf(visible, node)[0] >= 0.5f; });
}

void AnimatedProperties::setMaterial(osg::StateSet& state, const PropertyPointer& pointer) const
{
    const PropertyMember& member = *pointer.member;
    const auto value = [&](std::string_view name)
    { return valueOf(memberNamed(Object::Material, name), pointer.index); };
    const std::array<float, 4> own = valueOf(member, pointer.index);
    setNumbers(state, member.uniform, member.component, member.count, own.data());
    auto* colors = static_cast<osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL));
    if (colors && member.name == "pbrMetallicRoughness/baseColorFactor")
    {
        const osg::Vec4 color = displayColor(osg::Vec4(own[0], own[1], own[2], own[3]));
        colors->setDiffuse(osg::Material::FRONT_AND_BACK, color);
        colors->setAmbient(osg::Material::FRONT_AND_BACK, color);
    }
    if (colors && member.group == "emission")
    {
        const std::array<float, 4> emissive = value("emissiveFactor");
        const bool isPbr = state.getDefineList().count("MATERIAL_PBR") > 0; // which multiplies the strength later
        const float strength = isPbr ? 1.0f : value(emissiveStrengthName)[0];
        colors->setEmission(osg::Material::FRONT_AND_BACK,
                            displayColor(osg::Vec4(osg::Vec3(emissive[0], emissive[1], emissive[2]) * strength, 1)));
    }
    if (member.group == "reflection")
    {
        const float ior = value(iorName)[0];
        const float amplitude = ior > 0.0f ? (ior - 1.0f) / (ior + 1.0f) : 1.0f; // 0 stands for infinity
        std::array<float, 4> color = value(specularColorName);
        for (float& channel : color)
            channel *= amplitude * amplitude;
        setNumbers(state, "materialSpecular", 0, 3, color.data());
    }
    if (member.texture.empty()) return;
    const std::optional<int> number = coordinatesOf(state, member.define);
    const std::string transform = member.texture + "/extensions/KHR_texture_transform/";
    if (number && state.getUniform(transformsName))
        setTextureTransform(state, *number, value(transform + "offset").data(), value(transform + "rotation")[0],
                            value(transform + "scale").data());
}

// Cull traversals of the last frame may still refer to the light, so another one replaces it.
void AnimatedProperties::setLight(Light& light, bool hasChanged) const
{
    const bool isShown = isVisible(light.nodes);
    if (!hasChanged && isShown == light.isVisible) return;
    light.isVisible = isShown;
    const auto value = [&](const char* name) { return valueOf(memberNamed(Object::Light, name), light.index); };
    osg::ref_ptr<osg::Light> made = osg::clone(light.shown.get(), osg::CopyOp::SHALLOW_COPY);
    auto* punctual = dynamic_cast<PunctualLight*>(made.get());
    if (hasChanged && punctual)
    {
        const std::array<float, 4> color = value("color");
        static_cast<void>(punctual->setIntensity(osg::Vec3(color[0], color[1], color[2]), value("intensity")[0]));
        static_cast<void>(punctual->setRange(value("range")[0]));
        const auto outer = static_cast<float>(osg::RadiansToDegrees(value("spot/outerConeAngle")[0]));
        const auto inner = static_cast<float>(osg::RadiansToDegrees(value("spot/innerConeAngle")[0]));
        const float cutoff = std::min(90.0f, outer); // pi / 2 as a float is more than 90 degrees
        if (punctual->getKind() == PunctualLight::Kind::Spot)
            static_cast<void>(punctual->setCone(std::min(inner, cutoff * 0.9999f), cutoff));
        light.shown = osg::clone(made.get(), osg::CopyOp::SHALLOW_COPY);
    }
    if (!isShown) // the modes of the StateSet remain on
    {
        made->setDiffuse(osg::Vec4(0, 0, 0, 1));
        made->setSpecular(osg::Vec4(0, 0, 0, 1));
        ownUserData(*made).addUserObject(light.shown);
    }
    light.source->setLight(made);
}

void AnimatedProperties::setCamera(osg::CameraView& view, const PropertyPointer& pointer) const
{
    const float value = valueOf(*pointer.member, pointer.index)[0];
    if (pointer.member->name == "perspective/yfov")
        view.setFieldOfView(osg::RadiansToDegrees(static_cast<double>(value)));
    else if (value != 0.0f)
        view.setUserValue(orthographicHeightName, 2.0 * std::abs(static_cast<double>(value)));
}

void AnimatedProperties::apply(const AnimationSet& set, const PoseInstruction& instruction)
{
    Pose::properties(set, instruction, _numbers);
    if (_numbers == _shown) return;
    bool isVisibilityChanged = false;
    std::vector<int> lights;
    for (const Property& property : _properties)
    {
        const PropertyMember& member = *property.pointer.member;
        const auto first = static_cast<std::ptrdiff_t>(property.first);
        if (_shown.size() == _numbers.size() &&
            std::equal(_numbers.begin() + first, _numbers.begin() + first + static_cast<std::ptrdiff_t>(member.count),
                       _shown.begin() + first))
            continue;
        if (member.object == Object::Node) isVisibilityChanged = true;
        if (member.object == Object::Light) lights.push_back(property.pointer.index);
        for (const auto& [index, state] : _materials)
            if (member.object == Object::Material && index == property.pointer.index)
                setMaterial(*state, property.pointer);
        for (const auto& [index, view] : _cameras)
            if (member.object == Object::Camera && index == property.pointer.index) setCamera(*view, property.pointer);
    }
    for (Light& light : _lights)
        setLight(light, std::find(lights.begin(), lights.end(), light.index) != lights.end());
    _shown = _numbers;
    if (!isVisibilityChanged) return;
    for (const Hidable& hidable : _hidables)
    {
        const bool isShown = isVisible(hidable.nodes);
        const osg::Node::NodeMask mask = hidable.mesh->getNodeMask();
        if (isShown == (mask != 0)) continue;
        if (!isShown) storeMask(*hidable.mesh, mask);
        hidable.mesh->setNodeMask(isShown ? applicationMask(*hidable.mesh) : 0);
    }
}

} // namespace osgGpuAnimation
