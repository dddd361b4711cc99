// SPDX-License-Identifier: MIT
#include "PaletteBuilder.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstring>

namespace osgGpuAnimation
{

namespace
{

double frobeniusNorm(const glm::dmat3& m)
{
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

bool isModest(const glm::dvec4& translation)
{
    // Positions beyond this leave single precision no more than a tenth of a unit.
    constexpr double farthest = 1e6;
    return glm::length(glm::dvec3(translation)) <= farthest;
}

/// Whether a child can be computed through this matrix and its inverse in single precision with next to no loss.
/// The condition number is that of the Frobenius norm, scaled so that rotations with uniform scale have 1: each level
/// loses that many times the last bit, so beyond 16 a chain could be seen to be less exact than 1e-5.
bool canBeUndone(const AffineMatrix& inverseBind)
{
    const glm::dmat4 matrix = inverseBind.toColumns();
    const glm::dmat3 linear(matrix);
    const double determinant = glm::determinant(linear);
    if (!(std::abs(determinant) > 0.0) || !std::isfinite(determinant)) return false;
    const glm::dmat4 bind = glm::inverse(matrix);
    const double condition = frobeniusNorm(linear) * frobeniusNorm(glm::dmat3(bind)) / 3.0;
    constexpr double worstCondition = 16.0;
    return condition <= worstCondition && isModest(matrix[3]) && isModest(bind[3]) &&
           AffineMatrix::fromColumns(bind).isFinite();
}

AffineMatrix inverse(const AffineMatrix& matrix)
{
    return matrix.isIdentity() ? AffineMatrix() : AffineMatrix::fromColumns(glm::inverse(matrix.toColumns()));
}

} // namespace

PaletteBuilder::PaletteBuilder(const AnimationParts& parts) : _parts(parts)
{
    chooseMainBinds();
    collectFurtherBinds();
    placeEntries();
    nameEntries();
}

PaletteBuilder::Key PaletteBuilder::keyOf(int joint, const AffineMatrix& inverseBind)
{
    Key key;
    key.first = joint;
    static_assert(sizeof(key.second) == sizeof(AffineMatrix), "twelve numbers of 32 bits");
    std::memcpy(key.second.data(), &inverseBind, sizeof(AffineMatrix));
    return key;
}

void PaletteBuilder::chooseMainBinds()
{
    _mainBinds.resize(_parts.skeleton.jointCount());
    std::vector<bool> chosen(_mainBinds.size(), false);
    for (const Skin& skin : _parts.skins)
        for (std::size_t place = 0; place < skin.joints.size(); ++place)
        {
            const auto joint = static_cast<std::size_t>(skin.joints[place]);
            if (chosen[joint]) continue;
            chosen[joint] = true;
            if (canBeUndone(skin.inverseBinds[place])) _mainBinds[joint] = skin.inverseBinds[place];
        }
    for (std::size_t joint = 0; joint < _mainBinds.size(); ++joint)
        _entryOfKey.emplace(keyOf(static_cast<int>(joint), _mainBinds[joint]), -1);
}

void PaletteBuilder::collectFurtherBinds()
{
    const auto want = [this](int joint, const AffineMatrix& inverseBind)
    {
        if (!_entryOfKey.emplace(keyOf(joint, inverseBind), -1).second) return;
        const auto level = static_cast<std::size_t>(_parts.skeleton.depths()[static_cast<std::size_t>(joint)]) + 1;
        if (_further.size() <= level) _further.resize(level + 1);
        _further[level].emplace_back(joint, inverseBind);
    };
    for (const Skin& skin : _parts.skins)
        for (std::size_t place = 0; place < skin.joints.size(); ++place)
            want(skin.joints[place], skin.inverseBinds[place]);
    for (int joint : _parts.rigidJoints)
        want(joint, AffineMatrix());
}

void PaletteBuilder::placeEntries()
{
    const Skeleton& skeleton = _parts.skeleton;
    const auto place = [this](int joint, const AffineMatrix& inverseBind, int parentJoint, int track)
    {
        PaletteEntry entry;
        entry.kind = track < 0 ? PaletteEntry::Kind::Static : PaletteEntry::Kind::Joint;
        entry.joint = joint;
        entry.track = track;
        entry.inverseBind = inverseBind;
        if (parentJoint >= 0)
        {
            entry.parent = mainEntry[static_cast<std::size_t>(parentJoint)];
            entry.parentBind = inverse(_mainBinds[static_cast<std::size_t>(parentJoint)]);
        }
        _entryOfKey[keyOf(joint, inverseBind)] = static_cast<int>(palette.size());
        palette.push_back(entry);
    };

    levels.push_back(0);
    std::size_t joint = 0;
    int weightTrack = static_cast<int>(skeleton.jointCount());
    for (std::size_t level = 0; joint < skeleton.jointCount() || level < _further.size() || level == 0; ++level)
    {
        for (; joint < skeleton.jointCount() && skeleton.depths()[joint] == static_cast<int>(level); ++joint)
        {
            mainEntry.push_back(static_cast<int>(palette.size()));
            place(static_cast<int>(joint), _mainBinds[joint], skeleton.joint(joint).parent, static_cast<int>(joint));
        }
        if (level < _further.size())
            for (const auto& [owner, inverseBind] : _further[level])
                place(owner, inverseBind, owner, -1);
        for (std::size_t m = 0; level == 0 && m < _parts.morphs.size(); ++m)
        {
            const std::size_t blocks = _parts.morphs[m].blockCount();
            entryOfMorph.push_back(blocks == 0 ? -1 : static_cast<int>(palette.size()));
            for (std::size_t b = 0; b < blocks; ++b)
            {
                PaletteEntry entry;
                entry.kind = PaletteEntry::Kind::Weights;
                entry.track = weightTrack++;
                palette.push_back(entry);
            }
        }
        if (palette.size() > levels.back()) levels.push_back(palette.size());
    }
}

void PaletteBuilder::nameEntries()
{
    for (const Skin& skin : _parts.skins)
    {
        std::vector<int> entries;
        for (std::size_t place = 0; place < skin.joints.size(); ++place)
            entries.push_back(_entryOfKey[keyOf(skin.joints[place], skin.inverseBinds[place])]);
        entryOfSkin.push_back(std::move(entries));
    }
    entryOfRigidJoint.assign(_parts.skeleton.jointCount(), -1);
    for (int joint : _parts.rigidJoints)
        entryOfRigidJoint[static_cast<std::size_t>(joint)] = _entryOfKey[keyOf(joint, AffineMatrix())];
}

} // namespace osgGpuAnimation
