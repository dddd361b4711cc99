// SPDX-License-Identifier: MIT
#include "plugin/ModelVertices.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

namespace osgGpuAnimation::gltf
{

namespace
{

glm::dvec3 toGlm(const osg::Vec3& v)
{
    return glm::dvec3(v.x(), v.y(), v.z());
}

} // namespace

ModelVertices::ModelVertices(const ImportedModel& model, int clip, double time,
                             const std::map<int, std::vector<double>>& fixedWeights)
    : _model(model), _fixedWeights(fixedWeights)
{
    if (!model.set) return;
    AnimationController controller(model.set);
    if (clip >= 0)
    {
        controller.setLoopMode(AnimationController::LoopMode::Once); // a clip does not wrap at its end
        (void)controller.play(static_cast<std::size_t>(clip));
        controller.pause();
        controller.seek(time);
    }
    std::vector<JointTransform> tracks;
    Pose::mix(*model.set, controller.instruction(), tracks);
    Pose::jointToModel(*model.set, tracks, AffineMatrix(), _jointToModel);
    Pose::palette(*model.set, tracks, _jointToModel, _palette);
}

std::vector<double> ModelVertices::weights(int morph) const
{
    const MorphWeights& source = _model.set->morphs()[static_cast<std::size_t>(morph)];
    const auto fixed = _fixedWeights.find(source.sourceNode);
    if (fixed != _fixedWeights.end()) return fixed->second;
    std::vector<double> result;
    for (std::size_t i = 0; i < source.defaults.size(); ++i)
    {
        const std::size_t block = i / MorphWeights::weightsPerBlock;
        const int place = static_cast<int>(i % MorphWeights::weightsPerBlock);
        const int entry = _model.set->entryOfMorph(static_cast<std::size_t>(morph));
        result.push_back(_palette[static_cast<std::size_t>(entry) + block].rows[place / 4][place % 4]);
    }
    return result;
}

glm::dvec3 ModelVertices::morphed(const ImportedPrimitive& primitive, std::size_t vertex) const
{
    const auto& base = dynamic_cast<const osg::Vec3Array&>(*primitive.geometry->getVertexArray());
    glm::dvec3 position = toGlm(base[vertex]);
    if (primitive.morph < 0) return position;
    const std::vector<double> amounts = weights(primitive.morph);
    const auto& targets = dynamic_cast<const SkinnedGeometry&>(*primitive.geometry).getMorphTargets();
    for (std::size_t target = 0; target < targets.size(); ++target)
    {
        if (targets[target].positions) position += amounts[target] * toGlm((*targets[target].positions)[vertex]);
    }
    return position;
}

glm::dvec3 ModelVertices::placed(const ImportedPrimitive& primitive, std::size_t vertex) const
{
    const glm::dvec3 position = morphed(primitive, vertex);
    const auto* skinned = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get());
    if (!skinned)
    {
        const osg::Vec3d result = osg::Vec3d(position.x, position.y, position.z) * primitive.toModel;
        return glm::dvec3(result.x(), result.y(), result.z());
    }
    if (skinned->getRigidEntry() >= 0)
        return glm::dvec3(_palette[static_cast<std::size_t>(skinned->getRigidEntry())].toColumns() *
                          glm::dvec4(position, 1.0));
    glm::dvec3 sum(0.0);
    for (unsigned int set = 0; set < SkinnedGeometry::maxInfluenceSets && skinned->getEntries(set); ++set)
    {
        for (unsigned int i = 0; i < 4; ++i)
        {
            const double weight = (*skinned->getWeights(set))[vertex][i];
            if (weight == 0.0) continue;
            const glm::dmat4 entry = _palette[(*skinned->getEntries(set))[vertex][i]].toColumns();
            sum += weight * glm::dvec3(entry * glm::dvec4(position, 1.0));
        }
    }
    return sum;
}

std::vector<glm::dvec3> ModelVertices::positions(const ImportedPrimitive& primitive) const
{
    std::vector<glm::dvec3> result;
    for (std::size_t vertex = 0; vertex < primitive.vertexCount; ++vertex)
        result.push_back(placed(primitive, primitive.geometryVertex ? (*primitive.geometryVertex)[vertex] : vertex));
    return result;
}

} // namespace osgGpuAnimation::gltf
