#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Usage: plots.py FOLDER
Draws the rows of FOLDER/benchmark.json over the number of characters and over depth: FOLDER/*.svg."""
import json
import math
import pathlib
import sys

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 850, 420, 70, 320, 40, 50
COLORS = "#1f77b4 #d62728 #2ca02c #9467bd #ff7f0e #8c564b #e377c2 #7f7f7f #17becf #bcbd22 #000000 #aec7e8".split()
DASHES = ["none", "6 3", "2 3"]


def axis(values, first, last):
    """Logarithmic, from values to pixels."""
    low, high = math.log(min(values)), math.log(max(values))
    return lambda value: round(first + (last - first) * (math.log(value) - low) / (high - low or 1), 1)


def svg(title, x_title, y_title, lines):
    """lines: by name, a list of (x, y). Names that agree before the comma share a colour, from it on a dash."""
    marks = sorted({x for points in lines.values() for x, _ in points})
    ys = [y for points in lines.values() for _, y in points]
    decades = range(math.floor(math.log10(min(ys))), math.floor(math.log10(max(ys))) + 2)
    rules = [step * 10.0**decade for decade in decades for step in (1, 2, 5)
             if decade < decades[-1] or step == 1]
    to_x, to_y = axis(marks, LEFT, WIDTH - RIGHT), axis(rules, HEIGHT - BOTTOM, TOP)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
           '<rect width="100%" height="100%" fill="white"/>']

    def text(x, y, anchor, content, more=""):
        out.append(f'<text x="{x}" y="{y}" text-anchor="{anchor}"{more}>{content}</text>')

    def rule(x0, y0, x1, y1, style='stroke="#dddddd"'):
        out.append(f'<line x1="{x0}" y1="{y0}" x2="{x1}" y2="{y1}" {style}/>')

    text(LEFT, 22, "start", title)
    for value in rules:
        rule(LEFT, to_y(value), WIDTH - RIGHT, to_y(value))
        text(LEFT - 6, to_y(value) + 4, "end", f"{value:g}")
    for mark in marks:
        rule(to_x(mark), TOP, to_x(mark), HEIGHT - BOTTOM)
        text(to_x(mark), HEIGHT - BOTTOM + 16, "middle", mark)
    text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, "middle", x_title)
    text(-(TOP + HEIGHT - BOTTOM) / 2, 16, "middle", y_title, ' transform="rotate(-90)"')
    color_of, dash_of = {}, {}
    for number, (name, points) in enumerate(lines.items()):
        before, comma, after = name.partition(",")
        color = COLORS[color_of.setdefault(before, len(color_of)) % len(COLORS)]
        dash = DASHES[dash_of.setdefault(after, len(dash_of)) % len(DASHES)]
        style = f'fill="none" stroke-width="2" stroke="{color}" stroke-dasharray="{dash}"'
        out.append(f'<polyline {style} points="{" ".join(f"{to_x(x)},{to_y(y)}" for x, y in points)}"/>')
        out += [f'<circle r="3" fill="{color}" cx="{to_x(x)}" cy="{to_y(y)}"/>' for x, y in points]
        y = TOP + 10 + 18 * number
        rule(WIDTH - RIGHT + 12, y, WIDTH - RIGHT + 34, y, style)
        text(WIDTH - RIGHT + 40, y + 4, "start", name)
    return "\n".join(out + ["</svg>\n"])


def main():
    folder = pathlib.Path(sys.argv[1])
    plots = {}
    for row in json.loads((folder / "benchmark.json").read_text())["rows"]:
        subject, other = row["subject"], row.get("otherName", "")

        def add(plot, name, x, key):
            lines = plots.setdefault(plot, {})
            points = lines.setdefault(name, [])
            if (x, row[key]["median"]) not in points:
                points.append((x, row[key]["median"]))

        count = row["characters"]
        if row["what"] == "pose" and other:
            plot = ("pose-over-n", "Pose: CPU time a joint, from advance() to the finished palette", "characters", "ns a joint")
            add(plot, subject, count, "ours")
            add(plot, subject + (", osgAnimation" if other.startswith("osgAnimation") else ", floor"), count, "other")
        elif row["what"] == "pose over depth" and not other.startswith("chains"):
            plot = ("pose-over-depth", "Pose over the depth of the skeleton (64 joints in chains, 1,000 characters)",
                    "joints from root to leaf", "ns a joint")
            add(plot, "fused, a draw a level", int(subject.split()[-1]), "ours")
            add(plot, "separate, the walk", int(subject.split()[-1]), "other")
        elif row["what"].startswith("whole frame, 64x64"):
            plot = ("frame-over-n-" + subject, subject + ", whole frame at 64x64: CPU time a character", "characters",
                    "ms a character")
            add(plot, "osgGpuAnimation" + row["what"][18:], count, "ours")
            if "all triangles" not in other:
                add(plot, other, count, "other")
    for (name, *titles), lines in plots.items():
        (folder / (name + ".svg")).write_text(svg(*titles, lines))


main()
