// SPDX-License-Identifier: MIT
#include "serializers/RequiredProperty.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

static bool writeJoint(osgDB::OutputStream& stream, const JointAttachment& attachment)
{
    ValueWriter(stream).integer(attachment.joint()).text(attachment.jointName()).endLine();
    return true;
}

static bool readJoint(osgDB::InputStream& stream, JointAttachment& attachment)
{
    ValueReader in(stream);
    const std::int32_t joint = in.integer();
    const std::string name = in.text();
    if (name.empty())
        attachment.setJoint(joint);
    else
        attachment.setJoint(name);
    return in.isGood();
}

REGISTER_OBJECT_WRAPPER(osgGpuAnimation_JointAttachment, new JointAttachment, osgGpuAnimation::JointAttachment,
                        "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform "
                        "osg::MatrixTransform osgGpuAnimation::JointAttachment")
{
    ADD_REQUIRED_SERIALIZER(Joint);
}

} // namespace osgGpuAnimation::serializers
