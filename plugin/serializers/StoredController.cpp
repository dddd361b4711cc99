// SPDX-License-Identifier: MIT
#include "serializers/StoredController.h"

#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/animation/LayerSnapshot.h>

#include <osg/Notify>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::int32_t version = 1;

void writeFade(ValueWriter& out, const char* name, const LayerSnapshot::FadeState& fade)
{
    out.property(name).real(fade.from).real(fade.to).real(fade.seconds).real(fade.elapsed);
    out.integer(static_cast<std::int32_t>(fade.curve)).endLine();
}

LayerSnapshot::FadeState readFade(ValueReader& in, const char* name)
{
    LayerSnapshot::FadeState fade;
    fade.from = in.property(name).real();
    fade.to = in.real();
    fade.seconds = in.real();
    fade.elapsed = in.real();
    fade.curve = static_cast<FadeCurve>(in.integer("a fade's curve", 0, static_cast<int>(FadeCurve::Smooth)));
    return fade;
}

LoopMode readLoopMode(ValueReader& in)
{
    return static_cast<LoopMode>(in.integer("a loop mode", 0, static_cast<int>(LoopMode::PingPong)));
}

void writeVoice(ValueWriter& out, const LayerSnapshot::Voice& voice)
{
    out.property("Voice").integer(voice.clip).real(voice.time).real(voice.speed);
    out.integer(static_cast<std::int32_t>(voice.loopMode)).flag(voice.isReturning).flag(voice.isFresh);
    out.real(voice.share).real(voice.shareBefore).integer(voice.phaseGroup).endLine();
}

LayerSnapshot::Voice readVoice(ValueReader& in)
{
    LayerSnapshot::Voice voice;
    voice.clip = in.property("Voice").integer();
    voice.time = in.real();
    voice.speed = in.real();
    voice.loopMode = readLoopMode(in);
    voice.isReturning = in.flag();
    voice.isFresh = in.flag();
    voice.share = in.real();
    voice.shareBefore = in.real();
    voice.phaseGroup = in.integer();
    return voice;
}

void writeLayer(ValueWriter& out, const LayerSnapshot& layer)
{
    out.property("Layer").integer(static_cast<std::int32_t>(layer.state));
    out.integer(static_cast<std::int32_t>(layer.loopMode)).real(layer.speed);
    out.integer(static_cast<std::int32_t>(layer.mode)).integer(static_cast<std::int32_t>(layer.reference));
    out.integer(layer.standing).endLine();
    out.open("Voices", layer.voices.size());
    for (const LayerSnapshot::Voice& voice : layer.voices)
        writeVoice(out, voice);
    out.close();
    writeFade(out, "Crossfade", layer.crossfade);
    writeFade(out, "Weight", layer.weight);
    out.block("Mask", layer.mask.data(), layer.mask.size(), 8);
}

LayerSnapshot readLayer(ValueReader& in)
{
    using Layer = AnimationLayer;
    LayerSnapshot layer;
    in.property("Layer");
    layer.state = static_cast<PlayState>(in.integer("a layer's state", 0, static_cast<int>(PlayState::Ended)));
    layer.loopMode = readLoopMode(in);
    layer.speed = in.real();
    layer.mode = static_cast<Layer::Mode>(in.integer("a layer's mode", 0, static_cast<int>(Layer::Mode::Additive)));
    layer.reference = static_cast<Layer::Reference>(
        in.integer("a layer's reference", 0, static_cast<int>(Layer::Reference::FirstFrame)));
    layer.standing = in.integer();
    const std::size_t voices = in.open("Voices");
    for (std::size_t v = 0; v < voices && in.isGood(); ++v)
        layer.voices.push_back(readVoice(in));
    in.close();
    layer.crossfade = readFade(in, "Crossfade");
    layer.weight = readFade(in, "Weight");
    layer.mask = in.block("Mask");
    return layer;
}

} // namespace

void writeController(ValueWriter& out, const AnimationController& controller)
{
    out.integer(version).endLine();
    out.open("Layers", controller.layerCount());
    for (std::size_t i = 0; i < controller.layerCount(); ++i)
        writeLayer(out, controller.layer(i).snapshot());
    out.close();
}

void readController(ValueReader& in, AnimationController& controller)
{
    in.integer("the version of a controller", 1, version);
    const std::size_t layers = in.open("Layers");
    if (layers > maxLayers) in.fail(std::to_string(layers) + " layers, at most " + std::to_string(maxLayers));
    for (std::size_t i = 0; i < layers && in.isGood(); ++i)
    {
        const LayerSnapshot layer = readLayer(in);
        if (!in.isGood()) return;
        const Result<bool> restored = controller.layer(i).restore(layer);
        if (!restored)
            OSG_WARN << "osgGpuAnimation: layer " << i << " of a character: " << restored.error().message
                     << "; it does not play" << std::endl;
    }
    in.close();
}

} // namespace osgGpuAnimation::serializers
