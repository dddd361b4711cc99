// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/constraints/ConstraintPlan.h>

#include <algorithm>
#include <numeric>

namespace osgGpuAnimation
{

namespace
{

bool isAbove(const Skeleton& skeleton, int ancestor, int joint)
{
    do
        joint = skeleton.joint(joint).parent;
    while (joint >= 0 && joint != ancestor);
    return joint >= 0;
}

/// A step and, per joint of its path, the step that has corrected the joint before, or -1.
struct Draft
{
    ConstraintStep step;
    std::vector<int> sourceSteps;
};

/// The constraint's step without its sources. active: bit c for constraint c.
ConstraintStep stepOf(std::size_t constraint, const Skeleton& skeleton, const std::vector<ConstraintChain>& chains,
                      std::uint64_t active)
{
    const std::vector<int>& chain = chains[constraint].joints;
    int first = chain.front();
    for (std::size_t later = constraint + 1; later < chains.size(); ++later)
        if (const int start = chains[later].joints.front();
            (active >> later & 1) != 0 && isAbove(skeleton, start, first))
            first = start;
    ConstraintStep step;
    step.constraint = constraint;
    step.level = static_cast<std::size_t>(skeleton.depths()[first]);
    for (int joint = chain.front(); joint != first;)
        step.path.push_back(joint = skeleton.joint(joint).parent);
    std::reverse(step.path.begin(), step.path.end());
    step.chainBegin = step.path.size();
    step.path.insert(step.path.end(), chain.begin(), chain.end());
    return step;
}

} // namespace

ConstraintPlan::ConstraintPlan(const Skeleton& skeleton, const std::vector<ConstraintChain>& chains,
                               std::uint64_t active)
    : correctionsOfJoints(skeleton.jointCount())
{
    std::vector<Draft> drafts; // in the order of declaration
    std::vector<int> lastSteps(skeleton.jointCount(), -1);
    for (std::size_t c = 0; c < chains.size(); ++c)
    {
        if ((active >> c & 1) == 0) continue;
        Draft draft{stepOf(c, skeleton, chains, active), {}};
        for (const int joint : draft.step.path)
            draft.sourceSteps.push_back(lastSteps[joint]);
        for (const int joint : chains[c].joints)
            lastSteps[joint] = static_cast<int>(drafts.size());
        drafts.push_back(std::move(draft));
    }

    std::vector<std::size_t> order(drafts.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return drafts[a].step.level < drafts[b].step.level; });
    const auto placeOf = [&](int step, int joint)
    {
        if (step < 0) return CorrectionPlace();
        const ConstraintStep& source = drafts[step].step;
        const std::vector<int>& joints = chains[source.constraint].joints;
        const auto place = std::find(joints.begin(), joints.end(), joint) - joints.begin();
        return CorrectionPlace{source.firstCorrection, joints.size(), static_cast<std::size_t>(place)};
    };
    for (const std::size_t i : order)
    {
        Draft& draft = drafts[i];
        draft.step.firstCorrection = correctionCount;
        correctionCount += chains[draft.step.constraint].joints.size();
        for (std::size_t place = 0; place < draft.step.path.size(); ++place)
            draft.step.sources.push_back(placeOf(draft.sourceSteps[place], draft.step.path[place]));
        steps.push_back(draft.step);
    }
    for (std::size_t joint = 0; joint < lastSteps.size(); ++joint)
        correctionsOfJoints[joint] = placeOf(lastSteps[joint], static_cast<int>(joint));
}

} // namespace osgGpuAnimation
