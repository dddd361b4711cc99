// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

/// The value of a result. An error ends the running test, which fails with its message.
template <typename T>
T valueOf(Result<T> result)
{
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(result).value();
}

/// The message of a result's error; empty without one.
template <typename T>
std::string errorOf(const Result<T>& result)
{
    return result ? "" : result.error().message;
}

/// Success if the result is an error whose message contains that part; of an empty part: if it is none.
template <typename T>
::testing::AssertionResult hasError(const Result<T>& result, const std::string& part)
{
    if (!result == !part.empty() && errorOf(result).find(part) != std::string::npos)
        return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "error: " << errorOf(result) << ", expected: " << part;
}

} // namespace osgGpuAnimation
