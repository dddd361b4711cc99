// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/SkinnedVertices.h>
#include <osgGpuAnimation/nodes/PaletteBinding.h>

#include <osg/State>

namespace osgGpuAnimation
{

class SkinnedGeometry;
struct PalettePlace;

/// While a mesh is drawn: where the program that is applied finds its vertices, if it is one that does not skin them
/// itself (POSE_SKINNED).
class SkinnedRead
{
public:
    SkinnedRead(osg::State& state, const SkinnedGeometry& mesh, const PaletteBinding& binding);

    /// Whether the program that is applied reads what is not there: all instances of the batch are, or none.
    bool isMissing() { return !find(0); }
    /// Goes to the instance. False where it has not been skinned, so that it cannot be drawn.
    bool find(std::size_t instance);
    /// The instances around it that can be drawn with it.
    std::size_t begin() const { return _place.first; }
    std::size_t end() const { return _place.end; } ///< behind the last
    /// Tells the program. palette: of the instance.
    void bind(const PalettePlace& palette) const;

private:
    osg::State& _state;
    const SkinnedVertices::Subject _subject;
    GLint _vertexCount;
    bool _isNeeded;
    SkinnedVertices::Place _place;
};

} // namespace osgGpuAnimation
