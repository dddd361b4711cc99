// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/JointLines.h>

#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <osg/Depth>
#include <osg/LineWidth>
#include <osg/Material>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

constexpr const char* linesName = "osgGpuAnimation joint lines";

/// The joint's origin at bind time, which the entry's matrix moves to the present origin.
osg::Vec3 bindOrigin(const PaletteEntry& entry)
{
    const glm::dvec4 origin = glm::inverse(entry.inverseBind.toColumns()) * glm::dvec4(0.0, 0.0, 0.0, 1.0);
    return osg::Vec3(static_cast<float>(origin.x), static_cast<float>(origin.y), static_cast<float>(origin.z));
}

void setLineState(osg::StateSet& state)
{
    applyCharacterProgram(state);
    state.getOrCreateUniform("unlit", osg::Uniform::BOOL)->set(true);
    osg::ref_ptr<osg::Material> white = new osg::Material;
    white->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
    state.setAttribute(white);
    state.setAttribute(new osg::LineWidth(2.0f));
    // Drawn over the mesh, without an effect on later depth tests.
    state.setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false));
    state.setRenderBinDetails(1000, "RenderBin");
}

int findJointLines(const AnimatedCharacter& character)
{
    for (unsigned int i = 0; i < character.getNumChildren(); ++i)
        if (character.getChild(i)->getName() == linesName) return static_cast<int>(i);
    return -1;
}

} // namespace

osg::ref_ptr<SkinnedGeometry> makeJointLines(const AnimationSet& set)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray;
    const auto add = [&](int joint, const osg::Vec4& color)
    {
        const int entry = set.mainEntry(joint);
        positions->push_back(bindOrigin(set.palette()[static_cast<std::size_t>(entry)]));
        colors->push_back(color);
        entries->push_back(osg::Vec4us(static_cast<unsigned short>(entry), 0, 0, 0));
    };
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
    {
        const int parent = set.skeleton().joint(joint).parent;
        if (parent < 0) continue;
        add(parent, osg::Vec4(1.0f, 0.5f, 0.0f, 1.0f));
        add(static_cast<int>(joint), osg::Vec4(1.0f, 1.0f, 0.2f, 1.0f));
    }
    osg::ref_ptr<SkinnedGeometry> lines = new SkinnedGeometry;
    lines->setName(linesName);
    lines->setVertexArray(positions);
    lines->setColorArray(colors);
    osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(static_cast<unsigned int>(entries->size()));
    std::fill(weights->begin(), weights->end(), osg::Vec4(1, 0, 0, 0));
    lines->setInfluences(0, entries, weights);
    lines->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, static_cast<int>(positions->size())));
    lines->setCullingActive(false);
    setLineState(*lines->getOrCreateStateSet());
    return lines;
}

bool hasJointLines(const AnimatedCharacter& character)
{
    return findJointLines(character) >= 0;
}

void showJointLines(AnimatedCharacter& character, bool isShown)
{
    const int lines = findJointLines(character);
    if (lines >= 0 && !isShown) character.removeChild(static_cast<unsigned int>(lines));
    if (lines >= 0 || !isShown) return;
    osg::ref_ptr<SkinnedGeometry> added = makeJointLines(character.getAnimationSet());
    added->setInitialBound(character.getCurrentBounds());
    character.addChild(added);
}

} // namespace osgGpuAnimation
