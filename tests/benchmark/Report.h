// SPDX-License-Identifier: MIT
#pragma once

#include "Plot.h"
#include "Series.h"

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// A row of the table: our figure against another contestant's or against a limit.
struct Row
{
    std::string subject;
    std::size_t count = 0; ///< characters
    std::string what;
    std::string unit;      ///< of ours and other, such as `µs a joint`
    Figure ours;           ///< CPU time, unless the unit says otherwise
    std::string otherName; ///< empty if there is none
    Figure other;
    Figure ratio; ///< CPU time; the bar limits it
    Figure wallRatio;
    std::string bar;   ///< empty: none
    bool isMet = true; ///< true if the ratio (or ours) is within the bar
};

/// Collects the results and writes them as a table, JSON and plots.
class Report
{
public:
    void add(Row row);
    void addPoint(const std::string& plot, const std::string& line, double x, double y);
    void describePlot(const std::string& plot, const std::string& title, const std::string& xTitle,
                      const std::string& yTitle);

    void printTable(std::ostream& out) const; ///< Markdown
    /// environment: names and values that are written with the figures. False: a file cannot be written.
    bool write(const std::string& folder, const std::map<std::string, std::string>& environment) const;

private:
    std::vector<Row> _rows;
    std::map<std::string, Plot> _plots; ///< by file name
};

/// A row of two contestants. scale: the factor from CPU seconds to the unit. The ratio is other / ours if isSpeedup,
/// else ours / other.
Row compared(const Series& ours, const Series& other, double scale, bool isSpeedup);

} // namespace osgGpuAnimation::benchmark
