extern "C" {
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <cmath>

#include "base/atomic_file.h"
#include "render/film/frame_sink.h"
#include "render/film/libav.h"

namespace marey::render {
namespace {

void chooseH264(AVCodecContext& context, const VideoFormat& format) {
  requireAv(av_opt_set(context.priv_data, "preset", "medium", 0), "choosing the preset");
  requireAv(av_opt_set_double(context.priv_data, "crf", format.quality, 0), "setting the quality");
  // Scene cuts would add key frames at places that differ from video to video.
  requireAv(av_opt_set(context.priv_data, "sc_threshold", "0", 0), "fixing the key frames");
}

void chooseVp9(AVCodecContext& context, const VideoFormat& format) {
  // VP9 counts from 0 to 63 what H.264 counts from 0 to 51.
  const auto quality = static_cast<int64_t>(std::lround(format.quality * 63.0 / 51.0));
  requireAv(av_opt_set_int(context.priv_data, "crf", quality, 0), "setting the quality");
  requireAv(av_opt_set(context.priv_data, "deadline", "good", 0), "choosing the speed");
  requireAv(av_opt_set_int(context.priv_data, "cpu-used", 4, 0), "choosing the speed");
  context.bit_rate = 0;  // quality alone decides
}

CodecPtr openEncoder(VideoKind kind, const VideoFormat& format, bool globalHeader) {
  const AVCodec* codec = kind == VideoKind::WebM ? encoderNamed("libvpx-vp9", "VP9")
                                                 : encoderNamed("libx264", "H.264");
  CodecPtr context(avcodec_alloc_context3(codec));
  context->width = format.width;
  context->height = format.height;
  context->pix_fmt = AV_PIX_FMT_YUV420P;
  context->framerate = av_d2q(format.fps, 1001000);
  context->time_base = av_inv_q(context->framerate);
  context->gop_size = format.keyFrameEvery;
  context->keyint_min = format.keyFrameEvery;
  context->colorspace = AVCOL_SPC_BT709;
  context->color_primaries = AVCOL_PRI_BT709;
  context->color_trc = AVCOL_TRC_BT709;
  context->color_range = AVCOL_RANGE_MPEG;
  // A fixed number of threads: the bytes must not depend on the machine.
  context->thread_count = 2;
  context->flags |= AV_CODEC_FLAG_BITEXACT;
  if (globalHeader) context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (kind == VideoKind::WebM)
    chooseVp9(*context, format);
  else
    chooseH264(*context, format);
  av_log_set_level(AV_LOG_ERROR);
  requireAv(avcodec_open2(context.get(), codec, nullptr), "opening the encoder");
  return context;
}

class EncodedSink : public FrameSink {
 public:
  EncodedSink(const std::filesystem::path& path, VideoKind kind, const VideoFormat& format,
              const Recipe& recipe)
      : m_path(path), m_file(kind == VideoKind::WebM ? "webm" : "mp4") {
    m_codec = openEncoder(kind, format, m_file.wantsGlobalHeader());
    m_file.begin(*m_codec, recipe.empty() ? std::string() : recipeText(recipe));
    m_scaler = sws_getContext(format.width, format.height, AV_PIX_FMT_RGBA, format.width,
                              format.height, AV_PIX_FMT_YUV420P, SWS_BICUBIC | SWS_ACCURATE_RND,
                              nullptr, nullptr, nullptr);
    if (m_scaler == nullptr) throw Error("video: no conversion from RGBA to yuv420p");
    const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(m_scaler, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
    m_frame->format = AV_PIX_FMT_YUV420P;
    m_frame->width = format.width;
    m_frame->height = format.height;
    requireAv(av_frame_get_buffer(m_frame.get(), 0), "allocating a frame");
  }
  ~EncodedSink() override { sws_freeContext(m_scaler); }
  EncodedSink(const EncodedSink&) = delete;
  EncodedSink& operator=(const EncodedSink&) = delete;

  void add(const Image& image) override {
    requireAv(av_frame_make_writable(m_frame.get()), "reusing the frame");
    const uint8_t* rows[1] = {image.pixels.data()};
    const int stride[1] = {4 * image.width};
    sws_scale(m_scaler, rows, stride, 0, image.height, m_frame->data, m_frame->linesize);
    m_frame->pts = m_count++;
    m_file.encode(*m_codec, m_frame.get());
  }

  void finish() override {
    m_file.encode(*m_codec, nullptr);
    writeFileAtomically(m_path, m_file.take());
  }

 private:
  std::filesystem::path m_path;
  MemoryFile m_file;
  CodecPtr m_codec;
  SwsContext* m_scaler = nullptr;
  FramePtr m_frame{av_frame_alloc()};
  int64_t m_count = 0;
};

}  // namespace

std::unique_ptr<FrameSink> openEncoded(const std::filesystem::path& path, VideoKind kind,
                                       const VideoFormat& format, const Recipe& recipe) {
  return std::make_unique<EncodedSink>(path, kind, format, recipe);
}

}  // namespace marey::render
