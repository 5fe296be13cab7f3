// What tests of files share: a folder that goes away, text of errors, and Python as the judge.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

namespace marey::test {

class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "marey-test-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    m_path = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return m_path; }
  std::filesystem::path operator/(const std::string& name) const { return m_path / name; }
  /// Names of everything in it, also of leftovers.
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(m_path))
      out.push_back(entry.path().lexically_relative(m_path).string());
    return out;
  }

 private:
  std::filesystem::path m_path;
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The message of the exception of type E that `f` throws; fails when it throws none or another.
template <typename E, typename F>
std::string messageOf(F&& f) {
  try {
    std::forward<F>(f)();
  } catch (const E& e) {
    return e.what();
  } catch (const std::exception& e) {
    ADD_FAILURE() << "an exception of another type: " << e.what();
    return {};
  }
  ADD_FAILURE() << "no exception";
  return {};
}

/// Debian's Python, the one that its python3-numpy and python3-torch belong to.
inline bool runPython(const std::filesystem::path& folder, const std::string& script) {
  const auto file = folder / "script.py";
  std::ofstream(file) << script;
  const std::string command =
      "cd '" + folder.string() + "' && /usr/bin/python3 script.py > python.log 2>&1";
  return std::system(command.c_str()) == 0;
}

inline bool hasPythonModule(const std::string& module) {
  // Found, not imported: importing torch takes seconds.
  const std::string script =
      "import importlib.util as u, sys; sys.exit(u.find_spec(\"" + module + "\") is None)";
  return std::system(("/usr/bin/python3 -c '" + script + "' > /dev/null 2>&1").c_str()) == 0;
}

}  // namespace marey::test

/// Needs a Python module as the independent judge: fails without it under CI, else skips.
#define MAREY_NEED_PYTHON(module)                                                      \
  if (!marey::test::hasPythonModule(module)) {                                         \
    if (std::getenv("CI") != nullptr) FAIL() << "python3-" module " is not installed"; \
    GTEST_SKIP() << "python3-" module " is not installed";                             \
  }
