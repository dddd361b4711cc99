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

void NodePlaces::add(std::size_t node, osg::Node* child)
{
    // A loop, because nodes may be nested thousands deep. A node that moves is a joint or below one.
    std::vector<std::size_t> missing;
    for (std::size_t next = node; !_places[next]; next = static_cast<std::size_t>(_tree.parents[next]))
    {
        missing.push_back(next);
        if (_joints.ofNode[next] >= 0) break;
    }
    for (; !missing.empty(); missing.pop_back())
    {
        const std::size_t next = missing.back();
        const int joint = _joints.ofNode[next];
        osg::Group* const parent = joint >= 0 ? _character : elementOf(_places, _tree.parents[next]).get();
        if (joint >= 0)
            _places[next] = new JointAttachment(joint);
        else
            _places[next] = new osg::MatrixTransform(toOsg(localMatrix(_model.nodes[next])));
        _places[next]->setName(_model.nodes[next].name);
        parent->addChild(_places[next]);
    }
    _places[node]->addChild(child);
}

} // namespace osgGpuAnimation::gltf
