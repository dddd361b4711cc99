// SPDX-License-Identifier: MIT
#include "gltf/import/NodePlaces.h"

#include "gltf/file/Elements.h"
#include "gltf/import/NodeTransform.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/MatrixTransform>

namespace osgGpuAnimation::gltf
{

osg::Group& NodePlaces::placeOf(std::size_t node)
{
    // A loop, because nodes may be nested thousands deep. A node that moves is a joint or below one.
    std::vector<std::size_t> missing;
    for (std::size_t next = node; !_places[next]; next = static_cast<std::size_t>(_tree.parents[next]))
    {
        missing.push_back(next);
        if (_joints.ofNode[next] >= 0) break;
    }
    for (; !missing.empty(); missing.pop_back())
        _places[missing.back()] = makePlace(missing.back());
    return *_places[node];
}

/// The parent of a node that is no joint has a place.
osg::ref_ptr<osg::Group> NodePlaces::makePlace(std::size_t node) const
{
    const int joint = _joints.ofNode[node];
    osg::ref_ptr<osg::Group> place;
    if (joint >= 0)
    {
        place = new JointAttachment(joint);
        _character->addChild(place);
    }
    else
    {
        place = new osg::MatrixTransform(toOsg(localMatrix(_model.nodes[node])));
        elementOf(_places, _tree.parents[node])->addChild(place);
    }
    place->setName(_model.nodes[node].name);
    return place;
}

} // namespace osgGpuAnimation::gltf
