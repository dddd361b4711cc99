// SPDX-License-Identifier: MIT
// Old include path until data/ and scene/ have moved.
#pragma once

#include "gltf/file/Uri.h"
