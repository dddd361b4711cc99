// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>
#include <osg/VertexArrayState>

namespace osgGpuAnimation
{

/// While a mesh is drawn: the record of vertex arrays it may use. A mesh has a vertex array object for each OSG context
/// number, but contexts that share GL objects, and with them the number, do not share those. There the mesh is drawn
/// with the context's own record, as geometries without such objects are.
class MeshVertexArrays
{
public:
    explicit MeshVertexArrays(osg::State& state);
    ~MeshVertexArrays();
    MeshVertexArrays(const MeshVertexArrays&) = delete;
    MeshVertexArrays& operator=(const MeshVertexArrays&) = delete;

    /// Several contexts have the state's number.
    static bool isNumberShared(const osg::State& state);
    /// Makes it a record without a vertex array object. The context it was made in is current.
    static void removeObject(osg::VertexArrayState& arrays);

private:
    osg::State& _state;
    bool _isContextsOwn;
};

} // namespace osgGpuAnimation
