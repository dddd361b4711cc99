// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>

#include <osgGpuAnimation/looks/shading/Mipmaps.h>

#include <osg/UserDataContainer>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

const char* const objectName = "osgGpuAnimation.materialVariants";

const osg::UserDataContainer* variantsOf(const osg::Object& object)
{
    const osg::UserDataContainer* all = object.getUserDataContainer();
    return all ? dynamic_cast<const osg::UserDataContainer*>(all->getUserObject(objectName)) : nullptr;
}

void setVariants(osg::Object& object, osg::UserDataContainer* variants)
{
    variants->setName(objectName);
    osg::UserDataContainer& all = *object.getOrCreateUserDataContainer();
    const unsigned int index = all.getUserObjectIndex(objectName);
    if (index < all.getNumUserObjects())
        all.setUserObject(index, variants);
    else
        all.addUserObject(variants);
}

/// A saved scene may hold any object.
osg::StateSet* stateAt(const osg::UserDataContainer& variants, unsigned int index)
{
    return const_cast<osg::StateSet*>(dynamic_cast<const osg::StateSet*>(variants.getUserObject(index)));
}

template <typename Visit>
void forEachVariantState(const osg::Geometry& mesh, Visit visit)
{
    const osg::UserDataContainer* variants = variantsOf(mesh);
    for (unsigned int i = 0; variants && i < variants->getNumUserObjects(); ++i)
        if (osg::StateSet* state = stateAt(*variants, i); state && state != mesh.getStateSet()) visit(*state);
}

/// True if the one can be drawn in place of the other, with its StateSet and node mask.
bool isCopyOf(const osg::Geometry& one, const osg::Geometry& other)
{
    osg::Geometry::ArrayList arrays, otherArrays;
    one.getArrayList(arrays);
    other.getArrayList(otherArrays);
    return arrays == otherArrays && one.getPrimitiveSetList() == other.getPrimitiveSetList() &&
           one.getUserDataContainer() == other.getUserDataContainer() &&
           one.getCullCallback() == other.getCullCallback() && one.getDrawCallback() == other.getDrawCallback();
}

void exchangeChild(osg::Group& group, unsigned int child, const osg::Geometry& mesh, osg::Geometry& shown)
{
    osg::BoundingBox box = shown.getInitialBound();
    box.expandBy(mesh.getInitialBound());
    if (box != shown.getInitialBound()) shown.setInitialBound(box);
    group.setChild(child, &shown);
}

/// change(osg::LOD&), which may replace children. Clones of a character share its levels of detail: a copy changes.
template <typename Change>
void changeLevels(osg::Group& group, unsigned int child, Change change)
{
    auto* levels = dynamic_cast<osg::LOD*>(group.getChild(child));
    if (!levels) return;
    if (levels->getNumParents() == 1) return change(*levels);
    const osg::ref_ptr<osg::LOD> own = osg::clone(levels, osg::CopyOp::SHALLOW_COPY);
    change(*own);
    for (unsigned int level = 0; level < own->getNumChildren(); ++level)
        if (own->getChild(level) != levels->getChild(level)) return static_cast<void>(group.setChild(child, own));
}

} // namespace

void setVariantNames(osg::Object& character, const std::vector<std::string>& names)
{
    osg::ref_ptr<osg::UserDataContainer> variants = new osg::DefaultUserDataContainer;
    variants->setDescriptions(names);
    setVariants(character, variants);
}

std::vector<std::string> variantNamesOf(const osg::Object& character)
{
    const osg::UserDataContainer* variants = variantsOf(character);
    return variants ? variants->getDescriptions() : std::vector<std::string>();
}

// The first user object is the default; the descriptions name the variants of the others, in the same order.
void setVariantStates(osg::Geometry& mesh, osg::StateSet* defaultState, const std::vector<VariantState>& states)
{
    osg::ref_ptr<osg::UserDataContainer> variants = new osg::DefaultUserDataContainer;
    variants->addUserObject(defaultState);
    for (const VariantState& state : states)
    {
        variants->addDescription(state.variant);
        variants->addUserObject(state.state);
    }
    setVariants(mesh, variants);
}

osg::StateSet* variantState(const osg::Geometry& mesh, const std::string& variant)
{
    const osg::UserDataContainer* variants = variantsOf(mesh);
    if (!variants) return nullptr;
    const std::vector<std::string>& names = variants->getDescriptions();
    for (unsigned int i = 0; i < names.size(); ++i)
        if (names[i] == variant && !variant.empty()) return stateAt(*variants, i + 1);
    return stateAt(*variants, 0);
}

