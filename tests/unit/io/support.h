// What the tests of motion files share.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "base/error.h"
#include "motion/clip.h"

namespace marey::test {

/// A folder of its own that vanishes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "marey-io-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    m_path = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return m_path / name; }
  const std::filesystem::path& path() const { return m_path; }

 private:
  std::filesystem::path m_path;
};

/// The message of the InputError that `action` throws; a failure when it throws none.
inline std::string inputErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  ADD_FAILURE() << "expected an InputError";
  return {};
}

inline void expectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

inline bool hasNote(const Clip& clip, const std::string& part) {
  for (const std::string& note : clip.source.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

/// Replaces the first occurrence.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A person of 10 joints that walks along +Z with swinging, turning joints; unit of length 1 m.
inline Clip smallPerson(int frames = 40, double fps = 30.0) {
  Skeleton s;
  s.names = {"Hips",     "LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg",
             "RightLeg", "RightFoot", "Spine",   "Head",     "LeftArm"};
  s.parents = {-1, 0, 1, 2, 0, 4, 5, 0, 7, 7};
  s.offsets = {Vec3(0, 0, 0),         Vec3(0.1f, 0, 0),  Vec3(0, -0.4f, 0),
               Vec3(0, -0.4f, 0.02f), Vec3(-0.1f, 0, 0), Vec3(0, -0.4f, 0),
               Vec3(0, -0.4f, 0.02f), Vec3(0, 0.3f, 0),  Vec3(0, 0.3f, 0.03f),
               Vec3(0.2f, 0.2f, 0)};
  s.endSites = {{3, Vec3(0, -0.05f, 0.15f)}, {8, Vec3(0, 0.2f, 0)}};
  Clip clip;
  clip.name = "person";
  clip.fps = fps;
  clip.transforms.emplace();
  for (int t = 0; t < frames; ++t)
    for (size_t j = 0; j < s.names.size(); ++j) {
      const float phase = 0.2f * static_cast<float>(t) + static_cast<float>(j);
      const Vec3 axis =
          Vec3(std::sin(1.0f + static_cast<float>(j)), std::cos(phase), 0.5f).normalized();
      clip.transforms->rotations.emplace_back(Eigen::AngleAxisf(0.8f * std::sin(phase), axis));
      clip.transforms->translations.push_back(
          j == 0 ? Vec3(0.05f * std::sin(phase), 0.9f, 0.04f * static_cast<float>(t))
                 : s.offsets[j]);
    }
  clip.skeleton = std::make_shared<const Skeleton>(std::move(s));
  return clip;
}

}  // namespace marey::test
