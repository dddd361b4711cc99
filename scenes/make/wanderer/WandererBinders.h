// SPDX-License-Identifier: MIT
#pragma once

#include "../Part.h"
#include "../Rig.h"

namespace osgGpuAnimation::scenes
{

/// What moves the coat and all that lies on it: the trunk's joints by height, the thighs towards the hem, the
/// shoulders at the sides. Holds the rig's joint numbers only.
Binder coatBinder(const Rig& rig);
/// The left sleeve: chest, shoulder, upper and lower arm, hand.
Binder armBinder(const Rig& rig);
/// The left glove: hand and both finger joints.
Binder gloveBinder(const Rig& rig);
/// The left leg from the hips down to the toes.
Binder legBinder(const Rig& rig);
/// All of the part on one joint.
Binder rigidBinder(int joint);

} // namespace osgGpuAnimation::scenes
