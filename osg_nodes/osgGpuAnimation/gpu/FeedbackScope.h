// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>

namespace osgGpuAnimation
{

/// Between its making and its end feedback passes may run: rasterizing is off and a vertex array object of our own is
/// bound. At its end OSG's state is what OSG believes it to be.
class FeedbackScope
{
public:
    /// units: how many texture units, from 0 on, the passes bind buffer textures to.
    FeedbackScope(osg::State& state, GLuint vertexArray, int units);
    ~FeedbackScope();
    FeedbackScope(const FeedbackScope&) = delete;
    FeedbackScope& operator=(const FeedbackScope&) = delete;

private:
    osg::State& _state;
    int _units;
    osg::State::ApplyModeProxy _discard;
};

} // namespace osgGpuAnimation
