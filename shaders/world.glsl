// SPDX-License-Identifier: MIT
// Stage 3, world: computes a palette entry from its parent's, parents first:
//     entry = parentEntry * parentBind * local * inverseBind        (a root's parentEntry: the instance's root matrix)
// parentBind cancels the parent's inverse bind, so that the entries alone represent the hierarchy.

mat3x4 fetchMatrix(samplerBuffer source, int texel)
{
    return mat3x4(texelFetch(source, texel), texelFetch(source, texel + 1), texelFetch(source, texel + 2));
}

// Numbers beyond POSE_LARGEST_NUMBER are limited, so products of limited matrices have no infinite terms. bool hasLimits:
// a constant of the variant; false if the numbers of the batch cannot become so large.
mat3x4 limited(mat3x4 matrix)
{
    const vec4 largest = vec4(POSE_LARGEST_NUMBER);
    return hasLimits ? mat3x4(clamp(matrix[0], -largest, largest), clamp(matrix[1], -largest, largest),
                              clamp(matrix[2], -largest, largest))
                     : matrix;
}

vec4 withoutNan(vec4 row)
{
    return mix(row, vec4(0.0), isnan(row));
}

// A local matrix, in which what is no number becomes 0.
mat3x4 limitedLocal(mat3x4 matrix)
{
    return hasLimits ? limited(mat3x4(withoutNan(matrix[0]), withoutNan(matrix[1]), withoutNan(matrix[2]))) : matrix;
}

// a * b of affine matrices stored by rows.
mat3x4 multiplied(mat3x4 a, mat3x4 b)
{
    mat3x4 product = b * mat3(a);
    product[0].w += a[0].w;
    product[1].w += a[1].w;
    product[2].w += a[2].w;
    return limited(product);
}

// The texel of a corrected rotation, see layout.glsl.
int correctionTexel(int code, int instance, int instances)
{
    int count = code / POSE_CORRECTION_BASE % POSE_CORRECTION_BASE;
    return code / (POSE_CORRECTION_BASE * POSE_CORRECTION_BASE) * instances + instance * count +
           code % POSE_CORRECTION_BASE;
}
