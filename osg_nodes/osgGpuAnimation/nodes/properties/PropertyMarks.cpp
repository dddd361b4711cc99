// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/PropertyMarks.h>

#include <osgGpuAnimation/nodes/properties/PropertyPointer.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace osgGpuAnimation
{

void markVisibility(osg::Node& node, const std::vector<int>& nodes)
{
    std::string text;
    for (const int each : nodes)
        text += (text.empty() ? "" : " ") + std::to_string(each);
    node.setUserValue(visibilityMark, text);
}

std::optional<int> markOf(const osg::Object& object, const char* mark)
{
    int index = 0;
    return object.getUserValue(mark, index) ? std::optional<int>(index) : std::nullopt;
}

// A saved scene may hold any text.
std::vector<int> visibilityOf(const osg::Object& object)
{
    std::string text;
    std::vector<int> nodes;
    if (!object.getUserValue(visibilityMark, text)) return nodes;
    for (std::size_t begin = 0; begin < text.size();)
    {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        if (const std::optional<int> node = parsePointerIndex(std::string_view(text).substr(begin, end - begin)))
            nodes.push_back(*node);
        begin = end + 1;
    }
    return nodes;
}

bool isMeshMarked(const osg::Drawable& mesh)
{
    return !visibilityOf(mesh).empty() || (mesh.getStateSet() && markOf(*mesh.getStateSet(), materialMark));
}

osg::UserDataContainer& ownUserData(osg::Object& object)
{
    osg::ref_ptr<osg::UserDataContainer> own = new osg::DefaultUserDataContainer;
    if (const osg::UserDataContainer* shared = object.getUserDataContainer()) own = osg::clone(shared);
    object.setUserDataContainer(own);
    return *own;
}

void removeMark(osg::Object& object, const char* mark)
{
    osg::UserDataContainer& data = ownUserData(object);
    const unsigned int index = data.getUserObjectIndex(mark);
    if (index < data.getNumUserObjects()) data.removeUserObject(index);
}

} // namespace osgGpuAnimation
