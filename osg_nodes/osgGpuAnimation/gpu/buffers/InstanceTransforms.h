// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/math/JointTransform.h>

#include <osg/GLObjects>
#include <osg/State>

#include <array>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// The transform of one instance of an instanced draw, as skin.glsl reads it: four vertex attributes.
struct InstanceTransform
{
    AffineMatrix toEye; ///< from the character's space to eye space
    float pose = 0.0f;  ///< the instance's index in the PoseBatch, an integer
    std::array<float, 3> unused{};
};

static_assert(sizeof(InstanceTransform) == 4 * BufferTexture::texelBytes, "an instance transform is four attributes");

/// The instances of one or several lists, in sequence: characters that show the same meshes share a list.
using InstanceLists = std::vector<std::shared_ptr<const std::vector<InstanceTransform>>>;

/// The buffers of instance transforms of one graphics context. It keeps the last lists that were drawn, since all
/// meshes of the same characters are drawn in sequence. Call it on the draw side only, with the context current.
class InstanceTransformBuffers : public osg::GraphicsObjectManager
{
public:
    explicit InstanceTransformBuffers(unsigned int contextId);

    static InstanceTransformBuffers& of(osg::State& state);

    /// Lists in one array and one buffer.
    struct Joined
    {
        InstanceLists lists;
        std::vector<InstanceTransform> transforms;
        std::unique_ptr<BufferTexture> buffer; ///< has the transforms if isUploaded
        bool isUploaded = false;
    };

    /// The lists, which do not change any more. Valid until two others are asked for. uploads: the draw reads them.
    const Joined& joined(const InstanceLists& lists, bool uploads);

    void flushDeletedGLObjects(double, double&) override {}
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override;
    void discardAllGLObjects() override;

protected:
    ~InstanceTransformBuffers() override = default;

private:
    Joined& find(const InstanceLists& lists);

    std::array<Joined, 2> _joined;
    std::size_t _oldest = 0;
};

} // namespace osgGpuAnimation
