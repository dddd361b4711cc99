// SPDX-License-Identifier: MIT
// The layout of the GPU's buffers: one definition for GLSL and C++ (included by both).

// Keyframes: RGBA32UI, see animation/keyframes/PackedKeyframes.h. A joint transform is three texels (translation, rotation, scale).
#define POSE_TEXELS_PER_TRANSFORM 3
#define POSE_ADDRESS_IS_CONSTANT 0x80000000u // an address in the buffer, not in the record

// A track's entry in the table of a compact clip that moves it; its last word is the address of its vectors. If its rotation
// moves, each of the first three words has a component's range (20 bits: the least value and the extent in units of 1 / 512;
// without bits the value in units of 2^-19) and its bits in a record (5 bits). The rest is the place of the numbers: the lower
// 6 bits of the texel in the record; the first bit in that texel (7 bits); the omitted component (3 bits, 4: of two bits that
// follow the numbers) and the upper 4 bits of the texel. Values are those of the middle of a step.
#define POSE_ROTATION_RANGE_UNIT 0.001953125
#define POSE_ROTATION_FINE_UNIT 1.9073486328125e-06
#define POSE_ROTATION_BITS_SHIFT 20
#define POSE_ROTATION_PLACE_SHIFT 25
#define POSE_ROTATION_HIGH_SHIFT 28
#define POSE_ROTATION_LARGEST 4u // the place if a keyframe omits its largest component

// The vectors of a compact track: translation, scale; then, if one of them moves, a second texel of each. The last word of the
// first texel is 0 for a constant; else POSE_VECTOR_MOVES and the first bit in the record. Then the first texel has the base,
// the second the step and the bits of each number: value = base + step * number.
#define POSE_VECTOR_MOVES 0x80000000u
#define POSE_VECTOR_BITS 5

// The motion of a part (translation, scale), which decides what the mix stage fetches: PartMotion in C++.
#define POSE_PART_FIXED 0
#define POSE_PART_CONSTANT 1
#define POSE_PART_MOVING 2

// Blend samples: RGBA32UI, one texel per sample: keyframe, alpha (float bits), weight (float bits), control.
// The upper 16 bits of control are the index of a mask (0: none); the lower bits are flags:
#define POSE_SAMPLE_SPLINE 1u    // the clip's tracks are value, in-tangent, out-tangent
#define POSE_SAMPLE_ADDITIVE 2u  // adds its difference from the preceding REFERENCE
#define POSE_SAMPLE_REFERENCE 4u // adds nothing itself; its weight is that of the next sample
#define POSE_SAMPLE_ABOVE 8u     // the first sample of a higher blend priority
#define POSE_SAMPLE_POSED 16u    // the keyframe is a posed one: its index among those of the batch
#define POSE_SAMPLE_MASK_SHIFT 16

// Posed keyframes: RGBA32UI, one transform per track. A number that is not set has this bit pattern, which is a NaN: shaders
// compare it as an integer.
#define POSE_NOT_SET 0xFFFFFFFFu

// Additive layers do not change axes with a smaller reference scale.
#define POSE_SMALLEST_SCALE 1e-6

// Masks: RGBA32F, one weight per track, four per texel; each mask starts at a new texel; mask 0 is all 1.
#define POSE_WEIGHTS_PER_MASK_TEXEL 4

// Palette entries, the static part: RGBA32F, nine texels per entry: head, three rows of parentBind, three of inverseBind,
// translation and scale at rest.
// The head contains four integers: parent entry (-1: the root), track (-1: none), 1 for morph weights or else 0, the
// code of the constraints' correction (0: none).
#define POSE_TEXELS_PER_ENTRY 9

// Constraints: vec4, per constraint these, then three per joint of its chain: track, code of the correction to read (0:
// none), share of the turn, 0; translation at rest; scale at rest. The first vec4 contains the parent entry of the path's
// first joint and the number of the target; three rows of its parentBind follow, then three vec4. A look-at: forward axis
// and the cosine of the cone (below -1: none), up axis and the sine of the cone, offset. Two-bone inverse kinematics: hinge
// and soft reach, two unused.
#define POSE_TEXELS_PER_CONSTRAINT 7
#define POSE_TEXELS_PER_CHAIN_JOINT 3

