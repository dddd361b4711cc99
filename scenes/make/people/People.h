// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::scenes
{

/// Writes the people: the wanderer's body, rig and clips, with a choice of garments and of what the left hand carries.
/// Each is a node of its own, and the file shows all of them at once: the outfits of People.outfits.json choose. Cloth,
/// hair and hats have the colour of undyed wool, to be multiplied by a colour for their material.
/// Throws std::runtime_error where the file cannot be written.
void writePeople(const std::string& path);

} // namespace osgGpuAnimation::scenes
