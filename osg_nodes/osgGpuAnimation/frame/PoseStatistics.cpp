// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/PoseStatistics.h>

#include <osg/ValueObject>
#include <osgViewer/View>
#include <osgViewer/ViewerEventHandlers>

namespace osgGpuAnimation
{

namespace
{

constexpr const char* hasLines = "osgGpuAnimation lines";

struct Line
{
    const char* label;
    const char* attribute;
    float multiplier; ///< from the attribute to the displayed number
    float max;        ///< the largest number in the graph
};

constexpr Line lines[] = {
    {"Characters seen", PoseStatistics::charactersSeen, 1.0f, 10000.0f},
    {"Characters evaluated", PoseStatistics::charactersEvaluated, 1.0f, 10000.0f},
    {"Joints seen", PoseStatistics::jointsSeen, 1.0f, 1000000.0f},
    {"Feedback on the GPU, microseconds", PoseStatistics::timeTaken, 1e6f, 0.016f},
};

/// A new line resets the handler, and a page that is visible at that time would lose its numbers.
bool isShown(osgViewer::StatsHandler& handler)
{
    return handler.getCamera()->getGraphicsContext() && handler.getCamera()->getNodeMask() != 0;
}

void addLinesTo(osgViewer::StatsHandler& handler)
{
    bool isDone = false;
    if ((handler.getUserValue(hasLines, isDone) && isDone) || isShown(handler)) return;
    handler.setUserValue(hasLines, true);
    const osg::Vec4 color(1.0f, 0.8f, 0.5f, 1.0f);
    for (const Line& line : lines)
        handler.addUserStatsLine(line.label, color, color, line.attribute, line.multiplier, true, false, "", "",
                                 line.max);
}

} // namespace

bool PoseStatistics::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object*,
                            osg::NodeVisitor*)
{
    if (event.getEventType() == osgGA::GUIEventAdapter::KEYDOWN) addLines(action);
    return false;
}

void PoseStatistics::addLines(osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(action.asView());
    if (!view) return;
    for (const osg::ref_ptr<osgGA::EventHandler>& handler : view->getEventHandlers())
        if (auto* statsHandler = dynamic_cast<osgViewer::StatsHandler*>(handler.get())) addLinesTo(*statsHandler);
}

osg::Stats* PoseStatistics::wanted(osg::RenderInfo& renderInfo)
{
    auto* view = dynamic_cast<osgViewer::View*>(renderInfo.getView());
    const osg::Stats* cameraStats = view ? view->getCamera()->getStats() : nullptr;
    if (!cameraStats || !cameraStats->collectStats("gpu") || !view->getViewerBase()) return nullptr;
    return view->getViewerBase()->getViewerStats();
}

} // namespace osgGpuAnimation
