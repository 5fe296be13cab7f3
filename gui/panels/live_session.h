// Steered motions of several models, made on a thread of their own at the models' rate.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "shell/motions.h"

#include "experiment/live_rollout.h"

namespace marey::gui {

struct LiveModel {
  std::string name;
  std::function<std::shared_ptr<const MotionModel>()> load;  ///< called on the session's thread
  double temperature = 1.0;
};

/// What has happened since the last asking.
struct LiveNews {
  std::vector<std::vector<std::vector<Vec3>>> frames;  ///< of every model, new ones
  std::vector<double> latencyMs;                       ///< one frame of all models together
  double heading = 0.0;                                ///< of the first model's root
  std::shared_ptr<const Skeleton> skeleton;            ///< null while models are loaded
  double fps = 0.0;
  std::string error;  ///< why the session has ended by itself
};

/// All models obey the same command. Frames do not wait for whoever shows them; where the models
/// are too slow for their rate, time is stretched and no frame is left out.
class LiveSession {
 public:
  LiveSession(std::vector<LiveModel> models, const LiveOptions& options);
  ~LiveSession();
  void setCommand(const LiveCommand& command);
  LiveNews take();
  /// Ends the thread after the frame it works on.
  void stop();
  /// After stop(); fewer than the models where loading failed.
  const std::vector<LiveRollout>& rollouts() const { return m_rollouts; }

 private:
  void run(const std::stop_token& stop);
  void prepare();
  double advanceAll();

  std::vector<LiveModel> m_models;
  LiveOptions m_options;
  std::vector<LiveRollout> m_rollouts;  ///< of the thread until it has ended
  std::mutex m_mutex;                   ///< over the two below
  LiveCommand m_command;
  LiveNews m_news;
  std::condition_variable_any m_wake;
  std::jthread m_thread;  // last: starts after the members it uses
};

/// A steered motion as a sample set, scored: `recipe` with the system and the path that was walked.
MotionGroup keptGroup(const LiveRollout& rollout, const ExperimentSystem& system,
                      SampleRecipe recipe, int colourIndex);

}  // namespace marey::gui