// Targets: RGBA32F, ConstraintTarget in C++, for each instance one per constraint of the set: position and weight; pole
// and twist; the last joint's rotation (0: none).
#define POSE_TEXELS_PER_TARGET 3

// Corrected rotations: RGBA32F. The code (first * 16 + count) * 16 + place of a joint is a CorrectionPlace in C++.
#define POSE_CORRECTION_BASE 16

// The palette: RGBA32F, a 3x4 matrix is three texels (rows). Entry e of instance i is matrix e * stride + i.
#define POSE_TEXELS_PER_MATRIX 3

// Products of matrices keep their numbers within this, in the shaders and on the CPU, so that their products are finite.
#define POSE_LARGEST_NUMBER 1e18

// Vertex attributes of a skinned mesh: palette entries and their weights, four per set.
#define POSE_ENTRIES_0_LOCATION 12
#define POSE_WEIGHTS_0_LOCATION 13
#define POSE_ENTRIES_1_LOCATION 14
#define POSE_WEIGHTS_1_LOCATION 15

// Vertex attributes of instanced characters, one per GL instance: three rows of the matrix to eye space, then the index of
// the pose in its batch. OSG may use these locations for texture coordinates of units above 0 and secondary colours.
#define POSE_INSTANCE_ROW_0_LOCATION 6
#define POSE_INSTANCE_ROW_1_LOCATION 7
#define POSE_INSTANCE_ROW_2_LOCATION 10
#define POSE_INSTANCE_POSE_LOCATION 11

// Vertex attributes of surfaces: the tangent, and the texture coordinates 1 and 2.
#define POSE_TANGENT_LOCATION 4
#define POSE_COORDINATES_LOCATION 9
#define POSE_PART_LOCATION 9 // of merged meshes, which have one texture coordinate at most

// The texture units of a material's maps, after those of osgShadow's techniques (1 to 7). Unit 0 is the base colour.
#define METALLIC_ROUGHNESS_UNIT 8
#define NORMAL_UNIT 9
#define OCCLUSION_UNIT 10
#define EMISSIVE_UNIT 14
#define ENVIRONMENT_UNIT 15
#define EXTENSION_MAPS_UNIT 16 // the first of PbrMaterial::mostExtensionMaps

// The texture units that hold the palette, a mesh's morph targets and the instances' tints during its draw.
#define POSE_PALETTE_UNIT 11
#define POSE_MORPH_UNIT 12
#define POSE_TINT_UNIT 13
// The texture units of lists of instances: the list of those drawn, and, for instances with shared poses, the placements of
// all. Of an instance the list has its pose and, in one number, its index in the crowd and above it its outfit (0: none).
#define POSE_DRAWN_UNIT 30
#define POSE_PLACEMENT_UNIT 31
#define POSE_DRAWN_OUTFIT_SHIFT 20
#define POSE_DRAWN_INDEX_MASK 0xFFFFFu

// The colours of one material in all outfits of a crowd, four to a vector: RGBA, 8 bits each, red lowest.
// Of a mesh that shows several parts, the parts of each outfit in the same way: bit p for the vertices of part p.
#define POSE_OUTFITS_PER_VECTOR 4
#define POSE_OUTFIT_VECTORS 65

// Morph targets of a mesh: RGBA32F, for each vertex and target one texel per channel: position, normal, colour, texture
// coordinate, tangent. The weights are in palette entries, twelve per entry.
#define POSE_WEIGHTS_PER_ENTRY 12

// Vertex attributes of the pose pass, whose vertices are a batch's instances and whose GL instances are palette entries:
// per vertex the first blend samples and three rows of the root matrix, per GL instance an entry's texels.
#define POSE_SAMPLE_LOCATION 0
#define POSE_SAMPLES_AS_ATTRIBUTES 4 // with more samples per instance, all are fetched
#define POSE_ROOT_LOCATION 4
#define POSE_HEAD_LOCATION 7
#define POSE_PARENT_BIND_LOCATION 8
#define POSE_INVERSE_BIND_LOCATION 11
#define POSE_REST_LOCATION 14
