// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/Outfit.h>

#include <osg/Vec3d>

#include <functional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// An outfit with the instances that wear it.
struct OutfitShare
{
    osg::ref_ptr<Outfit> outfit; ///< for CrowdOutfits::add()
    double share = 1.0;          ///< of the instances, relative to those of the other outfits; at least 0
    osg::Vec3d size{1, 1, 1};    ///< scales of its instances along X, Y and Z of their own space, each above 0
};

/// What reads the pictures and props of an outfits file: the kit itself reads no files of others. Null: a file that
/// names such is an error.
struct OutfitReaders
{
    std::function<osg::ref_ptr<osg::Image>(const std::string& path)> picture; ///< null result: it cannot be read
    std::function<osg::ref_ptr<osg::Node>(const std::string& path)> model;    ///< null result: it cannot be read
};

/// Reads outfits from a short JSON file (people.outfits.json), for CrowdOutfits::add():
///
///     {
///       "outfits": [
///         { "name": "pilgrim", "share": 2, "hide": ["Lantern", "Cap"], "colors": { "Coat": "#7a5c3a" } },
///         { "name": "child", "size": 0.75, "show": ["Hood"], "variant": "winter",
///           "pictures": { "Shirt": "stripes.png" }, "proportions": { "Head": 1.2, "Chest": [1.1, 1, 1] },
///           "props": [ { "joint": "Head", "file": "hat.glb", "offset": [0, 0.1, 0] } ] }
///       ]
///     }
///
/// size: a number, or three of width, depth and height: [1.15, 1.1, 0.95] is broader and shorter. hide, show: names of
/// parts, one or an array. colors: by material, "#rrggbb" as displayed. proportions: scales of joints, like size.
/// pictures, and the files of props: relative to the folder of the file, not above it. offset: of the prop's origin, in
/// the joint's space; default 0. Missing members have the defaults of Outfit and OutfitShare.
///
/// Errors start with the name of the file and name the member: invalid JSON; more than 64 KiB or 256 nested levels; a
/// member of a wrong type or an unknown name; a duplicate or missing member; a file that cannot be read; no outfits; a
/// share below 0, or shares that are all 0; a size that is not above 0. Whether a crowd has the parts and materials is
/// for CrowdOutfits::add().
Result<std::vector<OutfitShare>> readOutfitsFile(const std::string& file, const OutfitReaders& readers = {});

} // namespace osgGpuAnimation
