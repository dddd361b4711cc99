// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A program that was run to its end.
struct Process
{
    int status = -1;        ///< exit status; 128 + n where signal n ended it, -1 where it did not start
    double seconds = 0.0;   ///< of the processor: other programs may run
    long peakMebibytes = 0; ///< the most memory it had
    std::string out;        ///< what it wrote to standard output
    std::string err;        ///< and to standard error

    /// Runs the program with these arguments, nothing on standard input.
    static Process run(const std::string& program, const std::vector<std::string>& arguments);
};

} // namespace osgGpuAnimation
