#include "experiment/steering/live_session.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.h"
#include "model/sampler.h"
#include "model/scorer.h"

namespace marey {
namespace {
constexpr std::chrono::milliseconds kReadPadEvery{5};
/// Axes of a pad: left stick, right stick.
constexpr size_t kAcross = 0, kDown = 1, kLook = 3;

/// Left stick: ahead and turn; right stick: where the body looks.
LiveCommand added(const LiveCommand& keys, const GamepadState& pad, const LiveCommand& full) {
  LiveCommand out = keys;
  out.forwardMS -= pad.axes[kDown] * full.forwardMS;
  out.turnRadS -= pad.axes[kAcross] * full.turnRadS;
  out.facingRad -= pad.axes[kLook] * full.facingRad;
  return out;
}
}  // namespace

LiveCommand obeyed(const ModelInfo& info, LiveCommand command) {
  const ControlChannel* types = channelOf(info.features.control, ControlKind::Label);
  if (!types) {
    command.type.clear();
    return command;
  }
  const auto& known = types->values;
  if (std::find(known.begin(), known.end(), command.type) == known.end())
    command.type = types->optional ? std::string() : known.front();
  return command;
}

LiveSession::LiveSession(std::vector<LiveModel> models, const LiveOptions& options,
                         std::vector<std::string> gamepads)
    : m_models(std::move(models)),
      m_options(options),
      m_gamepad(std::move(gamepads)),
      m_thread([this](const std::stop_token& stop) { run(stop); }) {}

LiveSession::~LiveSession() {
  stop();
}

void LiveSession::stop() {
  requestStop();
  const std::lock_guard lock(m_joining);
  if (m_thread.joinable()) m_thread.join();
}

void LiveSession::setCommand(const LiveCommand& command, const LiveCommand& fullDeflection) {
  const std::lock_guard lock(m_mutex);
  if (command != m_command && !m_commandAt) m_commandAt = LiveClock::now();
  m_command = command;
  m_fullDeflection = fullDeflection;
}

void LiveSession::readGamepad() {
  const GamepadState& state = m_gamepad.poll();
  const std::lock_guard lock(m_mutex);
  if (state == m_pad) return;
  if (state.axes != m_pad.axes && !m_commandAt) m_commandAt = LiveClock::now();
  m_pad = state;
  m_news.gamepad = state.connected;
}

LiveNews LiveSession::take() {
  const std::lock_guard lock(m_mutex);
  LiveNews out = m_news;
  for (LiveModelNews& model : m_news.models) {
    model.frames.clear();
    model.frameMs.clear();
  }
  m_news.commandAt.reset();
  return out;
}

/// False where it was asked to stop.
bool LiveSession::prepare(const std::stop_token& stop) {
  for (const LiveModel& model : m_models) {
    if (stop.stop_requested()) return false;
    LiveOptions options = m_options;
    options.temperature = model.temperature;
    options.options = model.options;
    const auto loaded = model.load();
    options.begin = obeyed(loaded->info(), options.begin);
    m_rollouts.emplace_back(loaded, options);
    const ModelInfo& first = m_rollouts.front().model().info();
    const ModelInfo& info = m_rollouts.back().model().info();
    if (info.features.fps != first.features.fps)
      throwInput({.path = model.name}, fmt::format("models at {} fps", first.features.fps), "{}",
                 info.features.fps);
  }
  if (m_rollouts.empty()) throw InputError({.path = "live"}, "a model", "none");
  const std::lock_guard lock(m_mutex);
  for (const LiveRollout& rollout : m_rollouts)
    m_news.models.push_back(
        {.frames = {}, .frameMs = {}, .skeleton = rollout.model().info().skeleton});
  std::set<std::string> types;
  for (const LiveRollout& rollout : m_rollouts)
    if (const auto* channel =
            channelOf(rollout.model().info().features.control, ControlKind::Label))
      types.insert(channel->values.begin(), channel->values.end());
  m_news.types.assign(types.begin(), types.end());
  m_news.fps = m_rollouts.front().model().info().features.fps;
  return true;
}

/// One frame of every model.
void LiveSession::advanceAll() {
  LiveCommand command;
  std::optional<LiveClock::time_point> commandAt;
  {
    const std::lock_guard lock(m_mutex);
    command = added(m_command, m_pad, m_fullDeflection);
    commandAt = std::exchange(m_commandAt, std::nullopt);
  }
  std::vector<std::vector<Vec3>> frames;
  std::vector<double> ms;
  for (LiveRollout& rollout : m_rollouts) {
    const auto begin = LiveClock::now();
    frames.push_back(rollout.advance(obeyed(rollout.model().info(), command)));
    ms.push_back(std::chrono::duration<double, std::milli>(LiveClock::now() - begin).count());
  }
  const auto now = LiveClock::now();
  m_made.push_back(now);
  std::erase_if(m_made, [now](const auto& t) { return now - t > std::chrono::seconds(1); });
  const std::lock_guard lock(m_mutex);
  for (size_t i = 0; i < frames.size(); ++i) {
    m_news.models[i].frames.push_back(std::move(frames[i]));
    m_news.models[i].frameMs.push_back(ms[i]);
  }
  if (!m_news.commandAt) m_news.commandAt = commandAt;
  const std::chrono::duration<double> span = now - m_made.front();
  m_news.madePerS =
      span.count() > 0.0 ? static_cast<double>(m_made.size() - 1) / span.count() : 0.0;
  m_news.heading = m_rollouts.front().root().heading;
}

void LiveSession::run(const std::stop_token& stop) {
  try {
    if (prepare(stop)) {
      const auto period = std::chrono::duration_cast<LiveClock::duration>(
          std::chrono::duration<double>(1.0 / m_rollouts.front().model().info().features.fps));
      auto next = LiveClock::now();
      while (!stop.stop_requested()) {
        readGamepad();
        advanceAll();
        next = std::max(next + period, LiveClock::now());
        while (!stop.stop_requested() && LiveClock::now() < next) {
          std::mutex none;
          std::unique_lock lock(none);
          m_wake.wait_until(lock, stop, std::min(next, LiveClock::now() + kReadPadEvery),
                            [] { return false; });
          readGamepad();
        }
      }
    }
  } catch (const std::exception& error) {
    const std::lock_guard lock(m_mutex);
    m_news.error = error.what();
  }
  m_ended = true;
}

MotionGroup keptGroup(const LiveRollout& rollout, const ExperimentSystem& system,
                      SampleRecipe recipe, int colourIndex) {
  const FeatureSequence sequence = rollout.sequence();
  Progress progress;
  const Motion motion{std::make_shared<const Clip>(sampledClip(rollout.model(), sequence)),
                      scoreSequences(rollout.model(), {&sequence, 1}, false, progress).front(),
                      true};
  recipe.system = system;
  recipe.steering = std::make_shared<const Steering>(rollout.steering());
  recipe.path = {.name = "steered", .path = {}, .wayPoints = rollout.walkedPath(), .seconds = 0};
  return {.name = system.name + " – steered",
          .system = system.name,
          .colourIndex = colourIndex,
          .pinned = true,
          .recipe = recipe,
          .modelHash = rollout.model().info().hash,
          .wanted = rollout.trajectory(),
          .motions = {motion}};
}

}  // namespace marey
