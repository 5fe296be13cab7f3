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

void addModelOptions(CLI::App& command, double& temperature, OptionValues& options) {
  command
      .add_option_function<std::vector<std::string>>(
          "--option",
          [&temperature, &options](const std::vector<std::string>& given) {
            for (const std::string& text : given) addOption(text, options);
            const auto found = options.find("temperature");
            if (found == options.end()) return;
            temperature = found->second;
            options.erase(found);
          },
          "What else the model takes (marey model info says what): NAME=VALUE, as often as needed")
      ->take_all();
}

WeightPrecision weightPrecisionNamed(const std::string& name) {
  return name == "bf16" ? WeightPrecision::BFloat16 : WeightPrecision::Float32;
}

}  // namespace marey::cli
