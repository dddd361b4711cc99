// SPDX-License-Identifier: MIT
// Stage 2, local: a joint transform as an affine matrix, L = T R S for column vectors (glTF 2.0, section 3.5.3).
// A mat3x4 stores a 3x4 matrix: its three columns are the matrix's rows, as in memory.

mat3x4 localMatrix(vec4 translation, vec4 q, vec4 scale)
{
    vec3 x2 = q.xyz + q.xyz;
    vec3 xx = q.xyz * x2;                                  // 2xx 2yy 2zz
    vec3 xy = vec3(q.x * x2.y, q.x * x2.z, q.y * x2.z);    // 2xy 2xz 2yz
    vec3 wx = q.w * x2;                                    // 2wx 2wy 2wz
    return mat3x4(vec4(vec3(1.0 - xx.y - xx.z, xy.x - wx.z, xy.y + wx.y) * scale.xyz, translation.x),
                  vec4(vec3(xy.x + wx.z, 1.0 - xx.x - xx.z, xy.z - wx.x) * scale.xyz, translation.y),
                  vec4(vec3(xy.y - wx.y, xy.z + wx.x, 1.0 - xx.x - xx.y) * scale.xyz, translation.z));
}
