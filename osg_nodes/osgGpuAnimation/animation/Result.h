// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace osgGpuAnimation
{

/// A message that names the element, what was expected and what was found.
struct Error
{
    std::string message;
};

/// A value or an error. The caller must check it.
///
///     Result<Skeleton> skeleton = Skeleton::create(joints);
///     if (!skeleton) return skeleton.error();
///     use(skeleton.value());
template <typename T>
class [[nodiscard]] Result
{
public:
    Result(T value) : _content(std::move(value)) {}
    Result(Error error) : _content(std::move(error)) {}

    explicit operator bool() const { return std::holds_alternative<T>(_content); }

    const T& value() const&
    {
        assert(*this && "value() of a Result that holds an error");
        return std::get<T>(_content);
    }
    T&& value() &&
    {
        assert(*this && "value() of a Result that holds an error");
        return std::get<T>(std::move(_content));
    }
    const Error& error() const
    {
        assert(!*this && "error() of a Result that holds a value");
        return std::get<Error>(_content);
    }

private:
    std::variant<T, Error> _content;
};

} // namespace osgGpuAnimation
