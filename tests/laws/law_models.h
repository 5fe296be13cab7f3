// The families that laws are about, and a small model of each.
#pragma once

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "model/gradient/build.h"

namespace marey::test::law {

/// Those of the list, and the toy.
std::vector<ModelFamily> allFamilies();
/// Those, and further models of one family that are systems of their own: the same family with
/// another example.
std::vector<ModelFamily> allSystems();
/// Of the example, as a name of tests: "rnn_small".
std::string systemName(const ModelFamily& family);

std::vector<Clip> walks(int count, double seconds, uint64_t seed);
/// Of the walker.
const DataSet& data();

/// Walks with a signal, "beat".
std::vector<Clip> walksWithBeat(int count, double seconds, uint64_t seed);
/// Of the walker, with control of every kind: "path" and "beat" may be left out, "type" (the
/// walker's style) and "body" may not.
const DataSet& controlledData();

/// The example of a family, trained for 20 steps where it is trained.
struct Made {
  TrainResult result;
  TensorFile file;
  std::vector<double> losses;  ///< of the log's rows
};
TrainRequest requestOf(const ModelFamily& family, const std::filesystem::path& run);
/// Made once.
const Made& madeBy(const ModelFamily& family);

}  // namespace marey::test::law
