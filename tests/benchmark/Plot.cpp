// SPDX-License-Identifier: MIT
#include "Plot.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr double width = 850, height = 420, left = 70, right = 320, top = 40, bottom = 50; // pixels
constexpr const char* colors[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b",
                                  "#e377c2", "#7f7f7f", "#17becf", "#bcbd22", "#000000", "#aec7e8"};
constexpr const char* dashes[] = {"none", "6 3", "2 3"};

std::string partBeforeComma(const std::string& name)
{
    return name.substr(0, name.find(','));
}

std::string partFromComma(const std::string& name)
{
    return name.substr(std::min(name.find(','), name.size()));
}

void writeText(std::ostream& out, double x, double y, const char* anchor, const std::string& text)
{
    out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << text << "</text>\n";
}

void writeRule(std::ostream& out, double x0, double y0, double x1, double y1)
{
    out << "<line x1=\"" << x0 << "\" y1=\"" << y0 << "\" x2=\"" << x1 << "\" y2=\"" << y1
        << "\" stroke=\"#dddddd\"/>\n";
}

} // namespace

/// The ranges of both axes: they contain all points, and y covers whole decades.
struct Plot::Frame
{
    double minX = 1e300, maxX = 1e-300, minY = 1e300, maxY = 1e-300;

    double x(double value) const
    {
        return left + (width - left - right) * std::log(value / minX) / std::log(maxX / minX);
    }
    double y(double value) const
    {
        return height - bottom - (height - top - bottom) * std::log(value / minY) / std::log(maxY / minY);
    }
};

void Plot::describe(const std::string& title, const std::string& xTitle, const std::string& yTitle)
{
    _title = title;
    _xTitle = xTitle;
    _yTitle = yTitle;
}

void Plot::addPoint(const std::string& name, double x, double y)
{
    if (!(x > 0.0) || !(y > 0.0)) return;
    auto line = std::find_if(_lines.begin(), _lines.end(), [&](const Line& known) { return known.name == name; });
    if (line == _lines.end()) line = _lines.insert(line, Line{name, {}});
    line->points.emplace_back(x, y);
}

Plot::Frame Plot::frame() const
{
    Frame frame;
    for (const Line& line : _lines)
        for (const auto& [x, y] : line.points)
        {
            frame.minX = std::min(frame.minX, x);
            frame.maxX = std::max(frame.maxX, x);
            frame.minY = std::min(frame.minY, y);
            frame.maxY = std::max(frame.maxY, y);
        }
    if (!(frame.maxX > frame.minX)) frame.maxX = 10.0 * frame.minX;
    frame.minY = std::pow(10.0, std::floor(std::log10(frame.minY)));
    frame.maxY = std::pow(10.0, std::floor(std::log10(frame.maxY)) + 1.0);
    return frame;
}

void Plot::writeAxes(std::ostream& out, const Frame& frame) const
{
    for (double decade = frame.minY; decade < 1.01 * frame.maxY; decade *= 10.0)
        for (const double step : {1.0, 2.0, 5.0})
        {
            const double value = step * decade;
            if (value > 1.01 * frame.maxY) continue;
            writeRule(out, left, frame.y(value), width - right, frame.y(value));
            out << "<text x=\"" << left - 6 << "\" y=\"" << frame.y(value) + 4 << "\" text-anchor=\"end\">" << value
                << "</text>\n";
        }
    std::vector<double> marks;
    for (const Line& line : _lines)
        for (const auto& point : line.points)
            marks.push_back(point.first);
    std::sort(marks.begin(), marks.end());
    marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
    for (const double mark : marks)
    {
        writeRule(out, frame.x(mark), top, frame.x(mark), height - bottom);
        out << "<text x=\"" << frame.x(mark) << "\" y=\"" << height - bottom + 16 << "\" text-anchor=\"middle\">"
            << mark << "</text>\n";
    }
    writeText(out, (left + width - right) / 2, height - 12, "middle", _xTitle);
    out << "<text transform=\"rotate(-90)\" x=\"" << -(top + height - bottom) / 2
        << "\" y=\"16\" text-anchor=\"middle\">" << _yTitle << "</text>\n";
}

std::size_t Plot::placeAmong(std::string (*part)(const std::string& name), std::size_t number) const
{
    std::vector<std::string> parts;
    for (const Line& line : _lines)
        if (std::find(parts.begin(), parts.end(), part(line.name)) == parts.end()) parts.push_back(part(line.name));
    const auto place = std::find(parts.begin(), parts.end(), part(_lines[number].name));
    return static_cast<std::size_t>(place - parts.begin());
}

void Plot::writeLine(std::ostream& out, const Frame& frame, std::size_t number) const
{
    const Line& line = _lines[number];
    const std::string color = colors[placeAmong(partBeforeComma, number) % std::size(colors)];
    const std::string dash = dashes[placeAmong(partFromComma, number) % std::size(dashes)];
    out << "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" << color << "\" stroke-dasharray=\"" << dash
        << "\" points=\"";
    for (const auto& [x, y] : line.points)
        out << frame.x(x) << "," << frame.y(y) << " ";
    out << "\"/>\n";
    for (const auto& [x, y] : line.points)
        out << "<circle r=\"3\" fill=\"" << color << "\" cx=\"" << frame.x(x) << "\" cy=\"" << frame.y(y) << "\"/>\n";
    const double y = top + 10 + 18 * static_cast<double>(number);
    out << "<line stroke-width=\"2\" stroke=\"" << color << "\" stroke-dasharray=\"" << dash << "\" x1=\""
        << width - right + 12 << "\" x2=\"" << width - right + 34 << "\" y1=\"" << y << "\" y2=\"" << y << "\"/>\n";
    writeText(out, width - right + 40, y + 4, "start", line.name);
}

void Plot::write(std::ostream& out) const
{
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << " " << height
        << "\" font-family=\"sans-serif\" font-size=\"12\">\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    writeText(out, left, 22, "start", _title);
    const Frame box = frame();
    writeAxes(out, box);
    for (std::size_t number = 0; number < _lines.size(); ++number)
        writeLine(out, box, number);
    out << "</svg>\n";
}

} // namespace osgGpuAnimation::benchmark
