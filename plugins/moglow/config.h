// Hyper-parameters of MoGlow (Henter et al. 2020, Sec. 4; design of the two published settings).
#pragma once

#include <string>

#include "base/json.h"
#include "nn/flow/flow_spec.h"

namespace marey::moglow {

struct Config {
  int poseDim = 63;
  int controlDim = 3;
  int tau = 10;       ///< past frames of pose and control
  int lookahead = 0;  ///< future frames of control
  int steps = 16;     ///< K
  int hidden = 512;
  int layers = 2;
  std::string cell = "lstm";  ///< lstm, gru, feedforward
  bool lu = true;
  std::string base = "normal";       ///< normal, student_t
  double df = 0.0;                   ///< degrees of freedom of the Student-t base
  double dropout = 0.95;             ///< share of history frames hidden from the nets in training
  std::string start = "orthogonal";  ///< orthogonal, whitening (data-dependent), reversal
  std::string poseBase = "none";     ///< none, linear, kinematic ('MG+')
  int baseOrder = 3;                 ///< past frames of the linear base
  /// Ridge strength. linear: relative to the mean square of the inputs; kinematic: as the variance
  /// of noise on every input, in cm^2 (a strong one keeps free-running motion stable).
  double baseRidge = 1e-4;
  /// Smallest innovation eigenvalue relative to the largest: keeps a fit to noiseless motion
  /// invertible. No floor of a likelihood where observationFloorMm says one.
  double baseFloor = 1e-4;
  // The kinematic base alone:
  int regimes = 64;               ///< clusters with a regression and covariance of their own
  double regimeShrinkage = 0.85;  ///< towards the common regression, cm^2 as baseRidge
  int footClusters = 200;         ///< clusters of a foot's movement that set its gate
  int netFeatures = 80;           ///< principal components of the history that the nets see
  int contacts = 4;               ///< feet and toes of the skeleton
  /// Which body densities expect. trained: with the mean bone lengths of the training data.
  /// history: with those that each frame's history shows, and of its size, so that another actor
  /// costs no more than moving otherwise. Samples keep the trained lengths always: those of their
  /// own past would drift.
  std::string boneLengths = "trained";

  /// Standard deviation of the noise through which poses are observed, in every direction of pose
  /// space; 0: none, as published. With it training adds noise to the poses that are to be
  /// foreseen, and a base is fitted twice: to observed poses, for densities, and to the motion
  /// itself, for samples, which hold no observation noise of the base.
  double observationFloorMm = 0.0;

  /// The feet's held coordinates stay as the base has them; the flow models the rest of the body
  /// given them. Keeps contacts as crisp in free-running motion as the base's.
  bool feetPassFlow = false;

  bool based() const { return poseBase != "none"; }
  /// Whether samples go through a base of their own ("motion" beside "base").
  bool hasMotionBase() const { return based() && observationFloorMm > 0.0; }
  /// Of the base that samples go through.
  Config ofMotionBase() const {
    Config out = *this;
    out.boneLengths = "trained";
    return out;
  }
  int passedChannels() const { return feetPassFlow ? contacts : 0; }  ///< two per foot
  int conditioning() const {
    if (poseBase == "kinematic")
      return netFeatures + 2 * contacts * (baseOrder - 1) + 3 * baseOrder + contacts +
             passedChannels();
    return tau * poseDim + (tau + 1 + lookahead) * controlDim;
  }
  nn::FlowSpec flow() const {
    return {.channels = poseDim - passedChannels(),
            .conditioning = conditioning(),
            .steps = steps,
            .lu = lu,
            .net = {.cell = cell, .hidden = hidden, .layers = layers}};
  }
  double degreesOfFreedom() const { return base == "student_t" ? df : 0.0; }
};

/// From the "model" object of Marey's configurations, the flat keys of conformance vectors, or
/// the authors' hparams (groups "Glow" and "Data"). Throws InputError naming the key.
Config configFromJson(const Json& value, const std::string& origin);
Json toJson(const Config& config);

}  // namespace marey::moglow
