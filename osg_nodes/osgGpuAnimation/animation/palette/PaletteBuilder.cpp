// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/palette/PaletteBuilder.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

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
    // Beyond this distance single precision resolves only a tenth of a unit.
    constexpr double max = 1e6;
    return glm::length(glm::dvec3(translation)) <= max;
}

/// True if a child can be computed through this matrix and its inverse in single precision with almost no loss. The
/// condition number uses the Frobenius norm, scaled so that a rotation with uniform scale has 1. Each level multiplies
/// the rounding error by it: above 16 a chain could become less exact than 1e-5.
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

class PaletteBuilder
{
public:
    explicit PaletteBuilder(const AnimationParts& parts) : _skeleton(parts.skeleton), _parts(parts) {}

    PaletteLayout build()
    {
        chooseMainBinds();
        collectFurtherBinds();
        placeEntries();
        nameEntries();
        for (const Skin& garment : _parts.garments)
            for (std::size_t place = 0; place < garment.joints.size(); ++place)
                _layout.entries.push_back(entryBelow(garment.joints[place], PaletteEntry::Kind::Static,
                                                     garment.joints[place], garment.inverseBinds[place]));
        return std::move(_layout);
    }

private:
    /// One joint with one inverse bind matrix, compared bit by bit.
    using Key = std::pair<int, std::array<std::uint32_t, 12>>;

    static Key keyOf(int joint, const AffineMatrix& inverseBind)
    {
        Key key;
        key.first = joint;
        static_assert(sizeof(key.second) == sizeof(AffineMatrix), "twelve numbers of 32 bits");
        std::memcpy(key.second.data(), &inverseBind, sizeof(AffineMatrix));
        return key;
    }

    void chooseMainBinds()
    {
        _mainBinds.resize(_skeleton.jointCount());
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

    void collectFurtherBinds()
    {
        const auto want = [this](int joint, const AffineMatrix& inverseBind)
        {
            if (!_entryOfKey.emplace(keyOf(joint, inverseBind), -1).second) return;
            const auto level = static_cast<std::size_t>(_skeleton.depths()[joint]) + 1;
            if (_further.size() <= level) _further.resize(level + 1);
            _further[level].emplace_back(joint, inverseBind);
        };
        for (const Skin& skin : _parts.skins)
            for (std::size_t place = 0; place < skin.joints.size(); ++place)
                want(skin.joints[place], skin.inverseBinds[place]);
        for (int joint : _parts.rigidJoints)
            want(joint, AffineMatrix());
    }

    void placeEntries()
    {
        const auto place = [this](const PaletteEntry& entry)
        {
            _entryOfKey[keyOf(entry.joint, entry.inverseBind)] = static_cast<int>(_layout.entries.size());
            _layout.entries.push_back(entry);
        };

        _layout.levels.push_back(0);
        std::size_t joint = 0;
        for (std::size_t level = 0; joint < _skeleton.jointCount() || level < _further.size() || level == 0; ++level)
        {
            for (; joint < _skeleton.jointCount() && _skeleton.depths()[joint] == static_cast<int>(level); ++joint)
            {
                _layout.mainEntry.push_back(static_cast<int>(_layout.entries.size()));
                place(entryBelow(_skeleton.joint(joint).parent, PaletteEntry::Kind::Joint, static_cast<int>(joint),
                                 _mainBinds[joint]));
            }
            if (level < _further.size())
                for (const auto& [owner, inverseBind] : _further[level])
                    place(entryBelow(owner, PaletteEntry::Kind::Static, owner, inverseBind));
            if (level == 0) placeWeights();
            if (_layout.entries.size() > _layout.levels.back()) _layout.levels.push_back(_layout.entries.size());
        }
    }

    PaletteEntry entryBelow(int parentJoint, PaletteEntry::Kind kind, int joint, const AffineMatrix& inverseBind) const
    {
        PaletteEntry entry;
        entry.kind = kind;
        entry.joint = joint;
        entry.track = kind == PaletteEntry::Kind::Joint ? joint : -1;
        entry.inverseBind = inverseBind;
        if (parentJoint >= 0)
        {
            entry.parent = _layout.mainEntry[parentJoint];
            entry.parentBind = inverse(_mainBinds[parentJoint]);
        }
        return entry;
    }

    void placeWeights()
    {
        int track = static_cast<int>(_skeleton.jointCount());
        for (const MorphWeights& morph : _parts.morphs)
        {
            const bool hasEntries = morph.blockCount() > 0 && !morph.isProperty();
            _layout.entryOfMorph.push_back(hasEntries ? static_cast<int>(_layout.entries.size()) : -1);
            for (std::size_t block = 0; block < morph.blockCount(); ++block, ++track)
            {
                if (!hasEntries) continue;
                PaletteEntry entry;
                entry.kind = PaletteEntry::Kind::Weights;
                entry.track = track;
                _layout.entries.push_back(entry);
            }
        }
    }

    void nameEntries()
    {
        for (const Skin& skin : _parts.skins)
        {
            std::vector<int> entries;
            for (std::size_t place = 0; place < skin.joints.size(); ++place)
                entries.push_back(_entryOfKey[keyOf(skin.joints[place], skin.inverseBinds[place])]);
            _layout.entryOfSkin.push_back(std::move(entries));
        }
        _layout.entryOfRigidJoint.assign(_skeleton.jointCount(), -1);
        for (int joint : _parts.rigidJoints)
            _layout.entryOfRigidJoint[joint] = _entryOfKey[keyOf(joint, AffineMatrix())];
    }

    const Skeleton& _skeleton;
    const AnimationParts& _parts;
    PaletteLayout _layout;
    std::vector<AffineMatrix> _mainBinds;                            ///< inverse bind of each joint's main entry
    std::map<Key, int> _entryOfKey;                                  ///< -1 until placed
    std::vector<std::vector<std::pair<int, AffineMatrix>>> _further; ///< by level: joint, inverse bind
};

} // namespace

PaletteLayout layOutPalette(const AnimationParts& parts)
{
    return PaletteBuilder(parts).build();
}

} // namespace osgGpuAnimation
