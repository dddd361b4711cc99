// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/PaletteBinding.h>

#include <layout.glsl>

#include <osg/State>

#include <algorithm>
#include <cassert>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int entriesLocation(unsigned int influenceSet)
{
    return influenceSet == 0 ? POSE_ENTRIES_0_LOCATION : POSE_ENTRIES_1_LOCATION;
}

constexpr unsigned int weightsLocation(unsigned int influenceSet)
{
    return influenceSet == 0 ? POSE_WEIGHTS_0_LOCATION : POSE_WEIGHTS_1_LOCATION;
}

/// Influences a vertex needs to be looked at: one behind the last weight that is not 0.
int influencesUsed(const osg::Vec4Array& weights)
{
    int used = 0;
    for (const osg::Vec4& weight : weights)
        for (int i = used; i < 4; ++i)
            if (weight[i] != 0.0f) used = i + 1;
    return used;
}

} // namespace

SkinnedGeometry::SkinnedGeometry()
{
    setUseDisplayList(false);
    setUseVertexBufferObjects(true);
}

SkinnedGeometry::SkinnedGeometry(const SkinnedGeometry& other, const osg::CopyOp& copyop)
    : osg::Geometry(other, copyop), _influences(other._influences)
{
}

void SkinnedGeometry::setInfluences(unsigned int influenceSet, osg::Vec4usArray* entries, osg::Vec4Array* weights)
{
    assert(influenceSet < maxInfluenceSets && "influences come in two sets of four");
    setVertexAttribArray(entriesLocation(influenceSet), entries, osg::Array::BIND_PER_VERTEX);
    setVertexAttribArray(weightsLocation(influenceSet), weights, osg::Array::BIND_PER_VERTEX);
    _influences = 1;
    for (unsigned int i = 0; i < maxInfluenceSets; ++i)
    {
        const int used = this->weights(i) ? influencesUsed(*this->weights(i)) : 0;
        if (used > 0) _influences = std::max(_influences, static_cast<int>(4 * i) + used);
    }
    dirtyBound();
}

const osg::Vec4usArray* SkinnedGeometry::entries(unsigned int influenceSet) const
{
    return dynamic_cast<const osg::Vec4usArray*>(getVertexAttribArray(entriesLocation(influenceSet)));
}

const osg::Vec4Array* SkinnedGeometry::weights(unsigned int influenceSet) const
{
    return dynamic_cast<const osg::Vec4Array*>(getVertexAttribArray(weightsLocation(influenceSet)));
}

void SkinnedGeometry::setRigidEntry(unsigned short entry)
{
    const unsigned int count = getVertexArray() ? getVertexArray()->getNumElements() : 0;
    osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(count);
    std::fill(entries->begin(), entries->end(), osg::Vec4us(entry, 0, 0, 0));
    osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(count);
    std::fill(weights->begin(), weights->end(), osg::Vec4(1, 0, 0, 0));
    setInfluences(0, entries, weights);
}

void SkinnedGeometry::addToEntryBoxes(EntryBoxes& boxes) const
{
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(getVertexArray());
    if (!vertices) return;
    for (unsigned int influenceSet = 0; influenceSet < maxInfluenceSets; ++influenceSet)
    {
        const osg::Vec4usArray* vertexEntries = entries(influenceSet);
        const osg::Vec4Array* vertexWeights = weights(influenceSet);
        if (!vertexEntries || !vertexWeights) continue;
        const std::size_t count = std::min({vertices->size(), vertexEntries->size(), vertexWeights->size()});
        for (std::size_t vertex = 0; vertex < count; ++vertex)
        {
            const osg::Vec3& position = (*vertices)[vertex];
            for (int i = 0; i < 4; ++i)
            {
                const std::size_t entry = (*vertexEntries)[vertex][i];
                if ((*vertexWeights)[vertex][i] != 0.0f && entry < boxes.size())
                    boxes[entry].add(glm::vec3(position.x(), position.y(), position.z()));
            }
        }
    }
}

void SkinnedGeometry::drawImplementation(osg::RenderInfo& renderInfo) const
{
    osg::State& state = *renderInfo.getState();
    const auto* binding =
        static_cast<const PaletteBinding*>(state.getLastAppliedAttribute(PaletteBinding::bindingType));
    if (!binding || !binding->animationSet()) return;
    const PosePipeline* pipeline = PosePipeline::of(state);
    const PalettePlace place =
        pipeline ? pipeline->place(*binding->animationSet(), binding->slot(), binding->instance()) : PalettePlace{};
    if (place.texture == 0) return;
    bindPalette(state, place);
    osg::Geometry::drawImplementation(renderInfo);
}

void SkinnedGeometry::bindPalette(osg::State& state, const PalettePlace& place) const
{
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return;
    static const unsigned int paletteName = osg::Uniform::getNameID("posePalette");
    static const unsigned int strideName = osg::Uniform::getNameID("poseStride");
    static const unsigned int instanceName = osg::Uniform::getNameID("poseInstance");
    static const unsigned int influencesName = osg::Uniform::getNameID("poseInfluences");
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    state.setActiveTextureUnit(POSE_PALETTE_UNIT);
    glBindTexture(GL_TEXTURE_BUFFER, place.texture);
    gl->glUniform1i(program->getUniformLocation(paletteName), POSE_PALETTE_UNIT);
    gl->glUniform1i(program->getUniformLocation(strideName), place.stride);
    gl->glUniform1i(program->getUniformLocation(instanceName), place.instance);
    gl->glUniform1i(program->getUniformLocation(influencesName), _influences);
}

} // namespace osgGpuAnimation
