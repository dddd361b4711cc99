// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/ClipTravel.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Samples between two keyframes: a joint that turns by a right angle between them strays from the chord by 1 %.
constexpr int stepsPerPiece = 4;
/// The arcs that vertices describe between two samples are longer than their chords.
constexpr double arcPerChord = 1.05;

/// The corners of the boxes of all palette entries in one pose, and the pose's morph weights.
class PosedCorners
{
public:
    PosedCorners(const AnimationSet& set, const EntryBoxes& entryBoxes, const std::vector<float>& reaches)
        : _set(set), _boxes(entryBoxes), _reaches(reaches)
    {
    }

    /// Takes the pose. Returns the largest distance that a vertex has moved since the pose before, along a straight
    /// line.
    double moveTo(const BlendSample& sample)
    {
        PoseInstruction instruction;
        instruction.samples[0] = sample;
        Pose::evaluate(_set, instruction, AffineMatrix(), _palette);
        const double weightChange = changeOfWeights();
        double max = 0.0;
        for (std::size_t entry = 0; entry < std::min(_palette.size(), _boxes.size()); ++entry)
        {
            if (!isMoving(entry)) continue;
            double moved = 0.0;
            for (int corner = 0; corner < 8 && entry < _before.size(); ++corner)
            {
                const glm::vec3 point = _boxes[entry].corner(corner);
                moved = std::max<double>(
                    moved, glm::distance(_palette[entry].transformPoint(point), _before[entry].transformPoint(point)));
            }
            if (weightChange > 0.0 && entry < _reaches.size())
                moved += weightChange * static_cast<double>(_reaches[entry]) * sizeOf(_palette[entry]);
            max = std::max(max, moved);
        }
        _before = _palette;
        return max;
    }

    /// The diagonal of the box around all corners.
    double size() const
    {
        Box all;
        for (std::size_t entry = 0; entry < std::min(_palette.size(), _boxes.size()); ++entry)
            for (int corner = 0; corner < 8 && isMoving(entry); ++corner)
                all.add(_palette[entry].transformPoint(_boxes[entry].corner(corner)));
        return all.empty() ? 0.0 : glm::distance(all.min, all.max);
    }

private:
    bool isMoving(std::size_t entry) const
    {
        return _set.palette()[entry].kind != PaletteEntry::Kind::Weights && !_boxes[entry].empty();
    }

    double changeOfWeights() const
    {
        double max = 0.0;
        for (std::size_t entry = 0; entry < _before.size(); ++entry)
            for (int row = 0; row < 3 && _set.palette()[entry].kind == PaletteEntry::Kind::Weights; ++row)
                for (int i = 0; i < 4; ++i)
                    max = std::max<double>(max, std::abs(_palette[entry].rows[row][i] - _before[entry].rows[row][i]));
        return max;
    }

    /// An upper bound for the length of a transformed unit vector.
    static double sizeOf(const AffineMatrix& matrix)
    {
        double squares = 0.0;
        for (const glm::vec4& row : matrix.rows)
            squares += glm::dot(glm::dvec3(row), glm::dvec3(row));
        return std::sqrt(squares);
    }

    const AnimationSet& _set;
    const EntryBoxes& _boxes;
    const std::vector<float>& _reaches;
    std::vector<AffineMatrix> _palette;
    std::vector<AffineMatrix> _before; ///< empty: no pose yet
};

} // namespace

