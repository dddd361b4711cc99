// SPDX-License-Identifier: MIT
#pragma once

#include "support/Limb.h"

#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <numeric>
#include <vector>

namespace osgGpuAnimation
{

/// A long look-at whose joints all have turned rest poses: "rib" is in its chain without a share of the turn, "hips" is
/// the parent of the chain. What its joints do is computed here from the declaration, in model space: a slip that the
/// solver and its shader have in common is noticed.
struct LookAtChain
{
    LookAt look{"look", {"spine", "chest", "neck", "head"}, {1.0f, 4.0f, 2.0f, 3.0f}, {0.3f, 0.2f, 1.0f}, {0, 2, 0.5f}};
    std::vector<Joint> joints;

    LookAtChain()
    {
        const char* names[] = {"hips", "spine", "rib", "chest", "neck", "head"};
        for (int i = 0; i < 6; ++i)
        {
            const glm::dquat turn = glm::angleAxis(0.2 + 0.1 * i, glm::normalize(glm::dvec3(1, 0.5 * i, 2 - i)));
            joints.push_back(jointAt(names[i], {0.05f * static_cast<float>(i), 0.3f, 0.02f}, turn));
        }
        look.offset = {0.0f, 0.1f, 0.05f};
    }

    /// The rotations in model space of all joints before the last, for a target without a pole.
    std::vector<glm::dquat> expectedRotations(const glm::dvec3& target) const
    {
        std::vector<glm::dquat> rotations;
        glm::dquat rotation(1, 0, 0, 0);
        glm::dvec3 place(0.0);
        for (const Joint& joint : joints)
        {
            place += rotation * glm::dvec3(joint.rest.translation);
            rotation = rotation * Rotation::quaternion(glm::dvec4(joint.rest.rotation));
            rotations.push_back(rotation);
        }
        const glm::dvec3 eye = place + rotation * glm::dvec3(look.offset), up = rotation * glm::dvec3(look.up);
        const glm::dmat3 before = frameOf(rotation * glm::dvec3(look.forward), up), after = frameOf(target - eye, up);
        const glm::dquat turn = glm::quat_cast(after * glm::transpose(before));
        const double whole = glm::angle(turn.w < 0.0 ? -turn : turn);
        // Beyond two thirds of a half turn the joints before the last turn back.
        const double shared = std::min(whole, 2.0 * (glm::pi<double>() - whole));
        const double sum = std::accumulate(look.shares.begin(), look.shares.end(), 0.0);
        double share = 0.0;
        rotations.pop_back();
        for (std::size_t joint = 0, named = 0; joint < rotations.size(); ++joint)
        {
            if (joints[joint].name == look.joints[named]) share += static_cast<double>(look.shares[named++]) / sum;
            rotations[joint] =
                glm::angleAxis(shared * share, glm::axis(turn.w < 0.0 ? -turn : turn)) * rotations[joint];
        }
        return rotations;
    }

    /// Targets at which the line of sight turns by less and by more than two thirds of a half turn.
    static std::vector<glm::dvec3> targets() { return {{3, 2, 1}, {-2, 0.5, 2}, {0.5, 2.5, -4}}; }

private:
    static glm::dmat3 frameOf(const glm::dvec3& line, const glm::dvec3& up)
    {
        const glm::dvec3 forward = glm::normalize(line);
        const glm::dvec3 above = glm::normalize(up - forward * glm::dot(forward, up));
        return {forward, above, glm::cross(forward, above)};
    }
};

} // namespace osgGpuAnimation
