// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstdint>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::fbx
{

/// A value behind the name of an element: `P: "Lcl Scaling", "Lcl Scaling", "", "A",1,1,1` has seven.
struct Value
{
    std::string_view text;    ///< of strings, and of bare words and numbers in ASCII
    bool isText = false;      ///< a string, or a bare word in ASCII
    double number = 0.0;      ///< of numbers; NaN where it cannot be read
    std::int64_t integer = 0; ///< of numbers without fraction: objects' ids use all 64 bits
};

/// A named record with values and records below it. The views are into the bytes of the document.
struct Element
{
    std::string_view name;
    std::vector<Value> values;
    std::vector<Element> children;

    /// The first child of a name; null: there is none.
    const Element* child(std::string_view childName) const;
    /// The numbers of the array that is the element's content, or of the child of a name; empty: none, or broken.
    std::vector<double> numbers() const;
    std::vector<double> numbers(std::string_view childName) const;

    std::string_view array;       ///< the content of an array, undecoded
    char arrayType = 0;           ///< of binary files: f, d, l, i, b; 0: text
    std::uint32_t arrayCount = 0; ///< elements, of binary files
    bool isDeflated = false;
};

/// The elements of an FBX file, binary or ASCII. Of versions from 7.0 on, objects have ids and connections use them.
///
///     Result<Document> document = Document::parse(bytes);  // the bytes must live as long
///     const Element* objects = document.value().root.child("Objects");
///
/// Bounded are the depth (64) and what an array may become (by its number of bytes).
struct Document
{
    /// Errors: neither format; a record that ends beyond the file or its parent, with its byte offset.
    static Result<Document> parse(std::string_view bytes);

    Element root;
    int version = 0; ///< 7400: FBX 7.4
};

/// The bits of a float that ASCII files print as an integer: 1144258560 is 720. Others are the number itself.
double floatOfBits(double number);

} // namespace osgGpuAnimation::fbx
