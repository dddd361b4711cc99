// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <string>

namespace osgGpuAnimation
{

/// A condition of a StateGraph transition, parsed from text:
///
///     "speed > 0.5"   a parameter compared with a number: > >= < <= == !=; spaces are optional
///     "jump"          a trigger was fired
///     "finished"      the state's clip reached its end (LoopMode::Once)
///     "after 2.5"     the state has lasted at least 2.5 seconds
struct StateCondition
{
    enum class Test
    {
        Greater,
        AtLeast,
        Less,
        AtMost,
        Equal,
        NotEqual,
        Fired,
        Finished,
        After,
    };

    Test test = Test::Fired;
    std::string parameter; ///< the name of a parameter or trigger; empty for Finished and After
    double value = 0.0;

    /// Names are single words without < > = !. The name of a trigger is not a number and not "finished" or "after" in
    /// upper or lower case. Errors quote the text: no valid condition, a number that is not finite.
    static Result<StateCondition> parse(const std::string& text);
};

} // namespace osgGpuAnimation
