// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/Skinning.h>
#include <osgGpuAnimation/nodes/SkinOncePass.h>

#include <osg/ref_ptr>
#include <osg/Referenced>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class AnimationSet;
class SkinnedGeometry;

/// Which meshes are skinned once a frame in one graphics context, by what was drawn of them in the last frame that is
/// over: so a camera knows while it culls, before others have. Asked on the cull side, counted on the draw side.
///
/// Skinning::Once: all that fit. Skinning::Auto: those with morph targets of which each instance whose pose was
/// evaluated was drawn breakEven() times and more, by whatever cameras and passes. A mesh fits if one instance fits a
/// buffer texture, and all meshes' vertices SkinnedVertices::maxBytes.
class SkinningPlan : public osg::Referenced
{
public:
    /// Draws of an instance from which on skinning once is cheaper, measured in tests/benchmark/RESULTS.md; 0: never.
    static int breakEven(std::size_t morphTargets);

    /// By SkinnedGeometry::number().
    using Meshes = std::set<std::uint64_t>;

    static osg::ref_ptr<SkinningPlan> forContext(unsigned int contextId);

    /// The meshes that are skinned once, as it was decided last.
    std::shared_ptr<const Meshes> once() const;

    /// On the draw side, before what is drawn in a frame is counted: with a frame that is new it is decided about the
    /// one before. frame: see PoseFrame::serial().
    void begin(osg::State& state, std::uint64_t frame);
    /// Takes down that so many instances are drawn of a mesh in the poses of that batch, which has `posed` instances.
    void count(const SkinnedGeometry& mesh, const AnimationSet& set, std::size_t slot, std::size_t posed,
               std::size_t drawn);

private:
    struct Tally
    {
        std::uint64_t mesh;
        Skinning skinning;
        int breakEven;
        SkinOncePass::Variant variant;
        std::size_t texels; ///< of an instance
        std::string name;
        std::size_t drawn = 0;                                            ///< instances, each as often as it was
        std::size_t posed = 0;                                            ///< instances
        std::vector<std::pair<const AnimationSet*, std::size_t>> batches; ///< theirs
    };

    ~SkinningPlan() override = default;
    Tally& tallyOf(const SkinnedGeometry& mesh);
    void decide(osg::State& state);
    bool fits(osg::State& state, const Tally& tally, std::size_t bytesTaken);

    mutable std::mutex _mutex;
    std::shared_ptr<const Meshes> _once = std::make_shared<Meshes>();
    std::uint64_t _frame = 0;    ///< see PoseFrame::serial()
    std::vector<Tally> _tallies; ///< of the frame, in the order of their first draws
    std::unordered_map<std::uint64_t, std::size_t> _tallyOfMesh;
    Meshes _reported; ///< as not to fit
};

} // namespace osgGpuAnimation
