// SPDX-License-Identifier: MIT
#pragma once

#include <osg/StateSet>
#include <osg/Texture>

namespace osgGpuAnimation
{

/// Makes OSG generate the texture's mipmaps by glGenerateMipmap at its next use in each context, if its filter reads
/// any. An OSG for the compatibility profile alone only sets GL_GENERATE_MIPMAP, which the core profile does not have:
/// the texture would be black there. OSG forgets the call with the GL objects, and for contexts that come later.
inline void generateMipmaps(osg::Texture& texture)
{
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    if (filter != osg::Texture::LINEAR && filter != osg::Texture::NEAREST) texture.allocateMipmapLevels();
}

/// The same for all textures of a state; null has none.
inline void generateMipmaps(osg::StateSet* state)
{
    for (unsigned int unit = 0; state && unit < state->getNumTextureAttributeLists(); ++unit)
        if (auto* texture = dynamic_cast<osg::Texture*>(state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE)))
            generateMipmaps(*texture);
}

} // namespace osgGpuAnimation
