#include "render/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey::render {

namespace {
template <auto Free>
struct Deleter {
  template <typename T>
  void operator()(T* p) const {
    Free(&p);
  }
};
using CodecPtr = std::unique_ptr<AVCodecContext, Deleter<avcodec_free_context>>;
using FramePtr = std::unique_ptr<AVFrame, Deleter<av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, Deleter<av_packet_free>>;

void require(int status, const char* step) {
  if (status >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(status, reason.data(), reason.size());
  throw Error(fmt::format("video: {} failed: {}", step, reason.data()));
}

/// The file while it is written: MP4 goes back to fill in its index.
struct Memory {
  std::string bytes;
  size_t at = 0;

  static int write(void* self, uint8_t* data, int size) {
    auto& memory = *static_cast<Memory*>(self);
    const auto count = static_cast<size_t>(size);
    if (memory.at + count > memory.bytes.size()) memory.bytes.resize(memory.at + count);
    std::memcpy(memory.bytes.data() + memory.at, data, count);
    memory.at += count;
    return size;
  }
  static int64_t seek(void* self, int64_t offset, int whence) {
    auto& memory = *static_cast<Memory*>(self);
    if (whence == AVSEEK_SIZE) return static_cast<int64_t>(memory.bytes.size());
    const auto base = whence == SEEK_CUR   ? static_cast<int64_t>(memory.at)
                      : whence == SEEK_END ? static_cast<int64_t>(memory.bytes.size())
                                           : 0;
    if (base + offset < 0) return AVERROR(EINVAL);
    memory.at = static_cast<size_t>(base + offset);
    return base + offset;
  }
};

const AVCodec* encoder() {
  const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
  if (codec == nullptr)
    throw Error("video: no H.264 encoder (libx264) in the installed libavcodec");
  return codec;
}

void checkFormat(const std::filesystem::path& path, const VideoFormat& f) {
  const Place place{.path = path.string()};
  if (f.width < 16 || f.height < 16 || f.width % 2 != 0 || f.height % 2 != 0) {
    throwInput(place, "an even picture size of 16x16 or more", "{}x{}", f.width, f.height);
  }
  if (!(f.fps > 0.0 && f.fps <= 1000.0))
    throwInput(place, "a frame rate in (0, 1000]", "{}", f.fps);
  if (f.quality < 0 || f.quality > 51) throwInput(place, "a quality from 0 to 51", "{}", f.quality);
  if (f.keyFrameEvery < 1)
    throwInput(place, "a key frame every frame or more", "{}", f.keyFrameEvery);
}

CodecPtr openEncoder(const VideoFormat& format, bool globalHeader) {
  const AVCodec* codec = encoder();
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
  require(av_opt_set(context->priv_data, "preset", "medium", 0), "choosing the preset");
  require(av_opt_set_double(context->priv_data, "crf", format.quality, 0), "setting the quality");
  // Scene cuts would add key frames at places that differ from video to video.
  require(av_opt_set(context->priv_data, "sc_threshold", "0", 0), "fixing the key frames");
  av_log_set_level(AV_LOG_ERROR);
  require(avcodec_open2(context.get(), codec, nullptr), "opening the encoder");
  return context;
}
}  // namespace

struct VideoWriter::Internals {
  std::filesystem::path path;
  VideoFormat format;
  Memory memory;
  AVFormatContext* file = nullptr;
  AVStream* stream = nullptr;
  CodecPtr codec;
  SwsContext* scaler = nullptr;
  FramePtr frame{av_frame_alloc()};
  PacketPtr packet{av_packet_alloc()};
  int64_t count = 0;

