// Steered motions of several models, made on a thread of their own at the models' rate.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "task/live_rollout.h"

#include "experiment/motions.h"
#include "experiment/steering/gamepad.h"

namespace marey {

using LiveClock = std::chrono::steady_clock;

struct LiveModel {
  std::string name;
  std::function<std::shared_ptr<const MotionModel>()> load;  ///< called on the session's thread
  double temperature = 1.0;
  OptionValues options = {};
};

/// What has happened to one model since the last asking.
struct LiveModelNews {
  std::vector<std::vector<Vec3>> frames;     ///< new ones
  std::vector<double> frameMs;               ///< what each of them took
  std::shared_ptr<const Skeleton> skeleton;  ///< null while models are loaded
};

struct LiveNews {
  std::vector<LiveModelNews> models;
  /// When the oldest change of the command came that these frames are the first to obey.
  std::optional<LiveClock::time_point> commandAt;
  double heading = 0.0;            ///< of the first model's root
  double fps = 0.0;                ///< of all models
  std::vector<std::string> types;  ///< that a model knows, once they are loaded
  double madePerS = 0.0;           ///< frames that were really made, over the last second
  bool gamepad = false;            ///< one is connected
  std::string error;               ///< why the session has ended by itself
};

/// The command as a model can obey it: with a type that it knows, which is its first one where the
/// command names none that it knows and it cannot go without.
LiveCommand obeyed(const ModelInfo& info, LiveCommand command);

/// All models obey the same command. Frames do not wait for whoever shows them; where the models
/// are too slow for their rate, time is stretched and no frame is left out.
class LiveSession {
 public:
  /// `gamepads`: see Gamepad.
  LiveSession(std::vector<LiveModel> models, const LiveOptions& options,
              std::vector<std::string> gamepads = {});
  ~LiveSession();
  /// The command of keys, and what full deflections of a gamepad add to it.
  void setCommand(const LiveCommand& command, const LiveCommand& fullDeflection);
  LiveNews take();
  /// Asks the thread to end after the frame, or the model's loading, that it works on.
  void requestStop() { m_thread.request_stop(); }
  /// The same, and waits for it; from any thread.
  void stop();
  bool ended() const { return m_ended; }
  /// After stop(); fewer than the models where loading failed.
  const std::vector<LiveRollout>& rollouts() const { return m_rollouts; }

 private:
  void run(const std::stop_token& stop);
  bool prepare(const std::stop_token& stop);
  void advanceAll();
  void readGamepad();

  std::vector<LiveModel> m_models;
  LiveOptions m_options;
  std::vector<LiveRollout> m_rollouts;  ///< of the thread until it has ended
  Gamepad m_gamepad;                    ///< of the thread
  std::vector<LiveClock::time_point> m_made;
  std::atomic<bool> m_ended = false;
  std::mutex m_joining;
  std::mutex m_mutex;  ///< over those below
  LiveCommand m_command, m_fullDeflection;
  GamepadState m_pad;
  std::optional<LiveClock::time_point> m_commandAt;
  LiveNews m_news;
  std::condition_variable_any m_wake;
  std::jthread m_thread;  // last: starts after the members it uses
};

/// A steered motion as a sample set, scored; its recipe gives the same motion again.
MotionGroup keptGroup(const LiveRollout& rollout, const ExperimentSystem& system,
                      SampleRecipe recipe, int colourIndex);

}  // namespace marey
