#include "panels/live_session.h"

#include <chrono>

#include "base/error.h"
#include "model/sampler.h"
#include "model/scorer.h"

namespace marey::gui {
namespace {
using Clock = std::chrono::steady_clock;
}

LiveSession::LiveSession(std::vector<LiveModel> models, const LiveOptions& options)
    : m_models(std::move(models)),
      m_options(options),
      m_thread([this](const std::stop_token& stop) { run(stop); }) {}

LiveSession::~LiveSession() {
  stop();
}

void LiveSession::stop() {
  m_thread.request_stop();
  if (m_thread.joinable()) m_thread.join();
}

void LiveSession::setCommand(const LiveCommand& command) {
  const std::lock_guard lock(m_mutex);
  m_command = command;
}

LiveNews LiveSession::take() {
  const std::lock_guard lock(m_mutex);
  LiveNews out = std::move(m_news);
  m_news = {.frames = {},
            .latencyMs = {},
            .heading = out.heading,
            .skeleton = out.skeleton,
            .fps = out.fps,
            .error = out.error};
  m_news.frames.resize(out.frames.size());
  return out;
}

void LiveSession::prepare() {
  for (const LiveModel& model : m_models) {
    LiveOptions options = m_options;
    options.temperature = model.temperature;
    m_rollouts.emplace_back(model.load(), options);
    const ModelInfo& first = m_rollouts.front().model().info();
    const ModelInfo& info = m_rollouts.back().model().info();
    if (info.features.fps != first.features.fps)
      throwInput({.path = model.name}, fmt::format("models at {} fps", first.features.fps), "{}",
                 info.features.fps);
  }
  if (m_rollouts.empty()) throw InputError({.path = "live"}, "a model", "none");
  const std::lock_guard lock(m_mutex);
  m_news.frames.resize(m_rollouts.size());
  m_news.skeleton = m_rollouts.front().model().info().skeleton;
  m_news.fps = m_rollouts.front().model().info().features.fps;
}

/// One frame of every model; returns the milliseconds it took.
double LiveSession::advanceAll() {
  LiveCommand command;
  {
    const std::lock_guard lock(m_mutex);
    command = m_command;
  }
  const auto begin = Clock::now();
  std::vector<std::vector<Vec3>> frames;
  for (LiveRollout& rollout : m_rollouts) frames.push_back(rollout.advance(command));
  const double ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  const std::lock_guard lock(m_mutex);
  for (size_t i = 0; i < frames.size(); ++i) m_news.frames[i].push_back(std::move(frames[i]));
  m_news.latencyMs.push_back(ms);
  m_news.heading = m_rollouts.front().root().heading;
  return ms;
}

void LiveSession::run(const std::stop_token& stop) {
  try {
    prepare();
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / m_rollouts.front().model().info().features.fps));
    auto next = Clock::now();
    while (!stop.stop_requested()) {
      advanceAll();
      next = std::max(next + period, Clock::now());
      std::mutex none;
      std::unique_lock lock(none);
      m_wake.wait_until(lock, stop, next, [] { return false; });
    }
  } catch (const std::exception& error) {
    const std::lock_guard lock(m_mutex);
    m_news.error = error.what();
  }
}

MotionGroup keptGroup(const LiveRollout& rollout, const ExperimentSystem& system,
                      SampleRecipe recipe, int colourIndex) {
  const FeatureSequence sequence = rollout.sequence();
  Motion motion{std::make_shared<const Clip>(sampledClip(rollout.model(), sequence)), {}, true};
  if (sequence.frameCount() > rollout.model().info().context)
    motion.score = scoreSequence(rollout.model(), sequence);
  recipe.system = system;
  recipe.path = {.name = "steered", .path = {}, .wayPoints = rollout.walkedPath(), .seconds = 0};
  return {.name = system.name + " – steered",
          .system = system.name,
          .colourIndex = colourIndex,
          .pinned = true,
          .recipe = recipe,
          .modelHash = rollout.model().info().hash,
          .wanted = trajectoryFromControl(sequence.control, sequence.start),
          .motions = {motion}};
}

}  // namespace marey::gui
