// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <string>

namespace osgGpuAnimation
{

/// When a transition of a StateGraph may be taken, read from a few words:
///
///     "speed > 0.5"   a parameter compared with a number: > >= < <= == !=; spaces may be left out
///     "jump"          a trigger has been fired
///     "finished"      the state's clip has come to its end (it plays once)
///     "after 2.5"     the state has lasted so many seconds
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
    std::string parameter; ///< or trigger; empty for Finished and After
    double value = 0.0;

    /// Names are single words without any of < > = !; a trigger's is no number, nor "finished" or "after" in any case.
    /// Error: words that are none of these, a number that is not finite; it quotes the text.
    static Result<StateCondition> parse(const std::string& text);
};

} // namespace osgGpuAnimation
