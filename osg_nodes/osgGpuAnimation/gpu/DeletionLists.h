// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Referenced>
#include <osg/State>

namespace osgGpuAnimation
{

/// OSG's lists of a context's programs, shaders and vertex array objects to be deleted. OSG makes each when the first
/// object is dropped, by whatever thread drops it and without a lock, while the draw thread may be looking through its
/// lists: a DatabasePager whose last character goes would do so. Made beforehand, they only have to be found.
class DeletionLists : public osg::Referenced
{
public:
    explicit DeletionLists(unsigned int) {}

    /// Makes the lists of the state's context unless they are made. The context is current.
    static void make(osg::State& state);

protected:
    ~DeletionLists() override = default;

private:
    bool _areMade = false;
};

} // namespace osgGpuAnimation
