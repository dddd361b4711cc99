// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/FeedbackVertexArrays.h>

#include <algorithm>

namespace osgGpuAnimation
{

const FeedbackVertexArrays::Names& FeedbackVertexArrays::of(osg::State& state)
{
    const auto known =
        std::find_if(_names.begin(), _names.end(), [&](const Names& names) { return names.state == &state; });
    if (known != _names.end()) return *known;
    _names.erase(std::remove_if(_names.begin(), _names.end(), [](const Names& names) { return !names.state.valid(); }),
                 _names.end());
    Names names;
    names.state = &state;
    _gl->glGenVertexArrays(1, &names.pose);
    _gl->glGenVertexArrays(1, &names.empty);
    _names.push_back(names);
    return _names.back();
}

void FeedbackVertexArrays::release()
{
    if (_names.size() == 1)
    {
        _gl->glDeleteVertexArrays(1, &_names.front().pose);
        _gl->glDeleteVertexArrays(1, &_names.front().empty);
    }
    discard();
}

} // namespace osgGpuAnimation