void releaseVariantStates(const osg::Geometry& mesh, osg::State* state)
{
    const auto release = [state](osg::StateSet& other)
    {
        other.releaseGLObjects(state);
        generateMipmaps(&other);
    };
    forEachVariantState(mesh, release);
}

void resizeVariantStates(osg::Geometry& mesh, unsigned int maxSize)
{
    const auto resize = [maxSize](osg::StateSet& other)
    {
        other.resizeGLObjectBuffers(maxSize);
        generateMipmaps(&other);
    };
    forEachVariantState(mesh, resize);
}

void VariantMeshes::show(osg::Group& group, const std::string& variant)
{
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
    {
        changeLevels(group, i, [&](osg::LOD& levels) { show(levels, variant); });
        auto* mesh = dynamic_cast<osg::Geometry*>(group.getChild(i));
        osg::StateSet* state = mesh ? variantState(*mesh, variant) : nullptr;
        if (!state || state == mesh->getStateSet()) continue;
        const osg::ref_ptr<osg::Geometry> shown = copyOf(*mesh, state, mesh->getNodeMask() != 0);
        exchangeChild(group, i, *mesh, *shown);
    }
}

void VariantMeshes::setVisible(osg::Group& group, const std::vector<osg::Geometry*>& meshes, bool isVisible)
{
    // All levels are shown or hidden together with one of them.
    const auto setLevelsVisible = [&](osg::LOD& levels)
    {
        std::vector<osg::Geometry*> all;
        for (unsigned int level = 0; level < levels.getNumChildren(); ++level)
            if (auto* mesh = dynamic_cast<osg::Geometry*>(levels.getChild(level))) all.push_back(mesh);
        if (std::find_first_of(all.begin(), all.end(), meshes.begin(), meshes.end()) != all.end())
            setVisible(levels, all, isVisible);
    };
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
    {
        changeLevels(group, i, setLevelsVisible);
        auto* mesh = dynamic_cast<osg::Geometry*>(group.getChild(i));
        if (!mesh || std::find(meshes.begin(), meshes.end(), mesh) == meshes.end()) continue;
        if ((mesh->getNodeMask() != 0) == isVisible) continue;
        mesh->getOrCreateUserDataContainer(); // by which copies know each other
        const osg::ref_ptr<osg::Geometry> shown = copyOf(*mesh, mesh->getStateSet(), isVisible);
        exchangeChild(group, i, *mesh, *shown);
    }
}

/// The node mask of the mesh while it is visible: the copies know that of a hidden one.
osg::Node::NodeMask VariantMeshes::visibleMask(const osg::Geometry& mesh) const
{
    if (mesh.getNodeMask() != 0) return mesh.getNodeMask();
    osg::Node::NodeMask mask = ~0u;
    const osg::UserDataContainer* family = mesh.getUserDataContainer();
    for (auto copy = _meshes.lower_bound(Key{family, nullptr, 0, false});
         copy != _meshes.end() && std::get<0>(copy->first) == family; ++copy)
    {
        osg::ref_ptr<osg::Geometry> known;
        if (!copy->second.lock(known) || !isCopyOf(*known, mesh)) continue;
        mask = std::get<2>(copy->first);
        if (known == &mesh) break;
    }
    return mask;
}

osg::ref_ptr<osg::Geometry> VariantMeshes::copyOf(osg::Geometry& mesh, osg::StateSet* state, bool isVisible)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (auto copy = _meshes.begin(); copy != _meshes.end();)
        copy = copy->second.valid() ? std::next(copy) : _meshes.erase(copy);
    const osg::Node::NodeMask visible = visibleMask(mesh), mask = isVisible ? visible : 0;
    const osg::UserDataContainer* family = mesh.getUserDataContainer();
    osg::observer_ptr<osg::Geometry>& present = _meshes[{family, mesh.getStateSet(), visible, mesh.getNodeMask() != 0}];
    osg::ref_ptr<osg::Geometry> shown;
    // The key of a deleted mesh may have become that of another.
    if (!present.lock(shown) || !isCopyOf(*shown, mesh)) present = &mesh;
    osg::observer_ptr<osg::Geometry>& known = _meshes[{family, state, visible, isVisible}];
    if (known.lock(shown) && shown->getStateSet() == state && shown->getNodeMask() == mask && isCopyOf(*shown, mesh))
        return shown;
    shown = osg::clone(&mesh, osg::CopyOp::SHALLOW_COPY);
    shown->setStateSet(state);
    shown->setNodeMask(mask);
    known = shown;
    return shown;
}

} // namespace osgGpuAnimation
