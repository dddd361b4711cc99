// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace osgGpuAnimation
{

/// The name itself, or that of what has one.
template <typename T>
const std::string& elementName(const T& named)
{
    if constexpr (std::is_same_v<T, std::string>)
        return named;
    else if constexpr (std::is_member_object_pointer_v<decltype(&T::name)>)
        return named.name;
    else
        return named.name();
}

/// Lists names for an error message: "Walk", "Run". Of more than 50 names it lists the first 50 and the total; without
/// names it is: none.
template <typename T>
std::string quotedNames(const std::vector<T>& named)
{
    constexpr std::size_t max = 50;
    std::string names;
    for (std::size_t i = 0; i < std::min(named.size(), max); ++i)
        names += (i == 0 ? "\"" : ", \"") + elementName(named[i]) + "\"";
    if (named.size() > max) names += ", … (" + std::to_string(named.size()) + " in all)";
    return names.empty() ? "none" : names;
}

/// A message that names the element, what was expected and what was found.
struct Error
{
    std::string message; ///< one or more sentences for the developer
};

/// Prints the mistake of a caller and ends the program.
[[noreturn]] inline void resultMisuse(const char* mistake, const std::string& message)
{
    std::fprintf(stderr, "osgGpuAnimation: %s%s\n", mistake, message.c_str());
    std::abort();
}

/// A value or an error. The caller must check it. A call of value() without a value, or of error() without an error, is
/// a mistake of the caller: it prints a message, with the error's own, and ends the program by std::abort(), in every
/// kind of build.
///
///     Result<Skeleton> skeleton = Skeleton::create(joints);
///     if (!skeleton) return skeleton.error();
///     use(skeleton.value());
template <typename T>
class [[nodiscard]] Result
{
public:
    Result(T value) : _content(std::move(value)) {}     ///< Holds a value.
    Result(Error error) : _content(std::move(error)) {} ///< Holds an error.

    explicit operator bool() const { return std::holds_alternative<T>(_content); } ///< True if it holds a value.

    /// The value. The Result must hold one.
    const T& value() const&
    {
        if (!*this) resultMisuse("value() of a Result that holds the error: ", error().message);
        return *std::get_if<T>(&_content);
    }
    /// The value, to move from. The Result must hold one.
    T&& value() && { return const_cast<T&&>(std::move(std::as_const(*this).value())); }
    /// The error. The Result must hold one.
    const Error& error() const
    {
        if (*this) resultMisuse("error() of a Result that holds a value", "");
        return *std::get_if<Error>(&_content);
    }

private:
    std::variant<T, Error> _content;
};

/// Success or an error. The caller must check it.
///
///     Result<void> closed = file.close();
///     if (!closed) return closed.error();
template <>
class [[nodiscard]] Result<void>
{
public:
    Result() = default;                               ///< Success.
    Result(Error error) : _error(std::move(error)) {} ///< Holds an error.

    explicit operator bool() const { return !_error; } ///< True: success.

    /// The error. The Result must hold one.
    const Error& error() const
    {
        if (*this) resultMisuse("error() of a Result that holds a value", "");
        return *_error;
    }

private:
    std::optional<Error> _error;
};

/// The index of the first element of that name. kind: of the elements, in the singular. Error: there is none; the
/// message lists the existing names.
template <typename T>
Result<std::size_t> indexNamed(const std::string& kind, const std::string& name, const std::vector<T>& named)
{
    for (std::size_t i = 0; i < named.size(); ++i)
        if (elementName(named[i]) == name) return i;
    return Error{"there is no " + kind + " \"" + name + "\"; the " + kind + "s are " + quotedNames(named)};
}

} // namespace osgGpuAnimation
