#include "pickle/state_dicts.h"

#include <algorithm>
#include <array>

#include "base/error.h"

namespace marey {
namespace {

/// What wrappers of PyTorch and its trainers put before the names of a network, and what people
/// call the network within another module.
constexpr std::array kWrappers = std::to_array<std::string_view>(
    {"module", "_orig_mod", "_forward_module", "_fsdp_wrapped_module", "_module", "model", "_model",
     "net", "_net", "network", "graph", "glow", "generator", "student"});

/// Dictionaries whose tensors have the names of weights and are none.
constexpr std::array kTrainingState = std::to_array<std::string_view>(
    {"optim", "opt_", "adam", "exp_avg", "momentum_buffer", "moments", "grad", "sched", "scaler"});

struct Key {
  std::string folder, prefix, own;  ///< prefix without its last '.'

  std::string set() const {
    if (folder.empty() && prefix.empty()) return ".";
    return folder + (folder.empty() || prefix.empty() ? "" : "/") + prefix;
  }
};

Key split(const std::string& path, const OwnNameStart& ownName) {
  const size_t slash = path.rfind('/');
  Key out{.folder = slash == std::string::npos ? "" : path.substr(0, slash),
          .prefix = {},
          .own = slash == std::string::npos ? path : path.substr(slash + 1)};
  const size_t start = ownName(out.own);
  if (start == std::string_view::npos) {
    out.own.clear();
    return out;
  }
  if (start > 0) out.prefix = out.own.substr(0, start - 1);
  out.own.erase(0, start);
  return out;
}

bool isTrainingState(std::string folder) {
  std::transform(folder.begin(), folder.end(), folder.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  for (size_t begin = 0; begin < folder.size();) {
    const size_t end = std::min(folder.find('/', begin), folder.size());
    const std::string_view part = std::string_view(folder).substr(begin, end - begin);
    if (part == "opt" || std::any_of(kTrainingState.begin(), kTrainingState.end(),
                                     [&](std::string_view name) { return part.starts_with(name); }))
      return true;
    begin = end + 1;
  }
  return false;
}

bool isWrapped(const std::string& prefix) {
  for (size_t begin = 0; begin < prefix.size();) {
    const size_t end = std::min(prefix.find('.', begin), prefix.size());
    if (std::find(kWrappers.begin(), kWrappers.end(), prefix.substr(begin, end - begin)) ==
        kWrappers.end())
      return false;
    begin = end + 1;
  }
  return true;
}

struct Candidate {
  std::string folder;
  bool known = true;  ///< its prefix is that of wrappers
  std::string firstPath;
  std::map<std::string, std::string> paths;  ///< by own name
};
using Candidates = std::map<std::string, Candidate>;

Candidates candidatesIn(const TorchCheckpoint& checkpoint, const OwnNameStart& ownName) {
  Candidates out;
  for (const auto& [path, tensor] : checkpoint.tensors) {
    const Key key = split(path, ownName);
    if (key.own.empty() || isTrainingState(key.folder)) continue;
    Candidate& candidate = out[key.set()];
    if (candidate.paths.empty()) {
      candidate.folder = key.folder;
      candidate.known = isWrapped(key.prefix);
      candidate.firstPath = path;
    }
    candidate.paths.emplace(key.own, path);
  }
  return out;
}

std::string namesOf(const Candidates& candidates) {
  std::string out;
  for (const auto& [name, candidate] : candidates) out += (out.empty() ? "" : ", ") + name;
  return out;
}

bool sameTensors(const Candidate& a, const Candidate& b, const TorchCheckpoint& checkpoint) {
  if (a.paths.size() != b.paths.size()) return false;
  return std::all_of(a.paths.begin(), a.paths.end(), [&](const auto& item) {
    const auto other = b.paths.find(item.first);
    if (other == b.paths.end()) return false;
    const Tensor &x = checkpoint.tensors.at(item.second), &y = checkpoint.tensors.at(other->second);
    return x.dtype == y.dtype && x.shape == y.shape && x.bytes == y.bytes;
  });
}

/// The candidate that a user names: itself, or the dictionary that only it lies in.
Candidates::const_iterator named(const Candidates& candidates, const std::string& wanted,
                                 const std::string& origin) {
  if (const auto found = candidates.find(wanted); found != candidates.end()) return found;
  auto out = candidates.end();
  int matches = 0;
  for (auto it = candidates.begin(); it != candidates.end(); ++it)
    if (it->second.folder == wanted) {
      out = it;
      ++matches;
    }
  if (matches != 1)
    throw InputError({.path = origin}, "--state-dict to name one of " + namesOf(candidates),
                     "'" + wanted + "'");
  return out;
}

Candidates::const_iterator chosen(const Candidates& candidates, const TorchCheckpoint& checkpoint,
                                  const std::string& example, const std::string& wanted,
                                  const std::string& origin) {
  if (candidates.empty()) {
    std::string found = "no tensor";
    if (!checkpoint.skipped.empty()) found = "'" + checkpoint.skipped.front() + "'";
    throw InputError({.path = origin}, "tensors with names like '" + example + "'", found);
  }
  if (!wanted.empty()) return named(candidates, wanted, origin);
  std::vector<Candidates::const_iterator> known;
  for (auto it = candidates.begin(); it != candidates.end(); ++it)
    if (it->second.known) known.push_back(it);
  if (known.empty()) {
    const auto& [name, candidate] = *candidates.begin();
    throw InputError({.path = origin},
                     "tensors with names like '" + example + "', or --state-dict NAME",
                     fmt::format("'{}', whose prefix is not known (state dicts: {})",
                                 candidate.firstPath, namesOf(candidates)));
  }
  const bool same = std::all_of(known.begin(), known.end(), [&](const auto& it) {
    return sameTensors(it->second, known.front()->second, checkpoint);
  });
  if (known.size() == candidates.size() && same) return known.front();
  if (candidates.size() > 1) {
    static constexpr const char* kNumbers[] = {"no",   "one", "two",   "three", "four",
                                               "five", "six", "seven", "eight", "nine"};
    const size_t n = candidates.size();
    throw InputError({.path = origin}, "one state dict, or --state-dict NAME to choose one",
                     fmt::format("{} state dicts: {}; choose one",
                                 n < 10 ? kNumbers[n] : std::to_string(n), namesOf(candidates)));
  }
  return known.front();
}

/// The tensors that are not of the chosen one, by the dictionary they lie in.
std::vector<std::string> leftOutOf(const TorchCheckpoint& checkpoint, const Candidate& taken) {
  std::map<std::string, std::vector<std::string>> groups;
  const auto add = [&](const std::string& path) {
    const size_t slash = path.find('/');
    groups[slash == std::string::npos ? path : path.substr(0, slash)].push_back(path);
  };
  std::map<std::string, int> used;
  for (const auto& [own, path] : taken.paths) used[path] = 1;
  for (const auto& [path, tensor] : checkpoint.tensors)
    if (!used.contains(path)) add(path);
  for (const std::string& path : checkpoint.skipped) add(path);
  std::vector<std::string> out;
  for (const auto& [name, paths] : groups)
    out.push_back(paths.size() == 1 ? paths.front()
                                    : fmt::format("{} ({} tensors)", name, paths.size()));
  return out;
}

}  // namespace

StateDict chooseStateDict(TorchCheckpoint checkpoint, const OwnNameStart& ownName,
                          const std::string& example, const std::string& wanted,
                          const std::string& origin) {
  const Candidates candidates = candidatesIn(checkpoint, ownName);
  const auto& [name, candidate] = *chosen(candidates, checkpoint, example, wanted, origin);
  StateDict out{.name = name, .tensors = {}, .leftOut = leftOutOf(checkpoint, candidate)};
  for (const auto& [own, path] : candidate.paths)
    out.tensors.emplace(own, std::move(checkpoint.tensors.at(path)));
  return out;
}

TorchTensorFilter stateDictFilter(const OwnNameStart& ownName) {
  return [ownName](const std::string& path) {
    const size_t slash = path.rfind('/');
    const std::string_view key =
        std::string_view(path).substr(slash == std::string::npos ? 0 : slash + 1);
    return ownName(key) != std::string_view::npos;
  };
}

}  // namespace marey
