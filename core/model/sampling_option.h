// What a sampling of a model takes beside its control. A family declares it as data: the command
// line checks it, the window draws a form of it, documents keep what was chosen.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/json.h"

namespace marey {

/// A factor on some values of every latent.
struct SamplingOption {
  enum class Kind {
    Number,  ///< from `low` to `high`
    Switch   ///< 0 (off) or 1 (on)
  };

  std::string name;   ///< as on the command line and in documents
  std::string title;  ///< for people
  std::string unit;   ///< empty: none
  std::string about;  ///< one sentence
  Kind kind = Kind::Number;
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  double fallback = 1.0;  ///< what holds where nothing is said
  int first = 0;          ///< of the latent's values
  int count = 0;

  bool operator==(const SamplingOption&) const = default;
};

/// By name; options that are not there have their fallback.
using OptionValues = std::map<std::string, double>;

/// "temperature": a factor on all `width` values.
SamplingOption temperatureOption(int width);

/// "temperature (0 or more, 1 unless given)".
std::string textOf(const SamplingOption& option);
Json toJson(const SamplingOption& option);

/// The value of one. Throws InputError naming `origin` and the option where it is not in the schema
/// (the options that there are stand in the message) or out of range.
void requireOption(const std::vector<SamplingOption>& schema, const std::string& name, double value,
                   const std::string& origin);
void requireOptions(const std::vector<SamplingOption>& schema, const OptionValues& values,
                    const std::string& origin);

/// Scales a drawn latent as the values say.
void applyOptions(const std::vector<SamplingOption>& schema, const OptionValues& values,
                  float* latent);

/// "decoder_noise 0, style 0.5".
std::string textOf(const OptionValues& values);
/// "name=value" -> adds to `values`; on and off are 1 and 0. Throws UsageError.
void addOption(const std::string& text, OptionValues& values);

}  // namespace marey
