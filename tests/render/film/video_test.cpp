#include <gtest/gtest.h>
#include <unistd.h>

#include "render/film/film.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "render/film/gif_reader.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

namespace fs = std::filesystem;

struct Decoded {
  AVRational rate{};
  int width = 0, height = 0, keyFrames = 0;
  std::string comment;
  std::vector<int> luma;       ///< at the middle of each frame; nothing true of a GIF
  std::vector<int64_t> times;  ///< in units of 1 / rate
};

/// Reads a file back with libav's demuxer and decoder.
Decoded decode(const fs::path& path) {
  Decoded result;
  AVFormatContext* file = nullptr;
  EXPECT_EQ(avformat_open_input(&file, path.c_str(), nullptr, nullptr), 0);
  EXPECT_GE(avformat_find_stream_info(file, nullptr), 0);
  const AVStream* stream = file->streams[0];
  result.rate = stream->avg_frame_rate;
  if (const auto* tag = av_dict_get(file->metadata, "comment", nullptr, 0))
    result.comment = tag->value;
  AVCodecContext* decoder =
      avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(decoder, stream->codecpar);
  EXPECT_EQ(avcodec_open2(decoder, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  const auto receive = [&] {
    while (avcodec_receive_frame(decoder, frame) == 0) {
      const bool rgb = frame->format == AV_PIX_FMT_BGRA;  // GIF
      EXPECT_TRUE(rgb || frame->format == AV_PIX_FMT_YUV420P) << frame->format;
      result.width = frame->width;
      result.height = frame->height;
      result.keyFrames += frame->key_frame;
      result.luma.push_back(frame->data[0][frame->height / 2 * frame->linesize[0] +
                                           frame->width / 2 * (rgb ? 4 : 1)]);
      result.times.push_back(av_rescale_q(frame->pts, stream->time_base, av_inv_q(result.rate)));
    }
  };
  while (av_read_frame(file, packet) == 0) {
    avcodec_send_packet(decoder, packet);
    av_packet_unref(packet);
    receive();
  }
  avcodec_send_packet(decoder, nullptr);
  receive();
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&decoder);
  avformat_close_input(&file);
  return result;
}

class Video : public testing::Test {
 protected:
  // One folder per test and process: tests run side by side, and other users' may.
  fs::path m_folder =
      fs::temp_directory_path() / (std::string("marey_video_") + std::to_string(::getpid()) + "_" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
  void SetUp() override {
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }
};

Image greyFrame(double lightness) {
  return {64, 48, grey(lightness)};
}

TEST_F(Video, EveryFrameIsThereInOrderAtTheExactRate) {
  const VideoFormat format{.width = 64, .height = 48, .fps = 25.0, .keyFrameEvery = 10};
  VideoWriter writer(m_folder / "grey.mp4", format, {{"seed", "5"}});
  for (int k = 0; k < 25; ++k) writer.add(greyFrame(k / 24.0));
  EXPECT_FALSE(fs::exists(m_folder / "grey.mp4")) << "nothing appears before it is whole";
  writer.finish();
  const Decoded video = decode(m_folder / "grey.mp4");
  EXPECT_EQ(video.rate.num, 25 * video.rate.den);
  EXPECT_EQ(video.width, 64);
  EXPECT_EQ(video.height, 48);
  EXPECT_EQ(video.keyFrames, 3);
  EXPECT_EQ(video.comment, R"({"seed":"5"})");
  ASSERT_EQ(video.luma.size(), 25U);
  for (int k = 0; k < 25; ++k) {
    EXPECT_EQ(video.times[static_cast<size_t>(k)] - video.times[0], k);
    // Studio range: black is 16, white 235.
    EXPECT_NEAR(video.luma[static_cast<size_t>(k)], 16.0 + 219.0 * k / 24.0, 4.0) << k;
  }
}

TEST_F(Video, FractionalRatesAreKept) {
  VideoWriter writer(m_folder / "ntsc.mp4", {.width = 64, .height = 48, .fps = 30000.0 / 1001.0});
  for (int k = 0; k < 3; ++k) writer.add(greyFrame(0.5));
  writer.finish();
  const Decoded video = decode(m_folder / "ntsc.mp4");
  EXPECT_NEAR(av_q2d(video.rate), 30000.0 / 1001.0, 1e-9);
}

TEST_F(Video, TheSameFramesGiveTheSameBytes) {
  for (const std::string kind : {"mp4", "webm", "gif"}) {
    for (const char* name : {"a.", "b."}) {
      VideoWriter writer(m_folder / (name + kind), {.width = 64, .height = 48}, {{"seed", "5"}});
      for (int k = 0; k < 5; ++k) writer.add(greyFrame(k / 5.0));
      writer.finish();
    }
    EXPECT_EQ(readFile(m_folder / ("a." + kind)), readFile(m_folder / ("b." + kind))) << kind;
  }
}

TEST_F(Video, AWebMHoldsTheSameFramesAsVp9) {
  const VideoFormat format{.width = 64, .height = 48, .fps = 25.0, .keyFrameEvery = 10};
  VideoWriter writer(m_folder / "grey.webm", format, {{"seed", "5"}});
  for (int k = 0; k < 25; ++k) writer.add(greyFrame(k / 24.0));
  EXPECT_FALSE(fs::exists(m_folder / "grey.webm")) << "nothing appears before it is whole";
  writer.finish();
  const Decoded video = decode(m_folder / "grey.webm");
  EXPECT_EQ(video.rate.num, 25 * video.rate.den);
  EXPECT_EQ(video.width, 64);
  EXPECT_EQ(video.height, 48);
  EXPECT_EQ(video.keyFrames, 3);
  EXPECT_EQ(video.comment, R"({"seed":"5"})");
  ASSERT_EQ(video.luma.size(), 25U);
  for (int k = 0; k < 25; ++k) {
    EXPECT_EQ(video.times[static_cast<size_t>(k)] - video.times[0], k);
    EXPECT_NEAR(video.luma[static_cast<size_t>(k)], 16.0 + 219.0 * k / 24.0, 4.0) << k;
  }
}

/// The largest and the mean difference of two pictures, over pixels and colours.
struct Difference {
  int most = 0;
  double mean = 0.0;
};

Difference differenceOf(const Image& a, const Image& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  Difference out;
  for (size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
    const int off = std::abs(int{a.pixels[i]} - int{b.pixels[i]});
    out.most = std::max(out.most, off);
    out.mean += off / static_cast<double>(a.pixels.size());
  }
  return out;
}

/// A square that moves over a ground in four quarters: few colours, none of them grey.
Image quarters(int width, int height, int k) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool square = std::abs(x - 2 * k - 6) < 5 && std::abs(y - k - 8) < 5;
      const Colour colours[] = {{0.9, 0.1, 0.2}, {0.1, 0.7, 0.3}, {0.2, 0.3, 0.9}, {0.8, 0.8, 0.1}};
      const Colour& ground = colours[(2 * x >= width ? 1 : 0) + (2 * y >= height ? 2 : 0)];
      const Colour c = square ? Colour{0.05 * k, 0.4, 1.0 - 0.05 * k} : ground;
      const double rgb[] = {c.r, c.g, c.b};
      for (int i = 0; i < 3; ++i)
        image.at(x, y)[i] = static_cast<uint8_t>(std::lround(255.0 * rgb[i]));
      image.at(x, y)[3] = 255;
    }
  return image;
}

