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

/// A scene in a viewer of its own, and what its frames took.
struct Contestant
{
    std::shared_ptr<StagedViewer> viewer;
    double time = 0.0;
    Series whole, updateAndCull, draw;

    FrameCost frame();
    void measure(); ///< a frame
};

/// Errors: there is no GL.
Result<Contestant> contestant(osg::Node* scene, const osg::BoundingSphere& sight);

/// Frames until programs are made, buffers are there and osgAnimation has set itself up; then rounds by turns.
void race(std::vector<Contestant>& contestants, int rounds);

/// What is wrong with the frames drawn; empty: nothing.
std::string check(std::vector<Contestant>& contestants);

/// The row, with what it is about.
Row named(Row row, const Subject& subject, std::size_t count, const std::string& what, const char* unit,
          const char* other);

} // namespace osgGpuAnimation::benchmark
