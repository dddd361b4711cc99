// SPDX-License-Identifier: MIT
#include "osganimation/RigMeshes.h"

#include "osganimation/MorphMeshes.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/geometry/PrimitiveRange.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/LightSource>
#include <osg/Material>
#include <osgAnimation/RigGeometry>

#include <algorithm>
#include <map>
#include <utility>

namespace osgGpuAnimation::osganimation
{

namespace
{

constexpr std::size_t maxInfluences = 4 * SkinnedGeometry::maxInfluenceSets;

/// All weights of one vertex: indices of RigMesh::bones.
using VertexWeights = std::vector<std::pair<unsigned short, float>>;

class MeshFinder : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    MeshFinder(osgAnimation::Skeleton& skeleton, const std::vector<BoneJoint>& bones,
               std::vector<std::string>& warnings)
        : SceneVisitor(Shared::EachPath, TRAVERSE_ALL_CHILDREN), _skeleton(skeleton), _bones(bones), _warnings(warnings)
    {
        for (std::size_t i = 0; i < bones.size(); ++i)
        {
            _indices.emplace(bones[i].bone.get(), static_cast<int>(i));
            _byName.emplace(bones[i].bone->getName(), static_cast<int>(i));
        }
    }

    void apply(osg::Drawable& drawable) override
    {
        osg::Geometry* const geometry = drawable.asGeometry();
        if (!geometry) return;
        // The path: from the skeleton to the drawable.
        const osg::NodePath& path = getNodePath();
        int bone = -1;
        bool isAnimated = false;
        osgAnimation::UpdateMorph* weights = nullptr;
        osg::Matrixd toBone, toSkeleton;
        std::vector<osg::StateSet*> states;
        for (osg::Node* node : path)
        {
            if (node == &_skeleton) continue;
            if (node->getStateSet()) states.push_back(node->getStateSet());
            if (node == &drawable) break;
            auto* const update = dynamic_cast<osgAnimation::UpdateMorph*>(node->getUpdateCallback());
            if (update) weights = update;
            const auto known = _indices.find(node);
            if (const osg::Transform* const transform = node->asTransform())
            {
                osg::Matrix matrix;
                transform->computeLocalToWorldMatrix(matrix, nullptr);
                toSkeleton.preMult(matrix);
                toBone.preMult(matrix);
            }
            isAnimated = known == _indices.end() && (isAnimated || (node->getUpdateCallback() && !update));
            if (known == _indices.end()) continue;
            bone = known->second;
            toBone.makeIdentity();
        }
        auto* const rig = dynamic_cast<osgAnimation::RigGeometry*>(geometry);
        RigMesh mesh{geometry, nullptr, {}, {}};
        if (rig)
            addBones(*rig, toSkeleton, mesh);
        else if (bone >= 0 && !isAnimated)
        {
            mesh.bones = {bone};
            mesh.inverseBinds = {toAffine(toBone)};
        }
        if (mesh.bones.empty()) return;
        mesh.state = merged(states);
        addMorph(rig ? rig->getSourceGeometry() : geometry, weights, mesh);
        meshes.push_back(std::move(mesh));
    }

    std::vector<RigMesh> meshes;

private:
    void addBones(const osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton, RigMesh& mesh)
    {
        if (!rig.getInfluenceMap())
        {
            _warnings.push_back("mesh \"" + rig.getName() + "\": it has no influence map; it is left out");
            return;
        }
        for (const auto& each : *rig.getInfluenceMap())
        {
            const auto found = _byName.find(each.first);
            if (found == _byName.end())
            {
                _warnings.push_back("mesh \"" + rig.getName() + "\": there is no bone \"" + each.first +
                                    "\"; it moves nothing");
                continue;
            }
            mesh.bones.push_back(found->second);
            const osgAnimation::Bone& bone = *_bones[static_cast<std::size_t>(found->second)].bone;
            mesh.inverseBinds.push_back(toAffine(toSkeleton * bone.getInvBindMatrixInSkeletonSpace()));
        }
    }