TEST_F(Video, AGifHoldsTheSameFramesInExactColours) {
  // 16 colours fit a palette: no dithering, no rounding. An odd width is no trouble here.
  constexpr int count = 12;
  VideoWriter writer(m_folder / "q.gif", {.width = 65, .height = 48, .fps = 20.0},
                     {{"note", std::string(600, 'n')}});
  for (int k = 0; k < count; ++k) writer.add(quarters(65, 48, k));
  EXPECT_FALSE(fs::exists(m_folder / "q.gif")) << "nothing appears before it is whole";
  writer.finish();
  EXPECT_EQ(decode(m_folder / "q.gif").comment, R"({"note":")" + std::string(600, 'n') + R"("})");
  const Gif gif = readGif(readFile(m_folder / "q.gif"));
  EXPECT_EQ(gif.width, 65);
  EXPECT_EQ(gif.height, 48);
  EXPECT_TRUE(gif.endless);
  EXPECT_EQ(gif.hundredths, std::vector<int>(count, 5));
  ASSERT_EQ(gif.frames.size(), size_t{count});
  for (int k = 0; k < count; ++k)
    EXPECT_LE(differenceOf(gif.frames[static_cast<size_t>(k)], quarters(65, 48, k)).most, 1) << k;
}

TEST_F(Video, AGifWithMoreColoursThanAPaletteStaysClose) {
  // 64 x 48 = 3072 colours of a smooth sheet, in each of two frames. A palette of 255 has twelve of
  // them in a box: 4 by 3 steps of 4 or 5, so that its middle is at most 8 away from any, or 16
  // where a box is twice as long; dithering adds 2.
  Image sheet(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const int colour[] = {4 * x, 5 * y, 128, 255};
      for (int i = 0; i < 4; ++i) sheet.at(x, y)[i] = static_cast<uint8_t>(colour[i]);
    }
  VideoWriter writer(m_folder / "sheet.gif", {.width = 64, .height = 48, .fps = 10.0});
  writer.add(sheet);
  writer.add(greyFrame(0.5));
  writer.finish();
  const Gif gif = readGif(readFile(m_folder / "sheet.gif"));
  ASSERT_EQ(gif.frames.size(), 2U);
  EXPECT_LE(differenceOf(gif.frames[0], sheet).most, 18);
  EXPECT_LE(differenceOf(gif.frames[0], sheet).mean, 4.0);
  EXPECT_LE(differenceOf(gif.frames[1], greyFrame(0.5)).most, 18);
}

