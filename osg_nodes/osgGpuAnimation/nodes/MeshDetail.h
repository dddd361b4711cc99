// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/DetailLevels.h>

#include <memory>
#include <mutex>

namespace osgGpuAnimation
{

/// What a mesh keeps of its DetailLevels: made when they are first needed, once for all threads, and anew when the
/// mesh's vertices or primitives are others. Copies have the same ones.
class MeshDetail
{
public:
    MeshDetail() = default;
    MeshDetail(const MeshDetail& other) : _levels(std::atomic_load(&other._levels)) {}
    MeshDetail& operator=(const MeshDetail&) = delete;

    /// Several threads that ask wait for the one that makes them.
    std::shared_ptr<const DetailLevels> of(const osg::Geometry& mesh, const AnimationSet& set,
                                           const DetailLevels::Skinning& skin) const;
    /// Null: they were not made, or are of what the mesh was before.
    std::shared_ptr<const DetailLevels> known(const osg::Geometry& mesh) const;
    /// When what the vertices go by has changed.
    void forget();

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize) const;

private:
    mutable std::mutex _mutex;
    mutable std::shared_ptr<const DetailLevels> _levels; ///< read and written as a whole
};

} // namespace osgGpuAnimation
