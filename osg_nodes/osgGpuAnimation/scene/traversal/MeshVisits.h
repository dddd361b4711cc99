// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <functional>

namespace osgGpuAnimation
{

class PosedMeshSource;
class SkinnedGeometry;

/// True if a plugin of OSG (a library osgdb_*) visits the scene to write it in another format. The kit's own plugins,
/// OSG's serializers, and plugins that show graphs or normals do not count.
bool isFileWriter(const osg::NodeVisitor& visitor);

/// The visitor meets the posed geometry in place of the mesh.
/// - Intersectors: the mesh is the last node of the path and the drawable of all hits of OSG's own intersectors.
/// - File writers: a Geode contains the geometry, because some writers search for Geodes. It lives as long as the
///   visitor. The first one gives a note that the animation is lost.
void visitPosed(osg::NodeVisitor& visitor, osg::Drawable& mesh, osg::Geometry& posed);

/// RAII: while this thread culls, a function draws the meshes below the source in place of the visitor. For crowds,
/// whose meshes are drawn for many instances at once, wherever a user has inserted groups above them.
class MeshDrawScope
{
public:
    using Draw = std::function<void(SkinnedGeometry&)>;

    MeshDrawScope(const PosedMeshSource& source, Draw draw);
    ~MeshDrawScope();
    MeshDrawScope(const MeshDrawScope&) = delete;

    static const MeshDrawScope* current(); ///< the innermost scope of this thread, or null
    const PosedMeshSource& source() const { return _source; }
    void draw(SkinnedGeometry& mesh) const { _draw(mesh); }

private:
    const PosedMeshSource& _source;
    Draw _draw;
    const MeshDrawScope* _outer;
};

} // namespace osgGpuAnimation