    void addMorph(osg::Geometry* source, osgAnimation::UpdateMorph* weights, RigMesh& mesh)
    {
        auto* const morph = dynamic_cast<osgAnimation::MorphGeometry*>(source);
        if (!morph || morph->getMorphTargetList().empty()) return;
        if (!morphTargetsOf(*morph))
        {
            _warnings.push_back("mesh \"" + mesh.geometry->getName() +
                                "\": its morph targets have other numbers of vertices; they are left out");
            return;
        }
        mesh.morph = morph;
        mesh.weights = weights;
    }

    /// The same object for the same state sets.
    osg::ref_ptr<osg::StateSet> merged(const std::vector<osg::StateSet*>& states)
    {
        osg::ref_ptr<osg::StateSet>& made = _merged[states];
        if (made) return made;
        made = new osg::StateSet;
        for (const osg::StateSet* state : states)
            made->merge(*state);
        return made;
    }

    osgAnimation::Skeleton& _skeleton;
    const std::vector<BoneJoint>& _bones;
    std::vector<std::string>& _warnings;
    std::map<const osg::Node*, int> _indices;
    std::map<std::string, int> _byName;
    std::map<std::vector<osg::StateSet*>, osg::ref_ptr<osg::StateSet>> _merged;
};

/// Anything but groups, geodes and morphs.
bool isRemainder(const osg::Node& node)
{
    const bool isMorph = dynamic_cast<const osgAnimation::UpdateMorph*>(node.getUpdateCallback());
    return (node.getUpdateCallback() && !isMorph) || node.getEventCallback() || node.getCullCallback() ||
           dynamic_cast<const osg::LightSource*>(&node) || (!node.asGroup() && !node.asGeode());
}

/// By vertex. osgAnimation divides the weights by their sum.
std::vector<VertexWeights> weightsOf(const osgAnimation::VertexInfluenceMap& map, const RigMesh& mesh,
                                     const AnimationSet& set, std::size_t skin, std::size_t vertices)
{
    std::vector<VertexWeights> weights(vertices);
    std::size_t place = 0;
    for (const auto& [name, influence] : map)
    {
        const int joint = set.skeleton().findJoint(name);
        if (joint < 0 || place == mesh.bones.size()) continue;
        const auto entry = static_cast<unsigned short>(set.entryOfSkin(skin, place++));
        for (const auto& [vertex, weight] : influence)
            if (vertex < vertices && weight > 0.0f) weights[vertex].emplace_back(entry, weight);
    }
    return weights;
}

/// Returns the number of vertices that had more influences than a SkinnedGeometry takes.
std::size_t normalize(std::vector<VertexWeights>& weights)
{
    std::size_t reduced = 0;
    for (VertexWeights& vertex : weights)
    {
        std::sort(vertex.begin(), vertex.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
        if (vertex.size() > maxInfluences)
        {
            ++reduced;
            vertex.resize(maxInfluences);
        }
        float sum = 0.0f;
        for (const auto& [entry, weight] : vertex)
            sum += weight;
        for (auto& [entry, weight] : vertex)
            weight /= sum;
    }
    return reduced;
}

void setInfluences(SkinnedGeometry& mesh, const std::vector<VertexWeights>& weights)
{
    std::size_t max = 1;
    for (const VertexWeights& vertex : weights)
        max = std::max(max, vertex.size());
    const auto count = static_cast<unsigned int>(weights.size());
    for (unsigned int set = 0; 4 * set < max; ++set)
    {
        osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(osg::Array::BIND_PER_VERTEX, count);
        osg::ref_ptr<osg::Vec4Array> shares = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, count);
        for (std::size_t vertex = 0; vertex < weights.size(); ++vertex)
            for (std::size_t i = 4 * set; i < std::min<std::size_t>(weights[vertex].size(), 4 * set + 4); ++i)
            {
                (*entries)[vertex][static_cast<unsigned int>(i % 4)] = weights[vertex][i].first;
                (*shares)[vertex][static_cast<int>(i % 4)] = weights[vertex][i].second;
            }
        mesh.setInfluences(set, entries, shares);
    }
}

/// The arrays, which stay shared with the scene's geometry. False: a primitive set was left out.
bool copyArrays(const osg::Geometry& from, SkinnedGeometry& mesh)
{
    mesh.setVertexArray(const_cast<osg::Array*>(from.getVertexArray()));
    mesh.setNormalArray(const_cast<osg::Array*>(from.getNormalArray()));
    for (unsigned int unit = 0; unit < from.getNumTexCoordArrays(); ++unit)
        mesh.setTexCoordArray(unit, const_cast<osg::Array*>(from.getTexCoordArray(unit)));
    for (unsigned int i = 0; i < from.getNumPrimitiveSets(); ++i)
        if (isWithin(from.getPrimitiveSet(i), mesh.getVertexCount()))
            mesh.addPrimitiveSet(const_cast<osg::PrimitiveSet*>(from.getPrimitiveSet(i)));
    return mesh.getNumPrimitiveSets() == from.getNumPrimitiveSets();
}

} // namespace

