// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// Lines over two logarithmic axes, as an SVG picture.
class Plot
{
public:
    void describe(const std::string& title, const std::string& xTitle, const std::string& yTitle);
    /// Points of a line in the order in which they are joined; both above 0, others are left out. Lines that are called
    /// the same up to a comma have one colour, and those that are called the same behind it are dashed alike.
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
    /// Which of the different parts of the lines' names, before the comma or from it on, the line's is.
    std::size_t placeAmong(std::string (*part)(const std::string& name), std::size_t number) const;

    std::string _title, _xTitle, _yTitle;
    std::vector<Line> _lines;
};

} // namespace osgGpuAnimation::benchmark