  ~Internals() {
    sws_freeContext(scaler);
    if (file == nullptr) return;
    if (file->pb != nullptr) {
      av_freep(&file->pb->buffer);
      avio_context_free(&file->pb);
    }
    avformat_free_context(file);
  }
  void openFile(const Recipe& recipe);
  void openScaler();
  void encode(const AVFrame* picture);
};

void VideoWriter::Internals::openFile(const Recipe& recipe) {
  require(avformat_alloc_output_context2(&file, nullptr, "mp4", nullptr), "creating the MP4 file");
  constexpr int bufferSize = 1 << 16;
  auto* buffer = static_cast<unsigned char*>(av_malloc(bufferSize));
  file->pb =
      avio_alloc_context(buffer, bufferSize, 1, &memory, nullptr, Memory::write, Memory::seek);
  file->flags |= AVFMT_FLAG_BITEXACT;
  codec = openEncoder(format, (file->oformat->flags & AVFMT_GLOBALHEADER) != 0);
  stream = avformat_new_stream(file, nullptr);
  require(avcodec_parameters_from_context(stream->codecpar, codec.get()), "describing the stream");
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  if (!recipe.empty()) av_dict_set(&file->metadata, "comment", recipeText(recipe).c_str(), 0);
  require(avformat_write_header(file, nullptr), "writing the header");
}

void VideoWriter::Internals::openScaler() {
  scaler =
      sws_getContext(format.width, format.height, AV_PIX_FMT_RGBA, format.width, format.height,
                     AV_PIX_FMT_YUV420P, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr);
  if (scaler == nullptr) throw Error("video: no conversion from RGBA to yuv420p");
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  frame->format = AV_PIX_FMT_YUV420P;
  frame->width = format.width;
  frame->height = format.height;
  require(av_frame_get_buffer(frame.get(), 0), "allocating a frame");
}

/// nullptr ends the stream.
void VideoWriter::Internals::encode(const AVFrame* picture) {
  require(avcodec_send_frame(codec.get(), picture), "encoding");
  while (true) {
    const int status = avcodec_receive_packet(codec.get(), packet.get());
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return;
    require(status, "encoding");
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    packet->stream_index = stream->index;
    require(av_interleaved_write_frame(file, packet.get()), "writing a frame");
  }
}

VideoWriter::VideoWriter(std::filesystem::path path, const VideoFormat& format,
                         const Recipe& recipe) {
  checkFormat(path, format);
  m_internals = std::make_unique<Internals>();
  m_internals->path = std::move(path);
  m_internals->format = format;
  m_internals->openFile(recipe);
  m_internals->openScaler();
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& image) {
  Internals& i = *m_internals;
  if (image.width != i.format.width || image.height != i.format.height) {
    throwInput({.path = i.path.string(), .frame = i.count + 1},
               fmt::format("{}x{} pixels", i.format.width, i.format.height), "{}x{}", image.width,
               image.height);
  }
  require(av_frame_make_writable(i.frame.get()), "reusing the frame");
  const uint8_t* rows[1] = {image.pixels.data()};
  const int stride[1] = {4 * image.width};
  sws_scale(i.scaler, rows, stride, 0, image.height, i.frame->data, i.frame->linesize);
  i.frame->pts = i.count++;
  i.encode(i.frame.get());
}

void VideoWriter::finish() {
  Internals& i = *m_internals;
  if (i.count == 0) throw Error(i.path.string() + ": a video needs at least one frame");
  i.encode(nullptr);
  require(av_write_trailer(i.file), "writing the index");
  avio_flush(i.file->pb);
  writeFileAtomically(i.path, i.memory.bytes);
}

int writeSceneVideo(const std::filesystem::path& path, const SceneSpec& scene,
                    const VideoFormat& format, const VideoOptions& options, const Recipe& recipe,
                    Progress& progress) {
  VideoWriter writer(path, format, recipe);
  SceneRenderer renderer(scene, format.width, format.height);
  const int frames =
      std::max(1, static_cast<int>(std::floor(renderer.seconds() * format.fps + 1e-6)));
  for (int k = 0; k < frames; ++k) {
    progress.throwIfCancelled();
    writer.add(renderer.frame(k / format.fps, options.follow, options.trail));
    progress.report((k + 1.0) / frames, fmt::format("frame {} of {}", k + 1, frames));
  }
  writer.finish();
  return frames;
}

}  // namespace marey::render
