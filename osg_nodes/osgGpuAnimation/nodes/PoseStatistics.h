// SPDX-License-Identifier: MIT
#pragma once

#include <osg/RenderInfo>
#include <osg/Stats>
#include <osgGA/GUIEventHandler>

namespace osgGpuAnimation
{

/// What the poses of a frame are and cost, as lines on the page that osgViewer::StatsHandler shows (key s, twice).
///
///     viewer.addEventHandler(new PoseStatistics);
///
/// adds the lines to the viewer's StatsHandlers when a key is pressed; CharacterKeys does so by itself, so characters
/// that were read from a file show theirs in the stock osgviewer.
///
/// While a view's camera collects "gpu" statistics, as it does when that page is shown, the draw side records these
/// attributes of the frame in the viewer's osg::Stats; while it does not, nothing is counted and the GPU not asked.
/// With several contexts they are those of the one drawn last.
class PoseStatistics : public osgGA::GUIEventHandler
{
public:
    static constexpr const char* charactersSeen = "Animated characters seen";
    static constexpr const char* charactersEvaluated = "Animated characters evaluated"; ///< seen, and changed
    static constexpr const char* jointsSeen = "Animated joints seen";
    static constexpr const char* timeTaken = "Animation feedback time taken"; ///< seconds of the GPU, by time stamps

    PoseStatistics() = default;
    PoseStatistics(const PoseStatistics& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, PoseStatistics)

    using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;

    /// Adds the lines to the StatsHandlers of the view that sent an event, once each.
    static void addLines(osgGA::GUIActionAdapter& action);

    /// Where to record the frame that is being drawn; null while nobody collects.
    static osg::Stats* wanted(osg::RenderInfo& renderInfo);

protected:
    ~PoseStatistics() override = default;
};

} // namespace osgGpuAnimation
