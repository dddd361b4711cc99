// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Object>
#include <osg/Vec3>
#include <osg/Vec4>

#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// What some instances of an AnimatedCrowd show: which parts, in which materials, with which props. Instances of all
/// outfits share poses, levels of detail and draws.
///
///     osg::ref_ptr<Outfit> guard = new Outfit;
///     guard->setVisible("Hood", false);                                     // a part, by the name of its node
///     guard->setColor("Coat", osg::Vec4(0.5, 0.2, 0.2, 1));                 // a material; the skin keeps its colour
///     guard->setJointScale("Head", osg::Vec3(0.9, 0.9, 0.9));               // proportions of the body
///     guard->addProp("Head", osgDB::readRefNodeFile("helmet.glb"));
///     if (auto added = crowd->getOutfits().add(guard); !added) std::cerr << added.error().message << "\n";
///     crowd->setOutfit(instance, guard);
///
/// Names of parts are those of CharacterMeshes::find(), names of materials those of StateSets. Garments are parts: let
/// the character wear() them before the crowd is made of it.
///
/// CrowdOutfits::add() checks an outfit against the crowd. Pass it to CrowdOutfits::replace() after later changes.
/// Several crowds may have the same outfit. OSG's own formats keep outfits with their crowds.
class Outfit : public osg::Object
{
public:
    /// A rigid model on a joint.
    struct Prop
    {
        std::string joint;            ///< its name
        osg::ref_ptr<osg::Node> node; ///< with geometries
        osg::Matrixd toJoint;         ///< from the node's space to the joint's

        /// True if the props are the same part.
        bool operator==(const Prop& other) const
        {
            return joint == other.joint && node == other.node && toJoint == other.toJoint;
        }
    };

    Outfit() = default; ///< shows what the crowd shows
    /// Shares pictures and props, or copies them as copyop says.
    Outfit(const Outfit& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY)
        : osg::Object(other, copyop), _visibility(other._visibility), _variant(other._variant), _colors(other._colors),
          _pictures(other._pictures), _jointScales(other._jointScales), _props(other._props)
    {
        for (auto& [material, picture] : _pictures)
            picture = copyop(picture.get());
        for (Prop& prop : _props)
            prop.node = copyop(prop.node.get());
    }
    META_Object(osgGpuAnimation, Outfit)

    /// Shows or hides a part, whether or not the crowd shows it.
    void setVisible(const std::string& part, bool isVisible) { _visibility[part] = isVisible; }
    const std::map<std::string, bool>& getVisibility() const { return _visibility; } ///< by part

    /// Shows all parts in a variant of the file's materials, see CharacterMeshes::setVariant(). Empty (the default): in
    /// that of the crowd.
    void setVariant(const std::string& name) { _variant = name; }
    const std::string& getVariant() const { return _variant; } ///< see setVariant()

    /// Multiplies the colour of a material. color: as displayed, not linear; each component in [0, 1]; the tint of an
    /// instance multiplies it, too.
    void setColor(const std::string& material, const osg::Vec4& color) { _colors[material] = color; }
    const std::map<std::string, osg::Vec4>& getColors() const { return _colors; } ///< by material

    /// Replaces the base-colour texture of a material. Parts of that material need a draw for each picture.
    void setPicture(const std::string& material, osg::Image* picture) { _pictures[material] = picture; }
    const std::map<std::string, osg::ref_ptr<osg::Image>>& getPictures() const { return _pictures; } ///< by material

    /// Scales a joint along its own axes, with all joints below it, whatever clips and layers set for its scale. Such
    /// instances share no poses, see CharacterMeshes::setPixelError(), and have their rest proportions while a
    /// controller mixes PoseInstruction::maxSamples samples. scale: of its scale at rest; each component in [0.1, 10].
    void setJointScale(const std::string& joint, const osg::Vec3& scale) { _jointScales[joint] = scale; }
    const std::map<std::string, osg::Vec3>& getJointScales() const { return _jointScales; } ///< by joint

    /// Adds the geometries below a node as parts that follow a joint, at the cost of other parts; JointAttachment is
    /// for nodes with callbacks or lights of their own. A prop of several outfits is the same part if joint, node and
    /// matrix are equal. joint: the name of one that moves a mesh of the crowd. toJoint: from the node's space to the
    /// joint's.
    void addProp(const std::string& joint, osg::Node* node, const osg::Matrixd& toJoint = osg::Matrixd())
    {
        _props.push_back({joint, node, toJoint});
    }
    const std::vector<Prop>& getProps() const { return _props; } ///< in the order of addProp()

protected:
    ~Outfit() override = default;

private:
    std::map<std::string, bool> _visibility;
    std::string _variant;
    std::map<std::string, osg::Vec4> _colors;
    std::map<std::string, osg::ref_ptr<osg::Image>> _pictures;
    std::map<std::string, osg::Vec3> _jointScales;
    std::vector<Prop> _props;
};

} // namespace osgGpuAnimation
