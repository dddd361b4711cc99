// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/viewing/Standpoint.h>

#include <osg/CameraView>
#include <osg/Image>
#include <osg/Vec3d>
#include <osgViewer/Viewer>

#include <memory>
#include <optional>
#include <vector>

namespace osgGpuAnimation::tool
{

/// The light of a picture. Directions are in OSG's axes.
enum class Look
{
    Studio, ///< Environment's studio alone, with tone mapping
    Sun, ///< a light from (0.6, -0.9, 1.1) of irradiance / pi (0.7, 0.7, 0.68), and a white surrounding of radiance 0.3
    Furnace, ///< a white surrounding of radiance 1 alone, in which white surfaces are white
    File     ///< the file's own lights, and a white surrounding of radiance 0.05
};

/// A viewer without a display whose frames become images: soft background, four samples per pixel if the driver
/// supports them.
///
///     Result<std::unique_ptr<PictureViewer>> viewer = PictureViewer::create(800, 600, Look::Studio, new Environment);
///     viewer.value()->show(scene, points, std::nullopt);
///     osg::ref_ptr<osg::Image> image = viewer.value()->draw(0.5);
class PictureViewer
{
public:
    /// surroundings: of Look::Studio. Error: no graphics context, or none of that size, can be created.
    static Result<std::unique_ptr<PictureViewer>> create(int width, int height, Look look,
                                                         const osg::ref_ptr<Environment>& surroundings);
    ~PictureViewer();

    /// Places the camera so that it sees all these points, from that direction or as raisedStandpoint() does.
    void show(osg::Node* scene, const std::vector<osg::Vec3d>& points, const std::optional<ViewDirection>& from);
    /// Moves the camera around the vertical line through the middle of these points, away from its first place:
    /// degrees, counter-clockwise from above.
    void turn(double degrees);
    /// From here on, sees what that camera of the scene sees, wherever it moves.
    void lookThrough(const osg::CameraView& view);
    /// Draws a frame at that simulation time (seconds): RGB, 8 bits each. Null if GL reports an error.
    osg::ref_ptr<osg::Image> draw(double simulationTime);

private:
    PictureViewer();

    class ReadPixels;

    osgViewer::Viewer _viewer;
    osg::ref_ptr<ReadPixels> _reader;
    Look _look = Look::Studio;
    Standpoint _place;                         ///< of show()
    osg::Vec3d _axis;                          ///< a point on the line of turn()
    osg::ref_ptr<const osg::CameraView> _view; ///< null: the standpoint of show()
    osg::ref_ptr<Environment> _surroundings;   ///< of Look::Studio
};

} // namespace osgGpuAnimation::tool