TEST_F(Video, FramesBecomeNumberedPictures) {
  const fs::path name = m_folder / "walk" / "f_{frame:04}.png";
  VideoWriter writer(name, {.width = 65, .height = 48}, {{"seed", "5"}});
  for (int k = 0; k < 3; ++k) writer.add(Image(65, 48, grey(k / 2.0)));
  EXPECT_FALSE(fs::exists(m_folder / "walk")) << "nothing appears before all are whole";
  writer.finish();
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(m_folder / "walk"))
    found.push_back(entry.path().filename().string());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<std::string>{"f_0000.png", "f_0001.png", "f_0002.png"}));
  const Image middle = readPng(m_folder / "walk" / "f_0001.png");
  EXPECT_EQ(middle.width, 65);
  EXPECT_NEAR(*middle.at(30, 20), 128, 1);
  EXPECT_EQ(pngRecipe(readFile(m_folder / "walk" / "f_0002.png"), "f_0002.png"),
            R"({"seed":"5","frame":"2"})");
  EXPECT_EQ(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()), 1)
      << "no other folder is left";
}

TEST_F(Video, FramesOfALongerVideoAreNotMixedWithThese) {
  const auto write = [this](int count) {
    VideoWriter writer(m_folder / "{frame}.png", {.width = 64, .height = 48});
    for (int k = 0; k < count; ++k) writer.add(greyFrame(0.1 * count));
    writer.finish();
  };
  write(3);
  const std::string before = readFile(m_folder / "0.png");
  EXPECT_THROW(write(2), InputError);
  EXPECT_EQ(readFile(m_folder / "0.png"), before);
  write(4);
  EXPECT_NE(readFile(m_folder / "0.png"), before);
  EXPECT_TRUE(fs::exists(m_folder / "3.png"));
}

