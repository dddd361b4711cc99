// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"
#include "StagedViewer.h"
#include "Subject.h"

namespace osgGpuAnimation::benchmark
{

/// The number of rounds and characters of a run, its graphics context and its report.
struct Run
{
    osg::GraphicsContext& context; ///< current when a measurement begins
    Report& report;
    std::string folder;             ///< of the output
    bool isQuick = false;           ///< beQuick() was called
    int rounds = 7;                 ///< of fast measurements
    int loadRounds = 21;            ///< of loading a file
    std::size_t frameCount = 1000;  ///< characters, for the bars of whole frames
    std::size_t barCount = 1000;    ///< characters, for other bars
    std::size_t crowdCount = 10000; ///< instances, for the crowd's bar
    std::vector<std::size_t> poseCounts{1, 10, 100, 1000, 10000};
    std::vector<std::size_t> frameCounts{1, 10, 100, 1000};

    static constexpr int frameRounds = 3;                  ///< of whole frames
    static constexpr std::size_t maxReferenceCount = 1000; ///< characters of osgAnimation

    void beQuick()
    {
        isQuick = true;
        rounds = 5;
        loadRounds = 11;
        frameCount = 100;
        poseCounts = {10, 100, 1000, 10000};
        frameCounts = {10, 100};
    }
};

// Each function adds its rows and points to the report. It throws if GL reports an error or a result is wrong, which
// makes the measurement invalid.

/// The work from advance() to the finished palette, compared with osgAnimation's update traversal and with the
/// FeedbackFloor; and poses that the application writes.
void measurePose(const Subject& subject, Run& run);
/// Four blend samples per character compared with one; layers and crossfades add samples.
void measureSamples(const Subject& subject, Run& run);
/// Look-ats and two-bone inverse kinematics compared with the same characters without, for subjects whose joints are
/// known.
void measureConstraints(const Subject& subject, Run& run);
/// The same characters in chunks of different sizes.
void measureChunks(const Subject& subject, Run& run);
/// Compact clips compared with exact ones: pose and bytes.
void measureCompact(const Subject& subject, Run& run);
/// The cost per joint in chains of 1 to 64 joints.
void measureDepth(Run& run);

// The following ones have viewers and contexts of their own.

/// Whole frames and their stages.
void measureFrames(const Subject& subject, Run& run);
/// One crowd node compared with the same number of separate nodes: whole frames and their CPU time.
void measureCrowd(const Subject& subject, Run& run);
/// The memory and the first frame of many characters.
void measureStart(const Subject& subject, Run& run);
/// Skinned draws compared with unskinned draws of the same meshes and shader, and with the cheapest draw of the
/// triangles.
void measureDraws(const Subject& subject, Run& run);
/// glTF's shading of a picture that the character fills, under one light and in the studio, compared with the fixed
/// pipeline's look.
void measureShading(const Subject& subject, Run& run);
/// A crowd of 24 outfits that hide a third of the parts each, compared with one all alike and with 24 crowds. Nothing
/// for subjects of less than four parts.
void measureOutfits(const Subject& subject, Run& run);
/// 960 separate characters compared with a crowd of as many, alike and, with enough parts, with 24 sets of hidden ones.
void measureSeparate(const Subject& subject, Run& run);
/// A field of 99,856 instances of a crowd with a pixel error, of which the camera sees half: whole frames, poses and
/// bytes.
void measureField(const Subject& subject, Run& run);
/// A field of all subjects in turns; everyone walks and one camera flies through: times and counts a frame.
void measureMixed(const std::vector<Subject>& subjects, Run& run);
/// Pictures of instances with a pixel error of 0.5 against those with all triangles and exact poses: 100 of 4, 8 and 16
/// pixels of height, 8x8 supersampled (coverage, and the structural similarity of Wang et al., Image Quality
/// Assessment, 2004), and the field (steps of brightness from row to row).
void measurePictures(const Subject& subject, Run& run);
/// The memory of a field of 99,856 beyond that of a small one, on the CPU and the GPU.
void measureMemory(const Subject& subject, Run& run);
/// Each choice that only a GPU can judge, on the device of the run: poses of many sets, layouts, uploads and whole
/// frames. It writes gpu.md and gpu.json into the folder and prints the page.
void measureGpu(const std::vector<Subject>& subjects, Run& run);
/// Loading the subject's file, compared with tinygltf's parsing and image decoding.
void measureLoad(const Subject& subject, Run& run);

} // namespace osgGpuAnimation::benchmark
