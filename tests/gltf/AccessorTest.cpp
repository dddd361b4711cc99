// SPDX-License-Identifier: MIT
#include "gltf/data/Accessor.h"
#include "gltf/data/Validation.h"
#include "gltf/ModelBuilder.h"
#include "support/Results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

/// A model with one accessor over these bytes; a test may add more.
struct OneAccessor
{
    tinygltf::Model model;

    OneAccessor(int type, int componentType, std::size_t count, const Bytes& bytes, std::size_t stride = 0)
    {
        tinygltf::Accessor accessor;
        accessor.type = type;
        accessor.componentType = componentType;
        accessor.count = count;
        accessor.bufferView = view(bytes, stride);
        model.accessors.push_back(accessor);
    }

    int view(const Bytes& bytes, std::size_t stride = 0)
    {
        tinygltf::BufferView view;
        view.buffer = static_cast<int>(model.buffers.size());
        view.byteLength = bytes.size();
        view.byteStride = stride;
        model.bufferViews.push_back(view);
        model.buffers.emplace_back().data = bytes;
        return static_cast<int>(model.bufferViews.size()) - 1;
    }

    tinygltf::Accessor& accessor() { return model.accessors[0]; }

    void setSparse(int count, int indexType, const Bytes& indices, const Bytes& values, std::size_t valueOffset = 0)
    {
        auto& sparse = accessor().sparse;
        sparse.isSparse = true;
        sparse.count = count;
        sparse.indices.byteOffset = 0;
        sparse.indices.bufferView = view(indices);
        sparse.indices.componentType = indexType;
        sparse.values.bufferView = view(values);
        sparse.values.byteOffset = static_cast<int>(valueOffset);
    }
};

Bytes bytesOf(const std::vector<float>& numbers)
{
    Bytes bytes(numbers.size() * sizeof(float));
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

struct Stored
{
    const char* name;
    int componentType;
    Bytes bytes; ///< of a VEC2
    bool normalized;
    std::vector<double> expected;
};

const Stored storedNumbers[] = {
    {"byte", 5120, {0x80, 0x7f}, false, {-128, 127}},
    {"normalized byte: -128 and -127 are both -1", 5120, {0x80, 0x81}, true, {-1, -1}},
    {"unsigned byte", 5121, {0, 255}, false, {0, 255}},
    {"normalized unsigned byte", 5121, {51, 255}, true, {51 / 255.0, 1}},
    {"short", 5122, {0x00, 0x80, 0xff, 0x7f}, false, {-32768, 32767}},
    {"normalized short", 5122, {0x00, 0x80, 0x01, 0x00}, true, {-1, 1 / 32767.0}},
    {"unsigned short", 5123, {0x34, 0x12, 0xff, 0xff}, false, {0x1234, 65535}},
    {"normalized unsigned short", 5123, {0x01, 0x00, 0xff, 0xff}, true, {1 / 65535.0, 1}},
    {"unsigned int", 5125, {0xff, 0xff, 0xff, 0xff, 1, 0, 0, 0}, false, {4294967295.0, 1}},
    {"float", 5126, bytesOf({0.5f, -3.0f}), false, {0.5, -3}},
};

} // namespace

TEST(AccessorTest, readsEveryComponentType)
{
    for (const Stored& stored : storedNumbers)
    {
        SCOPED_TRACE(stored.name);
        OneAccessor one(TINYGLTF_TYPE_VEC2, stored.componentType, 1, stored.bytes);
        one.accessor().normalized = stored.normalized;
        EXPECT_EQ(readDoubles(one.model, 0), stored.expected);
        EXPECT_EQ(readFloats(one.model, 0), std::vector<float>(stored.expected.begin(), stored.expected.end()));
    }
    OneAccessor integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, {1, 2, 3, 255});
    integers.accessor().normalized = true; // integers are as they are
    EXPECT_EQ(readIntegers(integers.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 255}));
}

TEST(AccessorTest, strideAndOffsetsAreSkipped)
{
    OneAccessor one(TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 2, {9, 9, 9, 1, 2, 9, 9, 3, 4, 9}, 4);
    one.model.bufferViews[0].byteOffset = 1;
    one.accessor().byteOffset = 2;
    EXPECT_EQ(readIntegers(one.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4}));
    const OneAccessor floats(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, 3, bytesOf({1, 9, 2, 9, 3}), 8);
    EXPECT_EQ(readFloats(floats.model, 0), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(readDoubles(floats.model, 0), (std::vector<double>{1, 2, 3}));
}

TEST(AccessorTest, columnsOfSmallMatricesArePaddedButTheLastOneNeedsNone)
{
    struct Case
    {
        const char* name;
        int type;
        int componentType;
        std::size_t bytes[2]; ///< the fewest for one element and for two
    };
    const Case cases[] = {
        {"MAT2 of bytes", TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {6, 14}},
        {"MAT3 of bytes", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_BYTE, {11, 23}},
        {"MAT2 of shorts", TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_SHORT, {8, 16}},
        {"MAT3 of shorts", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {22, 46}},
        {"MAT3 of floats", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_FLOAT, {36, 72}},
    };
    for (const Case& c : cases)
        for (const std::size_t count : {1u, 2u})
            for (const bool isSparse : {false, true})
                for (const std::size_t missing : {0u, 1u})
                {
                    const Bytes bytes(c.bytes[count - 1] - missing);
                    OneAccessor one(c.type, c.componentType, count, isSparse ? Bytes(1000) : bytes);
                    if (isSparse) one.setSparse(int(count), TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1}, bytes);
                    MemoryBudget budget(1000);
                    Messages messages;
                    Report report(messages);
                    EXPECT_EQ(validateAccessors(one.model, 0, budget, report).has_value(), missing == 1)
                        << c.name << ' ' << count << ' ' << isSparse;
                }
    const OneAccessor two(TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 2,
                          {1, 2, 0, 0, 3, 4, 0, 0, 5, 6, 0, 0, 7, 8});
    EXPECT_EQ(readIntegers(two.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8}));
    const OneAccessor three(TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1,
                            {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9});
    EXPECT_EQ(readIntegers(three.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// Sparse values are as normalized as the others.
TEST(AccessorTest, sparseValuesReplaceAndLeaveTheBufferAlone)
{
    struct IndexType
    {
        int componentType;
        Bytes indices; ///< 2 and the last
        std::size_t last;
    };
    const IndexType types[] = {
        {5121, {2, 203}, 203}, {5123, {2, 0, 3, 1}, 259}, {5125, {2, 0, 0, 0, 3, 0, 1, 0}, 65539}};
    for (const IndexType& type : types)
        for (const bool hasBase : {true, false})
        {
            const Bytes base(type.last + 1, 51);
            OneAccessor one(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, type.last + 1, base);
            one.accessor().normalized = true;
            if (!hasBase) one.accessor().bufferView = -1; // zeros
            one.setSparse(2, type.componentType, type.indices, {9, 255, 102}, 1);
            std::vector<float> expected(type.last + 1, hasBase ? 0.2f : 0.0f);
            expected[2] = 1.0f;
            expected[type.last] = 0.4f;
            EXPECT_EQ(readFloats(one.model, 0), expected) << type.componentType;
            EXPECT_EQ(one.model.buffers[0].data, base);
        }
}

} // namespace osgGpuAnimation::gltf
