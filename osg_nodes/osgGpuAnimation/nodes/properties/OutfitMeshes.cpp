// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/OutfitMeshes.h>

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/detail/RigidMeshes.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <layout.glsl>

#include <osg/Texture2D>

#include <algorithm>
#include <set>

namespace osgGpuAnimation
{

namespace
{

static_assert(OutfitLists::maxOutfits + 1 <= POSE_OUTFITS_PER_VECTOR * POSE_OUTFIT_VECTORS);
static_assert(POSE_OUTFITS_PER_VECTOR == 4, "the components of a vector");

/// The base-colour texture with another picture; of a material without one a repeated texture.
osg::ref_ptr<osg::Texture2D> picturedTexture(const osg::StateSet& state, osg::Image& picture)
{
    const auto* present =
        dynamic_cast<const osg::Texture2D*>(state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    osg::ref_ptr<osg::Texture2D> texture;
    if (present && !isWhiteTexture(present))
        texture = osg::clone(present, osg::CopyOp::SHALLOW_COPY);
    else
    {
        texture = new osg::Texture2D;
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
        if (pbrMaterialOf(state)) texture->setInternalFormat(GL_SRGB8_ALPHA8);
    }
    texture->setImage(&picture);
    return texture;
}

bool isColor(const osg::Vec4& color)
{
    for (int i = 0; i < 4; ++i)
        if (!(color[i] >= 0.0f && color[i] <= 1.0f)) return false;
    return true;
}

/// The value of a key; null: there is none.
template <typename Map>
const typename Map::mapped_type* find(const Map& map, const typename Map::key_type& key)
{
    const auto found = map.find(key);
    return found == map.end() ? nullptr : &found->second;
}

osg::ref_ptr<osg::Uniform> whiteColors()
{
    osg::ref_ptr<osg::Uniform> uniform =
        new osg::Uniform(osg::Uniform::UNSIGNED_INT_VEC4, "poseOutfitColors", POSE_OUTFIT_VECTORS);
    for (unsigned int vector = 0; vector < POSE_OUTFIT_VECTORS; ++vector)
        uniform->setElement(vector, ~0u, ~0u, ~0u, ~0u);
    return uniform;
}

/// The number shows the mesh in that state.
template <typename States>
void addTo(States& states, osg::StateSet* state, std::size_t number)
{
    const auto isSame = [&](const auto& known) { return known.first == state; };
    auto known = std::find_if(states.begin(), states.end(), isSame);
    if (known == states.end()) known = states.insert(known, {state, OutfitLists::Outfits()});
    known->second.set(number);
}

/// The geometries below a prop's node as rigid meshes on the palette entry of its joint, with the kit's program and the
/// state of the nodes above them. Arrays that need no transform are shared.
/// Errors: no node; no such joint; a joint that no palette entry follows; a matrix that is not affine, mirrors or has
/// no inverse; no osg::Geometry with osg::Vec3Array vertices, as in animated models.
Result<std::vector<osg::ref_ptr<SkinnedGeometry>>> propMeshes(const Outfit::Prop& prop, const AnimationSet& set)
{
    const std::string subject = "the prop on joint \"" + prop.joint + "\": ";
    if (!prop.node) return Error{subject + "it has no node"};
    const Result<std::size_t> joint = set.skeleton().jointNamed(prop.joint);
    if (!joint) return Error{subject + joint.error().message};
    const auto follows = [&](const PaletteEntry& entry) { return entry.joint == static_cast<int>(joint.value()); };
    const auto entry = std::find_if(set.palette().begin(), set.palette().end(), follows);
    if (entry == set.palette().end()) return Error{subject + "it moves no mesh of the crowd"};
    if (const Result<AffineMatrix> checked = toRootMatrix(prop.toJoint, "the transform to the joint", true); !checked)
        return Error{subject + checked.error().message};
    const osg::Matrixd toEntry = prop.toJoint * osg::Matrixd::inverse(toOsg(entry->inverseBind));
    if (!toEntry.valid()) return Error{subject + "its inverse bind matrix has no inverse"};
    RigidMeshes made = RigidMeshes::of(*prop.node, static_cast<unsigned short>(entry - set.palette().begin()), toEntry);
    if (made.meshes.empty())
        return Error{subject + "\"" + prop.node->getName() + "\" has no still geometry with vertices of three floats"};
    return std::move(made.meshes);
}

} // namespace

OutfitMeshes::Number OutfitMeshes::numberOf(const Outfit* outfit) const
{
    if (!outfit) return 0;
    const auto found = std::find(_outfits.begin(), _outfits.end(), outfit);
    return found == _outfits.end() ? Number(0) : static_cast<Number>(found - _outfits.begin() + 1);
}

Outfit* OutfitMeshes::outfit(Number number) const
{
    return number == 0 || number > _outfits.size() ? nullptr : _outfits[number - 1u].get();
}

std::vector<osg::ref_ptr<Outfit>> OutfitMeshes::all() const
{
    std::vector<osg::ref_ptr<Outfit>> outfits;
    for (const osg::ref_ptr<Outfit>& outfit : _outfits)
        if (outfit) outfits.push_back(outfit);
    return outfits;
}

Result<void> OutfitMeshes::check(const osg::Group& crowd, const AnimationSet& set, const Outfit* outfit)
{
    if (!outfit) return Error{"there is no outfit"};
    const std::string subject = "outfit \"" + outfit->getName() + "\": ";
    const std::vector<std::string> variants = variantNamesIn(crowd);
    std::set<std::string> materials;
    const auto addMaterial = [&](const osg::StateSet* state)
    {
        if (state && !state->getName().empty()) materials.insert(state->getName());
    };
    const auto addMaterials = [&](const SkinnedGeometry& mesh)
    {
        addMaterial(mesh.getStateSet());
        for (const std::string& variant : variants)
            addMaterial(variantState(mesh, variant));
    };
    forEachMesh(crowd, addMaterials);
    for (const Outfit::Prop& prop : outfit->getProps())
    {
        const Result<const PropMesh*> known = propMesh(prop, set);
        if (!known) return Error{subject + known.error().message};
        for (const osg::ref_ptr<SkinnedGeometry>& mesh : known.value()->meshes)
            addMaterial(mesh->getStateSet());
    }
    for (const auto& [part, isVisible] : outfit->getVisibility())
        if (const auto meshes = meshesNamed(crowd, part); !meshes) return Error{subject + meshes.error().message};
    if (!outfit->getVariant().empty() &&
        std::find(variants.begin(), variants.end(), outfit->getVariant()) == variants.end())
        return Error{subject + "there is no material variant \"" + outfit->getVariant() + "\"; the variants are " +
                     quotedNames(variants)};
    for (const auto& [joint, scale] : outfit->getJointScales())
    {
        if (const auto known = set.skeleton().jointNamed(joint); !known) return Error{subject + known.error().message};
        for (int axis = 0; axis < 3; ++axis)
            if (!(scale[axis] >= 0.1f && scale[axis] <= 10.0f))
                return Error{subject + "the scale of joint \"" + joint + "\" is not in [0.1, 10]"};
    }
    const auto unknown = [&](const std::string& material)
    {
        return Error{subject + "there is no material \"" + material + "\"; the materials are " +
                     quotedNames(std::vector<std::string>(materials.begin(), materials.end()))};
    };
    for (const auto& [material, color] : outfit->getColors())
    {
        if (materials.count(material) == 0) return unknown(material);
        if (!isColor(color)) return Error{subject + "the colour of \"" + material + "\" is not in [0, 1]"};
    }
    for (const auto& [material, picture] : outfit->getPictures())
    {
        if (materials.count(material) == 0) return unknown(material);
        if (!picture || !picture->valid()) return Error{subject + "the picture of \"" + material + "\" is empty"};
    }
    return {};
}

Result<const OutfitMeshes::PropMesh*> OutfitMeshes::propMesh(const Outfit::Prop& prop, const AnimationSet& set)
{
    for (const PropMesh& known : _props)
        if (known.prop == prop) return &known;
    Result<std::vector<osg::ref_ptr<SkinnedGeometry>>> meshes = propMeshes(prop, set);
    if (!meshes) return meshes.error();
    _props.push_back({prop, std::move(meshes).value()});
    return &_props.back();
}

Result<void> OutfitMeshes::add(const osg::Group& crowd, const AnimationSet& set, Outfit* outfit)
{
    if (numberOf(outfit) != 0) return Error{"the crowd has the outfit \"" + outfit->getName() + "\" already"};
    if (const Result<void> checked = check(crowd, set, outfit); !checked) return checked;
    const auto free = std::find_if(_outfits.begin(), _outfits.end(), [](const auto& known) { return !known; });
    if (free != _outfits.end())
        *free = outfit;
    else if (_outfits.size() == OutfitLists::maxOutfits)
        return Error{"the crowd has " + std::to_string(_outfits.size()) + " outfits, the most that one can have"};
    else
        _outfits.emplace_back(outfit);
    make(crowd);
    return {};
}

Result<void> OutfitMeshes::replace(const osg::Group& crowd, const AnimationSet& set, Number number, Outfit* by)
{
    if (by != outfit(number) && numberOf(by) != 0)
        return Error{"the crowd has the outfit \"" + by->getName() + "\" already"};
    if (const Result<void> checked = check(crowd, set, by); !checked) return checked;
    _outfits[number - 1u] = by;
    make(crowd);
    return {};
}

void OutfitMeshes::remove(const osg::Group& crowd, Number number)
{
    _outfits[number - 1u] = nullptr;
    while (!_outfits.empty() && !_outfits.back())
        _outfits.pop_back();
    make(crowd);
}

bool OutfitMeshes::update(const osg::Group& crowd)
{
    std::size_t count = 0;
    bool isSame = true;
    forEachMesh(crowd,
                [&](const SkinnedGeometry& mesh)
                {
                    isSame = isSame && count < _sources.size() && _sources[count].isOf(mesh);
                    ++count;
                });
    if (isSame && count == _sources.size()) return false;
    make(crowd);
    return true;
}

/// function(Number, const Outfit&), for each outfit.
template <typename Function>
void OutfitMeshes::forEachOutfit(Function function) const
{
    for (std::size_t i = 0; i < _outfits.size(); ++i)
        if (_outfits[i]) function(static_cast<Number>(i + 1), *_outfits[i]);
}

/// The colours of each material that some outfit colours, white for the others. A uniform does not change: draws of the
/// frame before may read it.
void OutfitMeshes::makeUniforms()
{
    std::map<std::string, osg::ref_ptr<osg::Uniform>> made;
    forEachOutfit(
        [&](Number number, const Outfit& outfit)
        {
            for (const auto& [material, color] : outfit.getColors())
            {
                osg::ref_ptr<osg::Uniform>& uniform = made[material];
                if (!uniform) uniform = whiteColors();
                const unsigned int vector = number / POSE_OUTFITS_PER_VECTOR;
                unsigned int colors[POSE_OUTFITS_PER_VECTOR] = {};
                uniform->getElement(vector, colors[0], colors[1], colors[2], colors[3]);
                colors[number % POSE_OUTFITS_PER_VECTOR] = toRgba(color);
                uniform->setElement(vector, colors[0], colors[1], colors[2], colors[3]);
            }
        });
    for (auto& [material, uniform] : made)
        if (const osg::ref_ptr<osg::Uniform>* known = find(_colors, material); known && **known == *uniform)
            uniform = *known;
    _colors = std::move(made);
}

/// The StateSet with the outfit's picture, and with the colours of all outfits. outfit: null: without a picture.
osg::StateSet* OutfitMeshes::stateFor(osg::StateSet* state, const Outfit* outfit)
{
    if (!state) return nullptr;
    const osg::ref_ptr<osg::Image>* picture = outfit ? find(outfit->getPictures(), state->getName()) : nullptr;
    const osg::ref_ptr<osg::Uniform>* colors = find(_colors, state->getName());
    if (!picture && !colors) return state;
    const Derivation key(state, picture ? picture->get() : nullptr, colors ? colors->get() : nullptr);
    osg::ref_ptr<osg::StateSet>& derived = _states[key];
    if (derived) return derived;
    if (const osg::ref_ptr<osg::StateSet>* known = find(_statesBefore, key)) return derived = *known;
    derived = osg::clone(state, osg::CopyOp::SHALLOW_COPY);
    if (picture) derived->setTextureAttributeAndModes(0, picturedTexture(*state, **picture));
    if (!colors) return derived;
    derived->addUniform(*colors);
    derived->setDefine("POSE_OUTFIT_COLORS");
    derived->setDefine("POSE_TINTED");
    return derived;
}

/// The copy of the last make(), whose GL objects and levels of detail exist, or a new one.
osg::ref_ptr<SkinnedGeometry> OutfitMeshes::copyOf(SkinnedGeometry& mesh, osg::StateSet* state) const
{
    for (const Shown& known : _before)
        if (known.mesh == &mesh && known.copy->getStateSet() == state) return known.copy;
    osg::ref_ptr<SkinnedGeometry> copy = osg::clone(&mesh, osg::CopyOp::SHALLOW_COPY);
    copy->setStateSet(state);
    return copy;
}

void OutfitMeshes::show(SkinnedGeometry& mesh, bool isOwn, const States& states)
{
    for (const auto& [state, outfits] : states)
    {
        const osg::ref_ptr<SkinnedGeometry> copy = copyOf(mesh, state);
        copy->setNodeMask(mesh.getNodeMask() != 0 ? mesh.getNodeMask() : ~0u);
        _meshes->addChild(copy);
        const auto known = std::find(_lists.lists.begin(), _lists.lists.end(), outfits);
        _lists.meshes[copy].list = static_cast<std::size_t>(known - _lists.lists.begin());
        if (known == _lists.lists.end()) _lists.lists.push_back(outfits);
        const bool isAsInCrowd = isOwn && state == mesh.getStateSet() && mesh.getNodeMask() != 0;
        _shown.push_back({&mesh, copy, isAsInCrowd, outfits});
    }
}

void OutfitMeshes::showOwn(SkinnedGeometry& mesh, const std::vector<std::map<const SkinnedGeometry*, bool>>& visibility)
{
    States states;
    if (mesh.getNodeMask() != 0) addTo(states, stateFor(mesh.getStateSet(), nullptr), 0);
    forEachOutfit(
        [&](Number number, const Outfit& outfit)
        {
            const auto wanted = visibility[number].find(&mesh);
            const bool isVisible = wanted == visibility[number].end() ? mesh.getNodeMask() != 0 : wanted->second;
            if (!isVisible) return;
            osg::StateSet* const varied =
                outfit.getVariant().empty() ? nullptr : variantState(mesh, outfit.getVariant());
            addTo(states, stateFor(varied ? varied : mesh.getStateSet(), &outfit), number);
        });
    show(mesh, true, states);
}

void OutfitMeshes::showProps()
{
    const auto isOf = [](const Outfit& outfit, const Outfit::Prop& prop)
    { return std::find(outfit.getProps().begin(), outfit.getProps().end(), prop) != outfit.getProps().end(); };
    for (auto prop = _props.begin(); prop != _props.end();)
    {
        bool isUsed = false;
        for (const osg::ref_ptr<SkinnedGeometry>& mesh : prop->meshes)
        {
            States states;
            forEachOutfit(
                [&](Number number, const Outfit& outfit)
                {
                    if (isOf(outfit, prop->prop)) addTo(states, stateFor(mesh->getStateSet(), &outfit), number);
                });
            isUsed = isUsed || !states.empty();
            show(*mesh, false, states);
        }
        prop = isUsed ? std::next(prop) : _props.erase(prop);
    }
}

void OutfitMeshes::make(const osg::Group& crowd)
{
    if (!_shown.empty()) _before = std::move(_shown);
    if (!_states.empty()) _statesBefore = std::move(_states);
    _states.clear();
    _meshes->removeChildren(0, _meshes->getNumChildren());
    _sources.clear();
    _shown.clear();
    _lists.meshes.clear();
    // The list of all instances has the numbers that they may have: lists are equal if they have the same instances.
    _lists.lists = {OutfitLists::Outfits(1)};
    forEachOutfit([&](Number number, const Outfit&) { _lists.lists.front().set(number); });
    _lists.numberCount = _outfits.size() + 1;
    makeUniforms();
    std::vector<std::map<const SkinnedGeometry*, bool>> visibility(_outfits.size() + 1);
    forEachOutfit(
        [&](Number number, const Outfit& outfit)
        {
            for (const auto& [part, isVisible] : outfit.getVisibility())
                if (const auto meshes = meshesNamed(crowd, part))
                    for (const SkinnedGeometry* mesh : meshes.value())
                        visibility[number][mesh] = isVisible;
        });
    forEachMesh(crowd,
                [&](const SkinnedGeometry& constMesh)
                {
                    auto& mesh = const_cast<SkinnedGeometry&>(constMesh);
                    _sources.push_back({&mesh, mesh.getStateSet(), mesh.getNodeMask()});
                    showOwn(mesh, visibility);
                });
    showProps();
    _before.clear();
    _statesBefore.clear();
}

OutfitLists::Mesh OutfitMeshes::mergedMesh(const std::vector<std::size_t>& parts) const
{
    const auto listOf = [&](std::size_t part) { return _lists.meshes.at(_shown[part].copy).list; };
    const auto isOfFirst = [&](std::size_t part) { return listOf(part) == listOf(parts.front()); };
    if (std::all_of(parts.begin(), parts.end(), isOfFirst)) return {listOf(parts.front()), nullptr};
    const osg::ref_ptr<osg::Uniform> uniform =
        new osg::Uniform(osg::Uniform::UNSIGNED_INT_VEC4, "poseOutfitParts", POSE_OUTFIT_VECTORS);
    for (std::size_t vector = 0; vector < POSE_OUTFIT_VECTORS; ++vector)
    {
        unsigned int shown[POSE_OUTFITS_PER_VECTOR] = {};
        for (std::size_t i = 0; i < POSE_OUTFITS_PER_VECTOR; ++i)
        {
            const std::size_t number = vector * POSE_OUTFITS_PER_VECTOR + i;
            for (std::size_t part = 0; part < parts.size() && number < _lists.numberCount; ++part)
                if (_shown[parts[part]].outfits[number]) shown[i] |= 1u << part;
        }
        uniform->setElement(static_cast<unsigned int>(vector), shown[0], shown[1], shown[2], shown[3]);
    }
    OutfitLists::Mesh mesh{OutfitLists::all, new osg::StateSet};
    mesh.parts->addUniform(uniform);
    mesh.parts->setDefine("POSE_OUTFIT_PARTS");
    return mesh;
}

void OutfitMeshes::showLevels(const CharacterLevels* levels)
{
    for (auto mesh = _lists.meshes.begin(); mesh != _lists.meshes.end();)
        mesh = _meshes->containsNode(mesh->first) ? std::next(mesh) : _lists.meshes.erase(mesh);
    if (!levels) return;
    for (const CharacterLevels::Merged& merged : levels->merged())
        for (const CharacterLevels::Step& step : merged.steps)
            _lists.meshes[step.mesh] = mergedMesh(merged.parts);
}

NodesOfOutfits OutfitMeshes::nodesOfOutfits() const
{
    NodesOfOutfits nodes(_outfits.size() + 1);
    for (const Shown& shown : _shown)
        for (std::size_t number = 0; number < nodes.size(); ++number)
            if (shown.outfits[number]) nodes[number].push_back(shown.isAsInCrowd ? shown.mesh.get() : shown.copy.get());
    return nodes;
}

} // namespace osgGpuAnimation
