// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// A line plot over two logarithmic axes, written as SVG.
class Plot
{
public:
    void describe(const std::string& title, const std::string& xTitle, const std::string& yTitle);
    /// Appends a point to the line; x and y must be above 0, other points are ignored. Lines whose names agree before
    /// the comma share a colour; lines whose names agree from the comma on share a dash pattern.
    void addPoint(const std::string& line, double x, double y);

    void write(std::ostream& out) const;

private:
    struct Line
    {
        std::string name;
        std::vector<std::pair<double, double>> points;
    };
    struct Frame;

    Frame frame() const;
    void writeAxes(std::ostream& out, const Frame& frame) const;
    void writeLine(std::ostream& out, const Frame& frame, std::size_t number) const;
    /// The index of this part of the line's name among the different parts of all lines, in the order of their first
    /// use.
    std::size_t placeAmong(std::string (*part)(const std::string& name), std::size_t number) const;

    std::string _title, _xTitle, _yTitle;
    std::vector<Line> _lines;
};

} // namespace osgGpuAnimation::benchmark
