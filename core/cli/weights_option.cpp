#include "cli/command.h"

namespace marey::cli {

void addWeightsOption(CLI::App& command, std::string& weights) {
  command
      .add_option("--weights", weights,
                  "float32, or bf16: half the memory and faster for few motions, results differ "
                  "slightly")
      ->check(CLI::IsMember({"float32", "bf16"}))
      ->capture_default_str();
}

WeightPrecision weightPrecisionNamed(const std::string& name) {
  return name == "bf16" ? WeightPrecision::BFloat16 : WeightPrecision::Float32;
}

}  // namespace marey::cli
