// SPDX-License-Identifier: MIT
// The layout of the GPU's buffers: one definition for GLSL and C++ (included by both).

// Keyframes: RGBA32UI, see animation/PackedKeyframes.h. A joint transform is three texels (translation, rotation, scale).
#define POSE_TEXELS_PER_TRANSFORM 3
#define POSE_PLACE_HELD 0x80000000u // a place in half texels: counted from the buffer's beginning, not from the record's

// Rotations of compact clips: three whole numbers of 20 bits; a component is (number - zero) * step.
#define POSE_ROTATION_ZERO 524288.0f
#define POSE_ROTATION_STEP 1.348702e-6f // the largest of the three is below sqrt(1 / 2)

// What of a part (translation, scale) the mix stage fetches: PartMotion in C++.
#define POSE_PART_FIXED 0
#define POSE_PART_HELD 1
#define POSE_PART_MOVING 2

// Blend samples: RGBA32UI, a texel each: keyframe, alpha (float bits), weight (float bits), control.
// The upper 16 bits of control are the number of a mask (0: none), the others are bits of these:
#define POSE_SAMPLE_SPLINE 1u    // the clip's tracks are value, in-tangent, out-tangent
#define POSE_SAMPLE_ADDITIVE 2u  // adds its difference from the REFERENCE right before it
#define POSE_SAMPLE_REFERENCE 4u // no share in the pose; its weight is that of the sample after it
#define POSE_SAMPLE_ABOVE 8u     // the first of a blend priority above that of the samples before it
#define POSE_SAMPLE_MASK_SHIFT 16

// Additive layers leave axes of a smaller reference scale as they are.
#define POSE_SMALLEST_SCALE 1e-6

// Masks: RGBA32F, a weight a track, four to a texel, each mask beginning a texel; mask 0 is all 1.
#define POSE_WEIGHTS_PER_MASK_TEXEL 4

// Palette entries, the static part: RGBA32F, nine texels each: head, three rows of parentBind, three of inverseBind,
// translation and scale at rest.
// The head's four components hold whole numbers: parent entry (-1: the root), track (-1: none), is it weights (1 or 0), 0.
#define POSE_TEXELS_PER_ENTRY 9

// The palette: RGBA32F, a 3x4 matrix is three texels (rows). Entry e of instance i is matrix e * stride + i.
#define POSE_TEXELS_PER_MATRIX 3

// Vertex attributes of a skinned mesh: palette entries and their weights, four to a set.
#define POSE_ENTRIES_0_LOCATION 12
#define POSE_WEIGHTS_0_LOCATION 13
#define POSE_ENTRIES_1_LOCATION 14
#define POSE_WEIGHTS_1_LOCATION 15

// Vertex attributes of instances that are drawn together, one a GL instance: three rows of the matrix to the eye's space,
// then the pose's number in its batch. Where OSG has texture coordinates of units above 0 or secondary colours, if anything.
#define POSE_PLACEMENT_ROW_0_LOCATION 6
#define POSE_PLACEMENT_ROW_1_LOCATION 7
#define POSE_PLACEMENT_ROW_2_LOCATION 10
#define POSE_PLACED_POSE_LOCATION 11

// The texture units that hold the palette, a mesh's morph targets and the instances' tints during its draw.
#define POSE_PALETTE_UNIT 11
#define POSE_MORPH_UNIT 12
#define POSE_TINT_UNIT 13

// Morph targets of a mesh: RGBA32F, for each vertex, each target, the channels it has: position, normal, colour, texture
// coordinate. Weights come from palette entries of weights, twelve each.
#define POSE_WEIGHTS_PER_ENTRY 12

// Vertex attributes of the pose pass, whose vertices are a batch's instances and whose GL instances are palette entries:
// per vertex the first blend samples and three rows of the root matrix, per GL instance an entry's texels.
#define POSE_SAMPLE_LOCATION 0
#define POSE_SAMPLES_AS_ATTRIBUTES 4 // where an instance has more, all are fetched
#define POSE_ROOT_LOCATION 4
#define POSE_HEAD_LOCATION 7
#define POSE_PARENT_BIND_LOCATION 8
#define POSE_INVERSE_BIND_LOCATION 11
#define POSE_REST_LOCATION 14
