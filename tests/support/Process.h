// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The result of a program that has ended.
struct Process
{
    int status = -1;        ///< exit status; 128 + n if signal n ended it, -1 if it did not start
    double seconds = 0.0;   ///< CPU time: other programs may run
    long peakMebibytes = 0; ///< peak memory
    std::string out;        ///< standard output
    std::string err;        ///< standard error

    /// Runs the program to its end with these arguments and empty standard input.
    static Process run(const std::string& program, const std::vector<std::string>& arguments);
};

} // namespace osgGpuAnimation
