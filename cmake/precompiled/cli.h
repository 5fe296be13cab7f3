// For the command line; see MareyPrecompiled.cmake.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