ClipTravel::ClipTravel(const AnimationSet& set, std::size_t clip, const EntryBoxes& entryBoxes,
                       const std::vector<float>& reaches)
{
    const Clip& moving = set.clips()[clip];
    const std::vector<float>& times = moving.times();
    if (times.empty()) return;
    BlendSample sample = set.sampleAt(static_cast<int>(clip), times.front());
    _control = sample.control;
    const auto first = static_cast<std::uint32_t>(sample.keyframe - moving.locate(times.front()).keyframe);
    PosedCorners corners(set, entryBoxes, reaches);
    double travel = 0.0;
    const auto add = [&](std::size_t keyframe, double alpha, double time)
    {
        sample.keyframe = first + static_cast<std::uint32_t>(keyframe);
        sample.alpha = static_cast<float>(alpha);
        travel += arcPerChord * corners.moveTo(sample);
        _samples.push_back(
            {sample.alpha, sample.keyframe, {static_cast<float>(time), static_cast<float>(travel), 0.0f}});
    };
    add(moving.duration() > 0.0 ? 0 : moving.locate(0.0).keyframe, 0.0, times.front());
    if (!(moving.duration() > 0.0)) return;
    for (std::size_t keyframe = 0; keyframe + 1 < times.size(); ++keyframe)
    {
        const double begin = times[keyframe], duration = times[keyframe + 1] - begin;
        if (!(duration > 0.0)) travel += corners.size();
        for (int step = 1; step < stepsPerPiece && duration > 0.0; ++step)
        {
            const double alpha = static_cast<double>(step) / stepsPerPiece;
            add(keyframe, alpha, begin + alpha * duration);
        }
        add(keyframe + 1, 0.0, times[keyframe + 1]);
    }
    for (std::size_t i = 0; i + 1 < _samples.size(); ++i)
    {
        Piece& piece = _samples[i].piece;
        const Piece& next = _samples[i + 1].piece;
        // Times that nearly coincide count as a jump.
        if (const float speed = (next.travel - piece.travel) / (next.time - piece.time); std::isfinite(speed))
            piece.speed = speed;
    }
    divide(moving.duration());
}

/// Makes the parts.
void ClipTravel::divide(double duration)
{
    _partsPerSecond = static_cast<float>(static_cast<double>(_samples.size()) / duration);
    _lastPart = static_cast<float>(_samples.size() - 1);
    const auto partOf = [&](const Sample& sample)
    { return static_cast<std::size_t>(std::min(std::max(sample.piece.time * _partsPerSecond, 0.0f), _lastPart)); };
    std::size_t next = 0; // the first sample in a later part
    for (std::size_t part = 0; part < _samples.size(); ++part)
    {
        const std::size_t inside = next;
        while (next < _samples.size() && partOf(_samples[next]) == part)
            ++next;
        const std::size_t first = std::max<std::size_t>(inside, 1) - 1; // of the part's start
        const std::size_t second = std::min(first + 1, _samples.size() - 1);
        _parts.push_back({{_samples[first].piece, _samples[second].piece}, next - first > 2});
    }
}

float ClipTravel::search(float time) const
{
    const auto isBefore = [](float wanted, const Sample& after) { return wanted < after.piece.time; };
    return std::upper_bound(_samples.begin() + 1, _samples.end(), time, isBefore)[-1].piece.at(time);
}

BlendSample ClipTravel::sampleAt(float travel) const
{
    if (_samples.empty()) return {};
    const auto after =
        std::lower_bound(_samples.begin(), _samples.end(), travel,
                         [](const Sample& sample, float wanted) { return sample.piece.travel < wanted; });
    if (after == _samples.end() || after == _samples.begin())
    {
        const Sample& end = after == _samples.begin() ? _samples.front() : _samples.back();
        return {end.keyframe, end.alpha, 1.0f, _control};
    }
    const Sample& before = after[-1];
    const bool isJump = before.piece.time == after->piece.time;
    if (isJump && after->piece.travel - travel < travel - before.piece.travel)
        return {after->keyframe, after->alpha, 1.0f, _control};
    if (isJump) return {before.keyframe, before.alpha, 1.0f, _control};
    const float alphaAfter = after->keyframe == before.keyframe ? after->alpha : 1.0f;
    const float share = (travel - before.piece.travel) / (after->piece.travel - before.piece.travel);
    return {before.keyframe, before.alpha + share * (alphaAfter - before.alpha), 1.0f, _control};
}

} // namespace osgGpuAnimation