std::vector<RigMesh> findMeshes(osgAnimation::Skeleton& skeleton, const std::vector<BoneJoint>& bones,
                                std::vector<std::string>& warnings)
{
    MeshFinder finder(skeleton, bones, warnings);
    skeleton.accept(finder);
    return finder.meshes;
}

osg::ref_ptr<SkinnedGeometry> skinnedMesh(const RigMesh& mesh, const AnimationSet& set, std::size_t skin, int morph,
                                          std::vector<std::string>& warnings)
{
    const auto* const rig = dynamic_cast<const osgAnimation::RigGeometry*>(mesh.geometry.get());
    const osg::Geometry& source = rig && rig->getSourceGeometry() ? *rig->getSourceGeometry() : *mesh.geometry;
    osg::ref_ptr<SkinnedGeometry> made = new SkinnedGeometry;
    made->setName(mesh.geometry->getName().empty() ? source.getName() : mesh.geometry->getName());
    if (made->getName().empty()) made->setName(mesh.geometry->getParent(0)->getName());
    if (!copyArrays(source, *made))
        warnings.push_back("mesh \"" + made->getName() +
                           "\": a primitive set is missing or has indices beyond its vertices; left out");
    if (morph >= 0)
    {
        made->setVertexArray(morphSource(*mesh.morph, false));
        made->setNormalArray(morphSource(*mesh.morph, true));
        made->setMorphTargets(set, static_cast<std::size_t>(morph), *morphTargetsOf(*mesh.morph));
    }
    if (rig)
    {
        std::vector<VertexWeights> weights =
            weightsOf(*rig->getInfluenceMap(), mesh, set, skin, made->getVertexCount());
        if (const std::size_t reduced = normalize(weights))
            warnings.push_back("mesh \"" + made->getName() + "\": " + std::to_string(reduced) +
                               " vertices have more than 8 influences; the 8 largest are kept");
        setInfluences(*made, weights);
    }
    else
        made->setRigidEntry(static_cast<unsigned short>(set.entryOfSkin(skin, 0)));
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet(*mesh.state);
    if (rig && source.getStateSet() && source.getStateSet() != mesh.geometry->getStateSet())
        state->merge(*source.getStateSet());
    // Without a material, the fixed pipeline has GL's, the program white.
    if (!state->getAttribute(osg::StateAttribute::MATERIAL)) state->setAttribute(new osg::Material);
    // The character's program multiplies the vertices' colours and the material, of which the fixed pipeline takes one.
    const auto& material = static_cast<const osg::Material&>(*state->getAttribute(osg::StateAttribute::MATERIAL));
    if (material.getColorMode() != osg::Material::OFF)
        made->setColorArray(const_cast<osg::Array*>(source.getColorArray()));
    applyCharacterProgram(*state);
    applySkinDefines(*state, made->getInfluenceCount(), morph >= 0);
    made->setStateSet(state);
    return made;
}

bool isEmpty(osg::Node& node)
{
    return !visitUntil(node, isRemainder);
}

} // namespace osgGpuAnimation::osganimation
