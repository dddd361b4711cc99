// SPDX-License-Identifier: MIT
#pragma once

#include <osg/RenderInfo>
#include <osg/Stats>
#include <osgGA/GUIEventHandler>

namespace osgGpuAnimation
{

/// The number of poses in a frame and their GPU time, as lines on the page of osgViewer::StatsHandler (key s, twice).
///
///     viewer.addEventHandler(new PoseStatistics);
///
/// The first key press adds the lines to the viewer's StatsHandlers. CharacterKeys does the same, so characters that
/// were read from a file show their lines in the stock osgviewer.
///
/// While a view's camera collects "gpu" statistics, as it does when that page is visible, the draw side records these
/// attributes of the frame in the viewer's osg::Stats; otherwise it counts and measures nothing. With several contexts
/// the values are those of the last one drawn.
class PoseStatistics : public osgGA::GUIEventHandler
{
public:
    /// Attribute: the number of visible characters, each once for all cameras.
    static constexpr const char* charactersSeen = "Animated characters seen";
    /// Attribute: the number of visible characters whose pose has changed.
    static constexpr const char* charactersEvaluated = "Animated characters evaluated";
    /// Attribute: the number of joints of the visible characters.
    static constexpr const char* jointsSeen = "Animated joints seen";
    /// Attribute: seconds of GPU time, from time stamps. It means nothing for a driver without a GPU, such as llvmpipe,
    /// which computes poses while it accepts the draw and takes the stamps later.
    static constexpr const char* timeTaken = "Animation feedback time taken";

    PoseStatistics() = default;
    /// A copy; the object has no state.
    PoseStatistics(const PoseStatistics& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop)
    {
    }
    META_Object(osgGpuAnimation, PoseStatistics)

    using osgGA::GUIEventHandler::handle;
    /// Adds the lines at a key press and always returns false.
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;

    /// Adds the lines to the StatsHandlers of the view that sent an event, once per handler.
    static void addLines(osgGA::GUIActionAdapter& action);

    /// The statistics of the viewer that is drawing; null: nobody collects "gpu" statistics.
    static osg::Stats* wanted(osg::RenderInfo& renderInfo);

protected:
    ~PoseStatistics() override = default;
};

} // namespace osgGpuAnimation