TEST_F(Video, FramesOfALongerVideoGoAwayWhereTheyAreToBeReplaced) {
  const fs::path name = m_folder / "f_{frame:02}.png";
  const auto write = [&](int count, bool replace) {
    VideoWriter writer(name, {.width = 64, .height = 48, .replaceLonger = replace});
    for (int k = 0; k < count; ++k) writer.add(greyFrame(0.1));
    writer.finish();
  };
  write(5, false);
  for (const char* other : {"f_7.png", "f_007.png", "f_0a.png", "g_07.png", "f_07.txt"})
    writeFileAtomically(m_folder / other, "not of this video");
  EXPECT_EQ(framesThere(name).size(), 5U);
  write(2, true);
  EXPECT_EQ(framesThere(name).size(), 2U);
  EXPECT_EQ(framesThere(name).rbegin()->first, 1);
  EXPECT_TRUE(fs::exists(m_folder / "f_007.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()), 7);
}

TEST_F(Video, TheNameSaysTheKind) {
  EXPECT_EQ(videoKind("a.mp4"), VideoKind::Mp4);
  EXPECT_EQ(videoKind("a.webm"), VideoKind::WebM);
  EXPECT_EQ(videoKind("a.gif"), VideoKind::Gif);
  EXPECT_EQ(videoKind("b/a{frame}.png"), VideoKind::PngFrames);
  EXPECT_EQ(videoKind("b/{frame:4}.png"), VideoKind::PngFrames);
  EXPECT_EQ(videoKind("a.png"), std::nullopt);
  EXPECT_EQ(videoKind("a.avi"), std::nullopt);
  for (const char* name : {"a{}.png", "{frame:0x}.png", "{frame}{frame}.png", "{frame}/a.png",
                           "{frame}/{frame}.png", "{frame.png", "{frame:00}.png"})
    EXPECT_THROW(videoKind(name), UsageError) << name;
  EXPECT_THROW(VideoWriter("a.avi", {}), UsageError);
}

TEST_F(Video, AGifTooFastForPlayersIsRefused) {
  EXPECT_THROW(VideoWriter(m_folder / "x.gif", {.width = 64, .height = 48, .fps = 60.0}),
               InputError);
  EXPECT_THROW(VideoWriter(m_folder / "x.webm", {.width = 65, .height = 48}), InputError);
}

TEST_F(Video, WrongFormatsAndFramesAreRefused) {
  EXPECT_THROW(VideoWriter(m_folder / "x.mp4", {.width = 65, .height = 48}), InputError);
  EXPECT_THROW(VideoWriter(m_folder / "x.mp4", {.width = 64, .height = 48, .fps = 0.0}),
               InputError);
  EXPECT_THROW(VideoWriter(m_folder / "x.mp4", {.width = 64, .height = 48, .quality = 60}),
               InputError);
  VideoWriter writer(m_folder / "x.mp4", {.width = 64, .height = 48});
  EXPECT_THROW(writer.add(Image(32, 48)), InputError);
  EXPECT_THROW(writer.finish(), Error) << "no frame was added";
  EXPECT_FALSE(fs::exists(m_folder / "x.mp4"));
}

Shot tinyShot() {
  return printed({{.clip = std::make_shared<const Clip>(tinyClip(6))}});
}

TEST_F(Video, ASceneLastsAsLongAsItsLongestMotion) {
  Progress progress;
  const VideoFormat format{.width = 64, .height = 48, .fps = 20.0};
  // Six frames at 10 fps are 0.6 s, twelve frames at 20 fps.
  EXPECT_EQ(writeFilm(m_folder / "s.mp4", tinyShot(), format, {}, progress), 12);
  EXPECT_EQ(decode(m_folder / "s.mp4").luma.size(), 12U);
  EXPECT_EQ(writeFilm(m_folder / "s.gif", tinyShot(), format, {}, progress), 12);
  EXPECT_EQ(decode(m_folder / "s.gif").luma.size(), 12U);
}

TEST_F(Video, ACancelledVideoLeavesNoFile) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress({}, stop.get_token());
  for (const char* name : {"c.mp4", "c.webm", "c.gif", "c{frame}.png"})
    EXPECT_THROW(writeFilm(m_folder / name, tinyShot(), {.width = 64, .height = 48}, {}, progress),
                 CancelledError);
  EXPECT_TRUE(fs::is_empty(m_folder));
}

}  // namespace
}  // namespace marey::render
