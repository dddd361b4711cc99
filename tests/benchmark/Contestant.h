// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"
#include "StagedViewer.h"
#include "Subject.h"

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// A scene in its own viewer, and the cost of its frames.
struct Contestant
{
    std::shared_ptr<StagedViewer> viewer;
    double time = 0.0;
    Series whole, updateAndCull, draw;

    FrameCost frame();
    void measure(); ///< draws one frame and records its cost
};

/// width, height: of the picture, see StagedViewer. Error: no GL is available.
Result<Contestant> contestant(osg::Node* scene, const osg::BoundingSphere& sight, int width = 64, int height = 0);

/// Draws frames until all programs and buffers exist and osgAnimation is set up; then measures the contestants in
/// turns.
void race(std::vector<Contestant>& contestants, int rounds);

/// The faults of the drawn frames; empty if there are none.
std::string check(std::vector<Contestant>& contestants);

/// Bytes allocated on the heap; they include the GPU's memory if GL is a software renderer.
double bytesInUse();

/// The row with its labels.
Row named(Row row, const Subject& subject, std::size_t count, const std::string& what, const char* unit,
          const char* other);
/// A row of our figure alone; bar: the limit in words; empty: there is none.
Row limited(const Figure& ours, double limit, const std::string& bar, const Subject& subject, std::size_t count,
            const std::string& what, const char* unit);

} // namespace osgGpuAnimation::benchmark
