// SPDX-License-Identifier: MIT
#include "gltf/view/NodePlaces.h"

#include "gltf/scene/NodeTransform.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/OsgMatrix.h>

#include <osg/MatrixTransform>

#include <utility>

namespace osgGpuAnimation::gltf
{

NodePlaces::NodePlaces(const tinygltf::Model& model, const NodeTree& tree, const Joints& joints,
                       AnimatedCharacter* character, std::vector<osg::ref_ptr<osg::Group>> transforms)
    : _model(model), _tree(tree), _joints(joints), _character(character), _places(std::move(transforms))
{
}

void NodePlaces::add(std::size_t node, osg::Node* child)
{
    placeOf(node).addChild(child);
}

osg::Group& NodePlaces::placeOf(std::size_t node)
{
    if (_joints.moves[node] && !_places[node]) _places[node] = makeAttachment(node);
    return *_places[node];
}

osg::ref_ptr<osg::Group> NodePlaces::makeAttachment(std::size_t node) const
{
    // A node that moves is a joint or below one.
    glm::dmat4 toJoint(1.0);
    std::size_t joint = node;
    for (; _joints.ofNode[joint] < 0; joint = static_cast<std::size_t>(_tree.parents[joint]))
        toJoint = localMatrix(_model.nodes[joint]) * toJoint;
    osg::ref_ptr<osg::Group> attachment = new JointAttachment(_joints.ofNode[joint]);
    attachment->setName(_model.nodes[joint].name);
    _character->addChild(attachment);
    if (joint == node) return attachment;
    osg::ref_ptr<osg::Group> place = new osg::MatrixTransform(toOsg(toJoint));
    place->setName(_model.nodes[node].name);
    attachment->addChild(place);
    return place;
}

} // namespace osgGpuAnimation::gltf
