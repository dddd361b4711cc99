// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/AffineMatrix.h>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Joints with their inverse bind matrices (glTF 2.0, section 3.7.3).
struct Skin
{
    std::string name;                       ///< not necessarily unique
    std::vector<int> joints;                ///< joints of the skeleton
    std::vector<AffineMatrix> inverseBinds; ///< one per joint: from the mesh's space at bind time to joint space
};

} // namespace osgGpuAnimation
