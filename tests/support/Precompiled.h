// SPDX-License-Identifier: MIT
// The headers that most tests of nodes and files read: most of the time of their compilation otherwise.
#ifndef OSGGPUANIMATION_TESTS_PRECOMPILED_H
#define OSGGPUANIMATION_TESTS_PRECOMPILED_H

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/CullVisitor>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#endif
