// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Lays out an AnimationSet's palette: which joint needs which inverse bind matrices, which of them is its main entry,
/// and where each comes in level order. The parts must have been checked already.
class PaletteBuilder
{
public:
    explicit PaletteBuilder(const AnimationParts& parts);

    std::vector<PaletteEntry> palette;
    std::vector<std::size_t> levels;           ///< level count + 1 entry indices
    std::vector<std::vector<int>> entryOfSkin; ///< by skin, then place
    std::vector<int> entryOfRigidJoint;        ///< by joint; -1 where it is none
    std::vector<int> mainEntry;                ///< by joint
    std::vector<int> entryOfMorph;             ///< by morph; -1 where it has no weights

private:
    /// One joint with one inverse bind matrix, compared bit by bit.
    using Key = std::pair<int, std::array<std::uint32_t, 12>>;

    static Key keyOf(int joint, const AffineMatrix& inverseBind);
    void chooseMainBinds();
    void collectFurtherBinds();
    void placeEntries();
    void nameEntries();

    const AnimationParts& _parts;
    std::vector<AffineMatrix> _mainBinds;                            ///< inverse bind of each joint's main entry
    std::map<Key, int> _entryOfKey;                                  ///< -1 until placed
    std::vector<std::vector<std::pair<int, AffineMatrix>>> _further; ///< by level: joint, inverse bind
};

} // namespace osgGpuAnimation
