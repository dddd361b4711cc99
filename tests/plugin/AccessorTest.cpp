// SPDX-License-Identifier: MIT
#include "gltf/data/Accessor.h"

#include "gltf/document/ValidateAccessors.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

#include <cstring>

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
};

Bytes bytesOf(const std::vector<float>& numbers)
{
    Bytes bytes(numbers.size() * sizeof(float));
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

struct Stored
{
    const char* what;
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

TEST(AccessorTest, ReadsEveryComponentType)
{
    for (const Stored& stored : storedNumbers)
    {
        SCOPED_TRACE(stored.what);
        OneAccessor one(TINYGLTF_TYPE_VEC2, stored.componentType, 1, stored.bytes);
        one.accessor().normalized = stored.normalized;
        EXPECT_EQ(readDoubles(one.model, 0), stored.expected);
        EXPECT_EQ(readFloats(one.model, 0), std::vector<float>(stored.expected.begin(), stored.expected.end()));
    }
}

TEST(AccessorTest, IntegersAreAsTheyAreEvenIfNormalized)
{
    OneAccessor one(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, {1, 2, 3, 255});
    one.accessor().normalized = true;
    EXPECT_EQ(readIntegers(one.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 255}));
}

TEST(AccessorTest, StrideAndOffsetsSkipWhatLiesBetween)
{
    OneAccessor one(TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 2, {9, 9, 9, 1, 2, 9, 9, 3, 4, 9}, 4);
    one.model.bufferViews[0].byteOffset = 1;
    one.accessor().byteOffset = 2;
    EXPECT_EQ(readIntegers(one.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

TEST(AccessorTest, InterleavedFloatsAreNotTakenAsOneBlock)
{
    OneAccessor one(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, 3, bytesOf({1, 9, 2, 9, 3}), 8);
    EXPECT_EQ(readFloats(one.model, 0), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(readDoubles(one.model, 0), (std::vector<double>{1, 2, 3}));
}

TEST(AccessorTest, ColumnsOfSmallMatricesArePadded)
{
    OneAccessor two(TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, {1, 2, 0, 0, 3, 4, 0, 0});
    EXPECT_EQ(elementBytes(two.accessor()), 8u);
    EXPECT_EQ(readIntegers(two.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4}));
    OneAccessor three(TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1,
                      {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0});
    EXPECT_EQ(elementBytes(three.accessor()), 12u);
    EXPECT_EQ(readIntegers(three.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    OneAccessor floats(TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_FLOAT, 1, bytesOf({1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(elementBytes(floats.accessor()), 36u);
    EXPECT_EQ(readFloats(floats.model, 0), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(AccessorTest, TheLastColumnOfAMatrixNeedsNoPadding)
{
    struct Case
    {
        const char* what;
        int type;
        int componentType;
        std::size_t bytes[2]; ///< the fewest for one element and for two
    };
    const Case cases[] = {
        {"MAT2 of bytes", TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {6, 14}},
        {"MAT3 of bytes", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_BYTE, {11, 23}},
        {"MAT4 of bytes", TINYGLTF_TYPE_MAT4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {16, 32}},
        {"MAT2 of shorts", TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_SHORT, {8, 16}},
        {"MAT3 of shorts", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {22, 46}},
        {"MAT3 of floats", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_FLOAT, {36, 72}},
    };
    for (const Case& c : cases)
        for (std::size_t count : {1u, 2u})
        {
            SCOPED_TRACE(c.what + std::string(", ") + std::to_string(count));
            const auto refused = [&](std::size_t bytes, bool isSparse)
            {
                OneAccessor one(c.type, c.componentType, count, Bytes(isSparse ? 1000 : bytes));
                if (isSparse)
                {
                    auto& sparse = one.accessor().sparse;
                    sparse.isSparse = true;
                    sparse.count = int(count);
                    sparse.indices.byteOffset = 0;
                    sparse.indices.bufferView = one.view({0, 1});
                    sparse.indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
                    sparse.values.bufferView = one.view(Bytes(bytes));
                    sparse.values.byteOffset = 0;
                }
                MemoryBudget budget(1000);
                return validateAccessors(one.model, 0, budget).has_value();
            };
            for (bool isSparse : {false, true})
            {
                EXPECT_FALSE(refused(c.bytes[count - 1], isSparse)) << isSparse;
                EXPECT_TRUE(refused(c.bytes[count - 1] - 1, isSparse)) << isSparse;
            }
        }
    OneAccessor two(TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 2,
                    {1, 2, 0, 0, 3, 4, 0, 0, 5, 6, 0, 0, 7, 8});
    EXPECT_EQ(readIntegers(two.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(AccessorTest, WithoutBufferViewIsZero)
{
    OneAccessor one(TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, 2, {});
    one.accessor().bufferView = -1;
    EXPECT_EQ(readFloats(one.model, 0), std::vector<float>(6, 0.0f));
}

TEST(AccessorTest, SparseValuesReplaceAndLeaveTheBufferAlone)
{
    struct IndexType
    {
        int componentType;
        Bytes indices; ///< 0 and 2
    };
    const IndexType types[] = {{5121, {0, 2}}, {5123, {0, 0, 2, 0}}, {5125, {0, 0, 0, 0, 2, 0, 0, 0}}};
    for (const IndexType& type : types)
    {
        SCOPED_TRACE(type.componentType);
        OneAccessor one(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, 3, bytesOf({1, 2, 3}));
        auto& sparse = one.accessor().sparse;
        sparse.isSparse = true;
        sparse.count = 2;
        sparse.indices.byteOffset = 0;
        sparse.indices.bufferView = one.view(type.indices);
        sparse.indices.componentType = type.componentType;
        sparse.values.bufferView = one.view(bytesOf({9, 7, 8}));
        sparse.values.byteOffset = 4;
        EXPECT_EQ(readFloats(one.model, 0), (std::vector<float>{7, 2, 8}));
        EXPECT_EQ(one.model.buffers[0].data, bytesOf({1, 2, 3}));
        one.accessor().bufferView = -1;
        EXPECT_EQ(readFloats(one.model, 0), (std::vector<float>{7, 0, 8}));
    }
}

TEST(AccessorTest, SizesOfWhatGltfDoesNotKnowAreZero)
{
    EXPECT_EQ(componentBytes(TINYGLTF_COMPONENT_TYPE_DOUBLE), 0u);
    EXPECT_EQ(componentBytes(TINYGLTF_COMPONENT_TYPE_INT), 0u);
    tinygltf::Accessor accessor;
    accessor.type = TINYGLTF_TYPE_VECTOR;
    EXPECT_EQ(componentCount(accessor), 0u);
}

} // namespace osgGpuAnimation::gltf
