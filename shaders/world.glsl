// SPDX-License-Identifier: MIT
// Stage 3, world: a palette entry from its parent's, parents first:
//     entry = parentEntry * parentBind * local * inverseBind        (a root's parentEntry: the instance's root matrix)
// parentBind undoes the parent's inverse bind, so that the entries alone carry the hierarchy.

uniform samplerBuffer entries; // the static part of the palette entries, POSE_TEXELS_PER_ENTRY each
uniform samplerBuffer roots;   // a 3x4 matrix an instance
uniform bool hasRoots;

mat3x4 fetchMatrix(samplerBuffer source, int texel)
{
    return mat3x4(texelFetch(source, texel), texelFetch(source, texel + 1), texelFetch(source, texel + 2));
}

// a * b of affine matrices held by rows.
mat3x4 multiplied(mat3x4 a, mat3x4 b)
{
    mat3x4 product = b * mat3(a);
    product[0].w += a[0].w;
    product[1].w += a[1].w;
    product[2].w += a[2].w;
    return product;
}

mat3x4 rooted(int instance, mat3x4 matrix)
{
    return hasRoots ? multiplied(fetchMatrix(roots, instance * POSE_TEXELS_PER_MATRIX), matrix) : matrix;
}

mat3x4 withInverseBind(int entry, int kind, mat3x4 matrix)
{
    if ((kind & POSE_ENTRY_HAS_INVERSE_BIND) == 0) return matrix;
    return multiplied(matrix, fetchMatrix(entries, entry * POSE_TEXELS_PER_ENTRY + 4));
}

mat3x4 withParentBind(int entry, int kind, mat3x4 matrix)
{
    if ((kind & POSE_ENTRY_HAS_PARENT_BIND) == 0) return matrix;
    return multiplied(fetchMatrix(entries, entry * POSE_TEXELS_PER_ENTRY + 1), matrix);
}
