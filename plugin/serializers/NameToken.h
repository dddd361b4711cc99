// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::serializers
{

/// A name as one word of plain characters, percent-encoded like a URI ("Hand R" is Hand%20R, nothing is %): OSG 3.6's
/// quoted strings do not end where a text file was cut off.
std::string toToken(const std::string& name);
/// What toToken() made; of other words, what can be made of them.
std::string fromToken(const std::string& token);

} // namespace osgGpuAnimation::serializers
