// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/nodes/studio/Backdrop.h>

namespace osgGpuAnimation
{

/// Shows its children in a studio: image-based light with tone mapping, a backdrop, and a soft ground at the children's
/// lowest point, which receives the shadow of the key light. `FILE.glb.studio` reads as such a node.
///
/// OSG's lights from above are off; those below still shine. Meshes without PbrMaterial are lit evenly. Backdrop and
/// ground are no children: bounds, intersectors and near and far planes do not see them. They are drawn first, over the
/// whole viewport, and in no depth-only camera.
///
/// The update traversal fits ground and shadow to the children. The ground keeps the height of the first update. In
/// surroundings from a picture, the shadow is that of their brightest light above the ground; in even ones, the ground
/// is only darker close to the model.
class Studio : public Environment
{
public:
    Studio();
    Studio(const Studio& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, Studio)

    void traverse(osg::NodeVisitor& visitor) override;

    /// Empty before the first update traversal, or if nothing is drawn below.
    const std::optional<Ground>& getGround() const { return _ground; }

    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;
    void setThreadSafeRefUnref(bool threadSafe) override;

protected:
    ~Studio() override = default;

private:
    void fit();
    bool fitLight();

    osg::ref_ptr<KeyShadow> _shadow;
    Backdrop _backdrop;
    osg::BoundingSphere _fitted;                        ///< the bound that ground and shadow are fitted to
    osg::ref_ptr<const osg::TextureCubeMap> _fittedMap; ///< and the surroundings
    float _fittedRotation = 0.0f;                       ///< radians
    osg::Vec3d _towardsLight;                           ///< of length 1; 0: not fitted
    double _shade = 0.0;                                ///< see Ground
    std::optional<Ground> _ground;
};

} // namespace osgGpuAnimation
