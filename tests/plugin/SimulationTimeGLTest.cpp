// SPDX-License-Identifier: MIT
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/ViewerGLTest.h"

// The same simulation times show the same pictures, whatever the times before.

namespace osgGpuAnimation
{

namespace
{

struct WayCase
{
    const char* name;
    std::vector<double> times; ///< seconds, from 0 to 1.9
};

std::vector<double> steps(double end, double step)
{
    std::vector<double> times;
    for (int i = 0; i * step < end; ++i)
        times.push_back(i * step);
    times.push_back(end);
    return times;
}

const double end = 1.9;

const WayCase ways[] = {
    {"SixtyASecond", steps(end, 1.0 / 60.0)},        {"SevenASecond", steps(end, 1.0 / 7.0)},
    {"Paused", {0.0, 0.6, 0.6, 0.6, 0.6, 1.9, 1.9}}, {"Backwards", {0.0, 4.0, 3.0, 2.5, 1.9}},
    {"BackBeyondTheStart", {0.0, 1.0, -7.3, 1.9}},   {"FarAndBack", {0.0, 100000.0, 1.9}},
};

class SimulationTimeGLTest : public ViewerGLTest, public ::testing::WithParamInterface<WayCase>
{
protected:
    osg::ref_ptr<osg::Image> pictureAfter(const std::string& file, const std::vector<double>& times)
    {
        return pictureOf(osgDB::readRefNodeFile(ownScene(file)), times);
    }

    StoredScene plugins;
};

} // namespace

TEST_P(SimulationTimeGLTest, theWayPlaysNoPart)
{
    for (const std::string file : {"Wanderer.glb", "Wanderer.glb.2x2.crowd"})
    {
        SCOPED_TRACE(file);
        const osg::ref_ptr<osg::Image> direct = pictureAfter(file, {0.0, end});
        EXPECT_EQ(Picture::pixelsDifferent(*direct, *pictureAfter(file, GetParam().times)), 0);
        EXPECT_GT(Picture::pixelsDifferent(*direct, *pictureAfter(file, {0.0, end - 0.5})), 5) << "nothing moves";
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, SimulationTimeGLTest, ::testing::ValuesIn(ways),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace osgGpuAnimation
