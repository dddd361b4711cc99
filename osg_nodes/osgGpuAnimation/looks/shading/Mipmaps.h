// SPDX-License-Identifier: MIT
#pragma once

#include <osg/StateSet>
#include <osg/Texture>

namespace osgGpuAnimation
{

/// Makes OSG generate the texture's mipmaps by glGenerateMipmap at its next use in each context, if its filter reads
/// any. An OSG for the compatibility profile alone only sets GL_GENERATE_MIPMAP, which the core profile does not have:
/// the texture would be black there. OSG forgets the call with the GL objects, and for contexts that come later.
void generateMipmaps(osg::Texture& texture);

/// The same for all textures of a state; null has none.
void generateMipmaps(osg::StateSet* state);

} // namespace osgGpuAnimation
