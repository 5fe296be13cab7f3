// What the tests of the fixtures of text formats share.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "base/json.h"
#include "io/bvh.h"
#include "io/clip_io.h"
#include "io/doctor.h"
#include "motion/roles.h"

namespace marey::io::test_cases {

namespace fs = std::filesystem;
using test::expectContains;
using test::hasNote;
using test::inputErrorOf;
using test::with;

/// A file of tests/fixtures/NN-name.
inline fs::path fixture(const std::string& name) {
  return fs::path(MAREY_SOURCE_DIR) / "tests/fixtures" / name;
}

inline const Fault* find(const std::vector<Fault>& faults, const std::string& kind) {
  for (const Fault& fault : faults)
    if (fault.kind == kind) return &fault;
  return nullptr;
}

inline double largestDistance(const Clip& a, const Clip& b) {
  EXPECT_EQ(a.positions.size(), b.positions.size());
  double out = 0.0;
  for (size_t i = 0; i < std::min(a.positions.size(), b.positions.size()); ++i)
    out = std::max<double>(out, (a.positions[i] - b.positions[i]).norm());
  return out;
}

/// Rows frame,seconds,joint,x,y,z of a table with a header.
inline void expectPositions(const Clip& clip, const fs::path& table) {
  std::istringstream in(readFile(table));
  std::string line;
  std::getline(in, line);
  int rows = 0;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    int frame = 0;
    double seconds = 0.0;
    std::string joint;
    Vec3 p;
    ASSERT_TRUE(fields >> frame >> seconds >> joint >> p.x() >> p.y() >> p.z()) << line;
    const int j = clip.skeleton->find(joint);
    ASSERT_GE(j, 0) << joint;
    EXPECT_LT((clip.at(frame, j) - p).norm(), 1e-5f) << line;
    ++rows;
  }
  EXPECT_GT(rows, 60);
}

inline std::string bytesOf(const std::string& name) {
  return readFile(fixture(name));
}

}  // namespace marey::io::test_cases
