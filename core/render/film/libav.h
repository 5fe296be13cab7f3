// What the writers of video files share: errors, owners of libav's objects, a file in memory.
#pragma once

#include <cstdint>  // libav wants its constants

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
}

#include <array>
#include <cstring>
#include <memory>
#include <string>

#include "base/error.h"
#include "render/base/image.h"

namespace marey::render {

template <auto Free>
struct AvDeleter {
  template <typename T>
  void operator()(T* p) const {
    Free(&p);
  }
};
using CodecPtr = std::unique_ptr<AVCodecContext, AvDeleter<avcodec_free_context>>;
using FramePtr = std::unique_ptr<AVFrame, AvDeleter<av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, AvDeleter<av_packet_free>>;
using GraphPtr = std::unique_ptr<AVFilterGraph, AvDeleter<avfilter_graph_free>>;

inline void requireAv(int status, const char* step) {
  if (status >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(status, reason.data(), reason.size());
  throw Error(fmt::format("video: {} failed: {}", step, reason.data()));
}

/// The encoder of that name, as libav calls it.
inline const AVCodec* encoderNamed(const char* name, const char* what) {
  const AVCodec* codec = avcodec_find_encoder_by_name(name);
  if (codec == nullptr)
    throw Error(fmt::format("video: no {} encoder ({}) in the installed libavcodec", what, name));
  return codec;
}

/// RGBA, for filters.
inline FramePtr frameOf(const Image& image) {
  FramePtr frame(av_frame_alloc());
  frame->format = AV_PIX_FMT_RGBA;
  frame->width = image.width;
  frame->height = image.height;
  requireAv(av_frame_get_buffer(frame.get(), 0), "allocating a frame");
  const int row = 4 * image.width;
  av_image_copy_plane(frame->data[0], frame->linesize[0], image.pixels.data(), row, row,
                      image.height);
  return frame;
}

/// One stream in a container that is written to memory: some go back to fill in their index.
class MemoryFile {
 public:
  /// `container`: libav's name of it.
  explicit MemoryFile(const char* container) {
    requireAv(avformat_alloc_output_context2(&m_file, nullptr, container, nullptr),
              "creating the file");
    constexpr int bufferSize = 1 << 16;
    auto* buffer = static_cast<unsigned char*>(av_malloc(bufferSize));
    m_file->pb = avio_alloc_context(buffer, bufferSize, 1, this, nullptr, write, seek);
    m_file->flags |= AVFMT_FLAG_BITEXACT;
  }
  ~MemoryFile() {
    if (m_file == nullptr) return;
    if (m_file->pb != nullptr) {
      av_freep(&m_file->pb->buffer);
      avio_context_free(&m_file->pb);
    }
    avformat_free_context(m_file);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  bool wantsGlobalHeader() const { return (m_file->oformat->flags & AVFMT_GLOBALHEADER) != 0; }

  /// Writes the header; a comment that is not empty becomes metadata.
  void begin(const AVCodecContext& codec, const std::string& comment) {
    m_stream = avformat_new_stream(m_file, nullptr);
    requireAv(avcodec_parameters_from_context(m_stream->codecpar, &codec), "describing the stream");
    m_stream->time_base = codec.time_base;
    m_stream->avg_frame_rate = codec.framerate;
    if (!comment.empty()) av_dict_set(&m_file->metadata, "comment", comment.c_str(), 0);
    requireAv(avformat_write_header(m_file, nullptr), "writing the header");
  }

  /// Sends a frame (nullptr: the end) through the encoder and keeps what comes out.
  void encode(AVCodecContext& codec, const AVFrame* picture) {
    requireAv(avcodec_send_frame(&codec, picture), "encoding");
    while (true) {
      const int status = avcodec_receive_packet(&codec, m_packet.get());
      if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return;
      requireAv(status, "encoding");
      m_packet->duration = 1;
      av_packet_rescale_ts(m_packet.get(), codec.time_base, m_stream->time_base);
      m_packet->stream_index = m_stream->index;
      requireAv(av_interleaved_write_frame(m_file, m_packet.get()), "writing a frame");
    }
  }

  /// Completes the file.
  std::string take() {
    requireAv(av_write_trailer(m_file), "writing the index");
    avio_flush(m_file->pb);
    return std::move(m_bytes);
  }

 private:
  static int write(void* self, uint8_t* data, int size) {
    auto& file = *static_cast<MemoryFile*>(self);
    const auto count = static_cast<size_t>(size);
    if (file.m_at + count > file.m_bytes.size()) file.m_bytes.resize(file.m_at + count);
    std::memcpy(file.m_bytes.data() + file.m_at, data, count);
    file.m_at += count;
    return size;
  }
  static int64_t seek(void* self, int64_t offset, int whence) {
    auto& file = *static_cast<MemoryFile*>(self);
    if (whence == AVSEEK_SIZE) return static_cast<int64_t>(file.m_bytes.size());
    const auto base = whence == SEEK_CUR   ? static_cast<int64_t>(file.m_at)
                      : whence == SEEK_END ? static_cast<int64_t>(file.m_bytes.size())
                                           : 0;
    if (base + offset < 0) return AVERROR(EINVAL);
    file.m_at = static_cast<size_t>(base + offset);
    return base + offset;
  }

  std::string m_bytes;
  size_t m_at = 0;
  AVFormatContext* m_file = nullptr;
  AVStream* m_stream = nullptr;
  PacketPtr m_packet{av_packet_alloc()};
};

}  // namespace marey::render
