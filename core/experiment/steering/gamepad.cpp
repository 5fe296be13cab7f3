#include "experiment/steering/gamepad.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <fcntl.h>
#include <linux/joystick.h>
#include <unistd.h>

namespace marey {
namespace {
constexpr std::chrono::seconds kLookEvery{1};
constexpr double kFull = 32767.0, kDead = 0.12;

double deflection(int raw) {
  const double value = std::clamp(raw / kFull, -1.0, 1.0);
  if (std::abs(value) < kDead) return 0.0;
  // From 0 at the edge of the dead zone, so that nothing jumps there.
  return std::copysign((std::abs(value) - kDead) / (1.0 - kDead), value);
}
}  // namespace

Gamepad::Gamepad(std::vector<std::string> devices) : m_devices(std::move(devices)) {
  if (!m_devices.empty()) return;
  for (int i = 0; i < 8; ++i) m_devices.push_back("/dev/input/js" + std::to_string(i));
}

Gamepad::~Gamepad() {
  if (m_file >= 0) close(m_file);
}

void Gamepad::lookFor() {
  const auto now = std::chrono::steady_clock::now();
  if (m_looked.time_since_epoch().count() != 0 && now - m_looked < kLookEvery) return;
  m_looked = now;
  for (const std::string& device : m_devices) {
    m_file = open(device.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (m_file < 0) continue;
    m_state = {.connected = true};
    return;
  }
}

void Gamepad::lose() {
  close(m_file);
  m_file = -1;
  m_partSize = 0;
  m_state = {};  // a pad that is pulled out lets go of everything
}

const GamepadState& Gamepad::poll() {
  if (m_file < 0) lookFor();
  while (m_file >= 0) {
    const ssize_t got = read(m_file, m_part.data() + m_partSize, sizeof(js_event) - m_partSize);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno != EAGAIN) lose();
    if (got <= 0) break;
    m_partSize += static_cast<size_t>(got);
    if (m_partSize < sizeof(js_event)) continue;
    m_partSize = 0;
    js_event event{};
    std::memcpy(&event, m_part.data(), sizeof(event));
    const bool axis = (event.type & ~JS_EVENT_INIT) == JS_EVENT_AXIS;
    if (axis && event.number < m_state.axes.size())
      m_state.axes[event.number] = deflection(event.value);
  }
  return m_state;
}

}  // namespace marey
