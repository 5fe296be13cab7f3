// A gamepad by the joystick interface of Linux, read without waiting. No Qt.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <vector>

namespace marey {

struct GamepadState {
  bool connected = false;
  /// -1 to 1 in the order of the device: left stick across and down, then (of most pads) the left
  /// trigger and the right stick across and down. Small deflections are 0.
  std::array<double, 8> axes{};
  bool operator==(const GamepadState&) const = default;
};

/// Pads may come and go at any time: a device that is gone is looked for again once a second.
class Gamepad {
 public:
  /// The first of `devices` that can be opened; empty: /dev/input/js0 to js7.
  explicit Gamepad(std::vector<std::string> devices = {});
  ~Gamepad();
  Gamepad(const Gamepad&) = delete;
  Gamepad& operator=(const Gamepad&) = delete;

  /// Takes all events that have come; never waits. From one thread.
  const GamepadState& poll();

 private:
  void lookFor();
  void lose();

  std::vector<std::string> m_devices;
  int m_file = -1;
  std::chrono::steady_clock::time_point m_looked{};
  std::array<char, 8> m_part{};  ///< of an event that has not come whole
  size_t m_partSize = 0;
  GamepadState m_state;
};

}  // namespace marey
