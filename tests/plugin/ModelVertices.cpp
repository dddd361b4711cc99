// SPDX-License-Identifier: MIT
#include "plugin/ModelVertices.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

namespace osgGpuAnimation::gltf
{

ModelVertices::ModelVertices(const ImportedModel& model, int clip, double time,
                             const std::map<int, std::vector<double>>& fixedWeights)
{
    if (!model.set) return;
    const AnimationSet& set = *model.set;
    AnimationController controller(model.set);
    if (clip >= 0)
    {
        controller.setLoopMode(LoopMode::Once); // a clip does not wrap at its end
        (void)controller.play(static_cast<std::size_t>(clip));
        controller.pause();
        controller.seek(time);
    }
    std::vector<JointTransform> tracks;
    Pose::mix(set, controller.instruction(), tracks);
    Pose::jointToModel(set, tracks, AffineMatrix(), _jointToModel);
    Pose::palette(set, tracks, _jointToModel, _palette);
    for (std::size_t morph = 0; morph < set.morphs().size(); ++morph)
    {
        const auto fixed = fixedWeights.find(set.morphs()[morph].sourceNode);
        if (fixed == fixedWeights.end()) continue;
        for (std::size_t i = 0; i < fixed->second.size(); ++i)
        {
            const std::size_t block = i / MorphWeights::weightsPerBlock;
            const int place = static_cast<int>(i % MorphWeights::weightsPerBlock);
            _palette[static_cast<std::size_t>(set.entryOfMorph(morph)) + block].rows[place / 4][place % 4] =
                static_cast<float>(fixed->second[i]);
        }
    }
}

std::vector<glm::dvec3> ModelVertices::positions(const ImportedPrimitive& primitive) const
{
    std::vector<glm::dvec3> all;
    if (const auto* skinned = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get()))
        skinned->computePositions(_palette, all);
    else
        for (const osg::Vec3& vertex : dynamic_cast<const osg::Vec3Array&>(*primitive.geometry->getVertexArray()))
        {
            const osg::Vec3d place = osg::Vec3d(vertex) * primitive.toModel;
            all.emplace_back(place.x(), place.y(), place.z());
        }
    std::vector<glm::dvec3> result;
    for (std::size_t vertex = 0; vertex < primitive.vertexCount; ++vertex)
        result.push_back(all[primitive.geometryVertex ? (*primitive.geometryVertex)[vertex] : vertex]);
    return result;
}

} // namespace osgGpuAnimation::gltf
