#include <cstdint>  // libav wants its constants

extern "C" {
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <vector>

#include "base/atomic_file.h"
#include "render/film/frame_sink.h"
#include "render/film/libav.h"

namespace marey::render {
namespace {

constexpr const char* kFrames = "buffer@frames";
constexpr const char* kPalette = "buffer@palette";
constexpr const char* kResult = "buffersink@result";

/// A chain of libav's filters with named ends.
class FilterGraph {
 public:
  explicit FilterGraph(const std::string& description) : m_graph(avfilter_graph_alloc()) {
    m_graph->nb_threads = 1;
    AVFilterInOut *inputs = nullptr, *outputs = nullptr;
    const int status = avfilter_graph_parse2(m_graph.get(), description.c_str(), &inputs, &outputs);
    avfilter_inout_free(&inputs);
    avfilter_inout_free(&outputs);
    requireAv(status, "arranging the filters of a palette");
    requireAv(avfilter_graph_config(m_graph.get(), nullptr), "joining the filters of a palette");
  }

  /// nullptr ends the input.
  void put(const char* input, AVFrame* frame) {
    requireAv(av_buffersrc_add_frame(end(input), frame), "filtering a frame");
  }
  /// Null where more input is needed, or none comes any more.
  FramePtr get() {
    FramePtr frame(av_frame_alloc());
    const int status = av_buffersink_get_frame(end(kResult), frame.get());
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return nullptr;
    requireAv(status, "filtering a frame");
    return frame;
  }

 private:
  AVFilterContext* end(const char* name) const {
    AVFilterContext* found = avfilter_graph_get_filter(m_graph.get(), name);
    if (found == nullptr) throw Error(fmt::format("video: no filter '{}'", name));
    return found;
  }
  GraphPtr m_graph;
};

std::string source(const char* name, int width, int height, const char* pixels, AVRational base) {
  return fmt::format("{}=video_size={}x{}:pix_fmt={}:time_base={}/{}:pixel_aspect=1/1", name, width,
                     height, pixels, base.num, base.den);
}

/// A comment extension (GIF89a, section 24) right behind the header and the global palette.
std::string withComment(std::string gif, const std::string& comment) {
  constexpr size_t kHeader = 13, kFlagsAt = 10, kMostInBlock = 255;
  const auto flags = static_cast<unsigned char>(gif.at(kFlagsAt));
  const size_t palette = (flags & 0x80) != 0 ? size_t{3} << ((flags & 7) + 1) : 0;
  std::string block = "\x21\xfe";
  for (size_t i = 0; i < comment.size(); i += kMostInBlock) {
    const std::string part = comment.substr(i, kMostInBlock);
    block += static_cast<char>(part.size());
    block += part;
  }
  block += '\0';
  return gif.insert(std::min(gif.size(), kHeader + palette), block);
}

class GifSink : public FrameSink {
 public:
  GifSink(const std::filesystem::path& path, const VideoFormat& format, const Recipe& recipe)
      : m_path(path),
        m_format(format),
        m_recipe(recipe),
        m_base(av_inv_q(av_d2q(format.fps, 1001000))),
        m_frames(source(kFrames, format.width, format.height, "rgba", m_base)),
        m_statistics(m_frames + ",palettegen=stats_mode=full:reserve_transparent=1," + kResult) {}

  void add(const Image& image) override {
    m_waiting.push_back(encodePng(image));
    const FramePtr frame = frameOf(image);
    frame->pts = static_cast<int64_t>(m_waiting.size()) - 1;
    m_statistics.put(kFrames, frame.get());
  }

  void finish() override {
    av_log_set_level(AV_LOG_ERROR);
    m_statistics.put(kFrames, nullptr);
    const FramePtr palette = m_statistics.get();
    if (palette == nullptr) throw Error(m_path.string() + ": no palette came of the frames");
    palette->pts = 0;
    // Ordered dithering: its pattern stays in place, so what does not move is not stored again.
    FilterGraph use(m_frames + "[frames];" +
                    source(kPalette, palette->width, palette->height,
                           av_get_pix_fmt_name(static_cast<AVPixelFormat>(palette->format)),
                           m_base) +
                    "[palette];[frames][palette]paletteuse=dither=bayer:bayer_scale=4," + kResult);
    use.put(kPalette, palette.get());
    use.put(kPalette, nullptr);
    MemoryFile file("gif");
    CodecPtr codec;
    for (size_t k = 0; k <= m_waiting.size(); ++k) {
      FramePtr frame;
      if (k < m_waiting.size()) {
        frame = frameOf(decodePng(m_waiting[k], m_path.string()));
        frame->pts = static_cast<int64_t>(k);
      }
      use.put(kFrames, frame.get());
      while (const FramePtr picture = use.get()) {
        if (!codec) {
          codec = openEncoder();
          file.begin(*codec, {});
        }
        file.encode(*codec, picture.get());
      }
    }
    file.encode(*codec, nullptr);
    std::string bytes = file.take();
    if (!m_recipe.empty()) bytes = withComment(std::move(bytes), recipeText(m_recipe));
    writeFileAtomically(m_path, bytes);
  }

 private:
  CodecPtr openEncoder() const {
    const AVCodec* codec = encoderNamed("gif", "GIF");
    CodecPtr context(avcodec_alloc_context3(codec));
    context->width = m_format.width;
    context->height = m_format.height;
    context->pix_fmt = AV_PIX_FMT_PAL8;
    context->time_base = m_base;
    context->framerate = av_inv_q(m_base);
    context->flags |= AV_CODEC_FLAG_BITEXACT;
    requireAv(avcodec_open2(context.get(), codec, nullptr), "opening the encoder");
    return context;
  }

  std::filesystem::path m_path;
  VideoFormat m_format;
  Recipe m_recipe;
  AVRational m_base;
  std::string m_frames;  ///< description of the frames' source
  FilterGraph m_statistics;
  std::vector<std::string> m_waiting;  ///< PNG
};

}  // namespace

std::unique_ptr<FrameSink> openGif(const std::filesystem::path& path, const VideoFormat& format,
                                   const Recipe& recipe) {
  return std::make_unique<GifSink>(path, format, recipe);
}

}  // namespace marey::render
