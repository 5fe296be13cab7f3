#include "gui/time/playback.h"

#include <algorithm>
#include <cmath>

namespace marey::gui {
namespace {
constexpr int kTickMs = 15;  ///< faster than screens show
}  // namespace

Playback::Playback(Workspace& workspace, QObject* parent)
    : QObject(parent), m_workspace(workspace) {
  m_tick.setInterval(kTickMs);
  m_tick.setTimerType(Qt::PreciseTimer);
  connect(&m_tick, &QTimer::timeout, this, &Playback::advance);
  // Scrubbing while it plays goes on from there.
  connect(&workspace.view(), &View::timeChanged, this, [this] {
    if (!m_setting) rebase();
  });
  connect(&workspace.motions(), &MotionGroups::visibilityChanged, this, [this] {
    if (m_workspace.motions().duration() <= 0.0) setPlaying(false);
  });
}

TimeRange Playback::bounds() const {
  const double end = m_workspace.motions().duration();
  const auto& range = m_workspace.view().range();
  if (!range) return {0.0, end};
  const double begin = std::clamp(range->beginS, 0.0, end);
  return {begin, std::clamp(range->endS, begin, end)};
}

void Playback::rebase() {
  m_from = m_workspace.view().time();
  m_clock.start();
}

void Playback::setPlaying(bool playing) {
  if (playing == this->playing()) return;
  const TimeRange all = bounds();
  if (playing && all.endS <= all.beginS) return;
  if (playing) {
    const double now = m_workspace.view().time();
    if (now >= all.endS - 1e-6 || now < all.beginS) m_workspace.view().setTime(all.beginS);
    rebase();
    m_tick.start();
  } else {
    m_tick.stop();
  }
  Q_EMIT playingChanged(playing);
}

void Playback::setSpeed(double factor) {
  rebase();
  m_speed = factor;
}

void Playback::goTo(double seconds) {
  m_workspace.view().setTime(seconds);
}

void Playback::step(int frames) {
  setPlaying(false);
  const double fps = m_workspace.document().experiment().fps;
  // From the frame that is shown, so that steps meet frames exactly.
  const double frame = std::round(m_workspace.view().time() * fps) + frames;
  goTo(std::clamp(frame / fps, 0.0, m_workspace.motions().duration()));
}

void Playback::advance() {
  const TimeRange all = bounds();
  const double length = all.endS - all.beginS;
  double now = m_from + m_speed * static_cast<double>(m_clock.nsecsElapsed()) * 1e-9;
  const bool over = now >= all.endS;
  if (over && m_loop && length > 0.0) now = all.beginS + std::fmod(now - all.beginS, length);
  m_setting = true;
  m_workspace.view().setTime(std::min(now, all.endS));
  m_setting = false;
  if (over && (!m_loop || length <= 0.0)) setPlaying(false);
}

}  // namespace marey::gui
