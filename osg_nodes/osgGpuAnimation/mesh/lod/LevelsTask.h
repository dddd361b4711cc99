// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The creation of levels of detail in the background: one thread of the process creates them for all nodes, one node
/// after the other, from copies of the meshes. Nodes with the same meshes share a task. The thread gives up soon after
/// the last owner of a task has dropped it, and at the end of the process.
///
///     std::shared_ptr<LevelsTask> task = LevelsTask::of(character, set, false, false);
///     …
///     if (task->isDone()) task->take();
class LevelsTask : public std::enable_shared_from_this<LevelsTask>
{
public:
    static constexpr std::size_t maxVertices = 10 * LodLevels::maxVertices; ///< meshes after so many get no levels

    /// True if a mesh among the group's children (see forEachMesh()) has no LodLevels and should have some.
    static bool areMissing(const osg::Group& meshes);

    /// The task for the missing levels of the meshes: another node's, or a new one. isMerged: with CharacterLevels.
    /// set: not null. keepsParts: see MergedParts.
    static std::shared_ptr<LevelsTask> of(const osg::Group& meshes, const std::shared_ptr<const AnimationSet>& set,
                                          bool isMerged, bool keepsParts);
    ~LevelsTask();

    /// True if the task makes all levels that the present meshes are missing.
    bool isOf(const osg::Group& meshes, const AnimationSet& set, bool isMerged) const;

    bool isDone() const;
    /// Blocks until the task is done. A task that the thread has not begun is done by the caller.
    void wait();
    /// Gives the meshes their levels, except for those that have changed. Returns the levels of the character as a
    /// whole; null: isMerged was false. isDone() must be true. Call it where meshes may be changed, once per owner.
    std::shared_ptr<const CharacterLevels> take();

private:
    class Work;
    struct Mesh
    {
        osg::ref_ptr<const SkinnedGeometry> mesh;
        unsigned int forgetCount;          ///< see MeshLod
        std::shared_ptr<LodLevels> levels; ///< null: they existed before

        bool isOf(const SkinnedGeometry& present) const;
    };

    LevelsTask(const osg::Group& meshes, const std::shared_ptr<const AnimationSet>& set, bool isMerged,
               bool keepsParts);
    std::shared_ptr<LodLevels> levelsLike(const SkinnedGeometry& mesh) const;

    std::shared_ptr<const AnimationSet> _set;
    std::vector<Mesh> _meshes;
    std::shared_ptr<CharacterLevels> _merged; ///< null: not wanted
    std::shared_ptr<Work> _work;              ///< never null, shared with the thread
    std::mutex _takeMutex;
    bool _isTaken = false;
};

} // namespace osgGpuAnimation
