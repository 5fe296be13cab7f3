// The fit of the kinematic base: closed forms and k-means, in float64 where sums are long.
#include <algorithm>
#include <numbers>

#include <ATen/CPUGeneratorImpl.h>

#include "base/random.h"
#include "moglow/kinematic_base.h"

namespace marey::moglow {
namespace {

constexpr int64_t kChunk = 32768;        ///< rows at a time: bounds the memory
constexpr int64_t kClusterRows = 40000;  ///< rows that k-means looks at
constexpr int kClusterRounds = 40;
constexpr double kSlack = 0.01;      ///< cm that a leg may err over a resting foot
constexpr double kSteadiest = 0.05;  ///< smallest scale of a leg's errors, relative to the foot's
constexpr double kFarthest = 3.0;    ///< normal values of feet and knees that set their spread
constexpr double kLowest = 0.005;    ///< share of frames in which a foot is lower than its floor
constexpr double kSlowest = 0.1;    ///< share of frames in which a foot is slower than slow by half
constexpr double kReached = 0.995;  ///< share of frames in which a leg reaches less far
constexpr double kSmallestStep = 0.02;  ///< between radial quantiles, in units of the scale
constexpr uint64_t kNoiseSeed = 20;     ///< of the noise through which poses are seen
constexpr int64_t kFewestMoves = 60;    ///< of a cluster of its own gate
constexpr double kPriorFrames = 200.0;  ///< weight of the common covariance in a regime's

/// Lloyd's k-means from a fixed random choice of rows.
torch::Tensor clusterCentres(const torch::Tensor& features, int64_t count) {
  std::vector<int64_t> rows;
  const int64_t total = features.size(0);
  for (int64_t i = 0; i < std::min(kClusterRows, total); ++i)
    rows.push_back(std::min(
        total - 1,
        static_cast<int64_t>(uniformAt({.stage = RandomStage::Weights}, static_cast<uint32_t>(i)) *
                             static_cast<double>(total))));
  const auto sample = features.index_select(0, torch::tensor(rows).to(features.device()));
  auto centres = sample.narrow(0, 0, std::min<int64_t>(count, sample.size(0))).clone();
  for (int round = 0; round < kClusterRounds; ++round) {
    const auto nearest = std::get<1>(torch::cdist(sample, centres).min(1));
    auto sums = torch::zeros_like(centres).index_add_(0, nearest, sample);
    const auto counts =
        torch::zeros({centres.size(0)}, centres.options())
            .index_add_(0, nearest, torch::ones({sample.size(0)}, centres.options()));
    centres =
        torch::where(counts.gt(0).unsqueeze(1), sums / counts.clamp_min(1.0).unsqueeze(1), centres);
  }
  if (centres.size(0) == count) return centres;
  return torch::cat({centres, centres.narrow(0, 0, 1).expand({count - centres.size(0), -1})}, 0);
}

/// What feet did, one row per foot and frame: chart coordinates [N, 3], where the rest of the body
/// foresees them [N, 2], and scales [N]; cm.
struct FootMoves {
  torch::Tensor now, before, way, foreseen, scale;
  FootMoves at(const torch::Tensor& rows) const {
    const auto pick = [&](const torch::Tensor& t) { return t.index_select(0, rows); };
    return {pick(now), pick(before), pick(way), pick(foreseen), pick(scale)};
  }
};

/// One foot's frames after the other's, from [N, feet, ...].
torch::Tensor footByFoot(const torch::Tensor& t) {
  return t.transpose(0, 1).flatten(0, 1);
}

torch::Tensor offsets(const FootMoves& moves, double hold) {
  return moves.now.narrow(-1, 0, 2) -
         gateCentre(torch::full_like(moves.scale, hold), moves.foreseen, moves.before);
}

/// How far feet are held to their last place: the centre that makes the mean log distance
/// smallest. It is robust and drawn to sharp peaks.
double likeliestHold(const FootMoves& moves) {
  double best = 1e30, out = 0.0;
  for (const double hold : {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0}) {
    const double value = (offsets(moves, hold).norm(2, -1) + 0.05).log().mean().item<double>();
    if (value >= best) continue;
    best = value;
    out = hold;
  }
  return out;
}

struct FittedGate {
  double skew = 0.0;
  torch::Tensor radii;  ///< [kGateKnots], in units of the scale
};

/// Steps between radial quantiles, in units of the scale, with which no direction of a gate is
/// narrower than noise of `floor` cm on every coordinate makes it. A foot is seen from where it
/// stood as far as it is held, and from its knee, which is as noisy, as far as it is not. Against
/// the way of its shift a gate is narrower by 1 - |skew|.
double smallestStep(const FootMoves& moves, double hold, double skew, double floor) {
  const double noise = floor * std::sqrt(1.0 + (1.0 - hold) * (1.0 - hold));
  const double scale = moves.scale.min().item<double>();
  return std::max(kSmallestStep, kGateStep * noise / ((1.0 - std::abs(skew)) * scale));
}

/// The gate about given centres under which the movements are likeliest; `far` as in
/// gateQuantiles, `floor` as in smallestStep.
FittedGate likeliestGate(const FootMoves& moves, double hold, double far, double floor) {
  FittedGate best;
  double most = -1e30;
  const auto offset = offsets(moves, hold);
  for (const double skew : {-0.8, -0.5, -0.2, 0.0, 0.2, 0.5, 0.8}) {
    const auto shift = gateShift(torch::full_like(moves.scale, skew), moves.way);
    const auto radii = gateQuantiles(gateDistance(offset, shift) / moves.scale,
                                     smallestStep(moves, hold, skew, floor), far);
    const auto gated = throughGate({radii.unsqueeze(0) * moves.scale.unsqueeze(1), shift}, offset);
    const double nats = (gated.logDet - 0.5 * gated.value.square().sum(-1)).mean().item<double>();
    if (nats <= most) continue;
    most = nats;
    best = {skew, radii};
  }
  return best;
}

torch::Tensor quantileOf(const torch::Tensor& values, double share) {
  const auto sorted = std::get<0>(values.flatten().sort());
  return sorted[static_cast<int64_t>(share * static_cast<double>(sorted.size(0) - 1))];
}

}  // namespace

void KinematicBase::fitChart(const torch::Tensor& pose) {
  std::vector<int64_t> parents;
  for (const int64_t p : m_parents) parents.push_back(std::max<int64_t>(p, 0));
  const auto bones = pose - pose.index_select(1, torch::tensor(parents).to(pose.device()));
  m_lengths.copy_(bones.norm(2, -1).mean(0));
  auto axes = bones.mean(0);
  axes[0] = torch::tensor({0.f, 1.f, 0.f}).to(axes.options());
  // A bone of no length, or one that points everywhere, has no direction of its own: take up.
  const auto size = axes.norm(2, -1, true);
  axes =
      torch::where(size > 1e-3, axes / size.clamp_min(1e-3), axes[0].unsqueeze(0).expand_as(axes));
  const auto alongX = axes.select(1, 0).abs().lt(0.9).unsqueeze(1);
  const auto fixed = torch::where(alongX, torch::tensor({{1.f, 0.f, 0.f}}).to(axes.options()),
                                  torch::tensor({{0.f, 1.f, 0.f}}).to(axes.options()));
  auto sides = fixed - (fixed * axes).sum(-1, true) * axes;
  m_axes.copy_(axes);
  m_chartSides.copy_(sides / sides.norm(2, -1, true));
  // A foot's coordinates and its knee's second leave their gates centred.
  m_predictable.fill_(1.0);
  for (const int64_t foot : m_feet) m_predictable.narrow(0, 3 * foot, 3).zero_();
  for (const int64_t knee : chart().knees)
    if (knee >= 0) m_predictable[3 * knee + 1] = 0.0;
}

void KinematicBase::fitLimits(const torch::Tensor& pose, const Past& past) {
  const auto feet = torch::tensor(m_feet, torch::kInt64).to(pose.device());
  const auto movement =
      (past.poses.select(1, 0) - past.poses.select(1, 1)).index_select(1, feet).norm(2, -1);
  const auto trained = pose / past.size.unsqueeze(-1);
  m_slowMovement.copy_((2.0 * quantileOf(movement, kSlowest)).clamp(0.05, 0.3));
  for (size_t f = 0; f < m_feet.size(); ++f) {
    const auto foot = trained.select(1, m_feet[f]);
    m_footFloor[static_cast<int64_t>(f)] = quantileOf(foot.select(1, 1), kLowest);
    m_reach[static_cast<int64_t>(f)] =
        quantileOf((foot - trained.select(1, m_hips[f])).norm(2, -1), kReached);
  }
}

void KinematicBase::fitForeseen(const torch::Tensor& pose, const Past& past) {
  const auto target = (pose / past.size.unsqueeze(-1) - past.poses.select(1, 0)).flatten(1);
  const auto features = regressors(past);
  const auto mean = features.to(torch::kFloat64).mean(0),
             targetMean = target.to(torch::kFloat64).mean(0);
  const auto width = features.size(1);
  auto gram = torch::zeros({width, width}, mean.options());
  auto cross = torch::zeros({width, target.size(1)}, mean.options());
  for (int64_t at = 0; at < features.size(0); at += kChunk) {
    const int64_t n = std::min(kChunk, features.size(0) - at);
    const auto x = features.narrow(0, at, n).to(torch::kFloat64) - mean;
    gram += x.t().matmul(x);
    cross += x.t().matmul(target.narrow(0, at, n).to(torch::kFloat64) - targetMean);
  }
  const double ridge = m_config.baseRidge * static_cast<double>(features.size(0));
  m_foreseenWeight.copy_(
      torch::linalg_solve(gram + ridge * torch::eye(width, gram.options()), cross));
  m_foreseenMean.copy_(mean);
  m_foreseenBias.copy_(targetMean);
}

/// Clusters of a foot's movement, and how far each is held.
void KinematicBase::fitHold(const torch::Tensor& pose, const Past& past) {
  std::vector<torch::Tensor> features;
  for (size_t f = 0; f < m_feet.size(); ++f) features.push_back(footFeatures(past, f));
  m_footCentres.copy_(clusterCentres(torch::cat(features), m_config.footClusters));
  m_footHold.zero_();
  const auto clusters = footClusters(past), cluster = footByFoot(clusters);
  const auto places = footPlaces(chart(), pose, foreseenOn(past, clusters));
  const auto now = footByFoot(places.now);
  const FootMoves moves{now, footByFoot(places.before), footByFoot(places.way),
                        torch::zeros_like(now.narrow(1, 0, 2)), footByFoot(footScales(past))};
  for (int64_t k = 0; k < m_config.footClusters; ++k) {
    const auto rows = cluster.eq(k).nonzero().squeeze(1);
    if (rows.size(0) > 0) m_footHold[k] = likeliestHold(moves.at(rows));
  }
}

/// What the fits of gates and legs look at: frames as they are foreseen, and where feet went.
struct KinematicBase::Footing {
  torch::Tensor clusters;  ///< [N, feet]
  Foreseen foreseen;
  FootGate gate;  ///< with the tables as they were when it was made
  FootPlaces places;
  torch::Tensor scales;  ///< [N, feet]
};

void KinematicBase::fitGate(const Footing& f, double floor) {
  const FootMoves moves{footByFoot(f.places.now), footByFoot(f.places.before),
                        footByFoot(f.places.way), footByFoot(f.gate.foreseen),
                        footByFoot(f.scales)};
  const auto cluster = footByFoot(f.clusters);
  const FittedGate common = likeliestGate(moves, 0.5, 0.0, floor);
  // What feet do at large is what any foot may do once in a while.
  const double far = common.radii[kGateKnots - 2].item<double>();
  for (int64_t k = 0; k < m_config.footClusters; ++k) {
    const auto rows = cluster.eq(k).nonzero().squeeze(1);
    const FittedGate fitted =
        rows.size(0) < kFewestMoves
            ? common
            : likeliestGate(moves.at(rows), m_footHold[k].item<double>(), far, floor);
    m_footSkew[k] = fitted.skew;
    m_footRadii[k].copy_(fitted.radii);
  }
}

/// How far knees leave the bend of their legs, and feet the lengths of their bones: with the
/// distance that the foot goes.
void KinematicBase::fitLegs(const torch::Tensor& pose, const Footing& f, double floor) {
  const auto& clusters = f.clusters;
  const auto distance = gateDistance(
      f.places.now.narrow(-1, 0, 2) - gateCentre(f.foreseen.hold, f.gate.foreseen, f.places.before),
      gateShift(m_footSkew.index({clusters}), f.places.way));
  std::vector<int64_t> knees;
  for (const int64_t foot : m_feet) knees.push_back(m_parents[static_cast<size_t>(foot)]);
  const auto bent = chartCoordinates(chart(), pose, f.foreseen)
                        .index_select(1, torch::tensor(knees, torch::kInt64).to(pose.device()))
                        .select(-1, 1);
  const auto offset = (bent - (1.0 - firmness(f.foreseen.hold)) * f.gate.knee).abs();
  const auto excess = footExcess(
      f.places.now, f.places.before,
      f.foreseen.lengths.index_select(1, torch::tensor(m_feet, torch::kInt64).to(pose.device())),
      f.foreseen.hold, distance);
  for (int64_t k = 0; k < m_config.footClusters; ++k) {
    const auto rows = clusters.eq(k);
    if (!rows.any().item<bool>()) continue;
    const auto s = distance.masked_select(rows);
    const auto slack = std::max(kSlack, floor) + (1.0 - firmness(m_footHold[k])) * s.median();
    // Bones end in two joints, each as noisy as the other.
    const double steadiest =
        std::max(kSteadiest, std::numbers::sqrt2 * floor / slack.item<double>());
    const auto slope = [&](const torch::Tensor& values) {
      const auto relative = values.masked_select(rows) / (s + slack);
      return relative.square().mean().sqrt().clamp(steadiest, std::max(4.0, steadiest));
    };
    m_slack[k] = slack;
    m_kneeSlope[k] = slope(offset);
    m_boneSlope[k] = slope(excess);
  }
}

void KinematicBase::fitRegimes(const torch::Tensor& local, const Past& past) {
  const auto target = local / past.size;
  const auto rich = richRegressors(past);
  const auto keys = regimeFeatures(past);
  m_regimeCentres.copy_(clusterCentres(keys, m_config.regimes));
  m_richMean.copy_(rich.to(torch::kFloat64).mean(0));
  const auto regime = regimeOf(past);
  const auto total = static_cast<double>(rich.size(0));
  const int64_t width = rich.size(1) + 1, d = local.size(1);
  auto grams = torch::zeros({m_config.regimes, width, width}, torch::kFloat64);
  auto crosses = torch::zeros({m_config.regimes, width, d}, torch::kFloat64);
  for (int64_t k = 0; k < m_config.regimes; ++k) {
    const auto rows = regime.eq(k).nonzero().squeeze(1);
    for (int64_t at = 0; at < rows.size(0); at += kChunk) {
      const auto part = rows.narrow(0, at, std::min(kChunk, rows.size(0) - at));
      const auto centred = rich.index_select(0, part) - m_richMean;
      const auto x = torch::cat({centred, torch::ones({part.size(0), 1}, centred.options())}, 1)
                         .to(torch::kFloat64);
      grams[k] += x.t().matmul(x).cpu();
      crosses[k] += x.t().matmul(target.index_select(0, part).to(torch::kFloat64)).cpu();
    }
  }
  const auto diagonal = [&](double strength, double intercept) {
    auto out = torch::full({width}, strength, torch::kFloat64);
    out[-1] = intercept;
    return torch::diag(out);
  };
  const auto common = torch::linalg_solve(grams.sum(0) + diagonal(m_config.baseRidge * total, 1e-6),
                                          crosses.sum(0));
  // A regime corrects the common regression by what its own frames say, shrunk.
  const auto shrink = diagonal(m_config.regimeShrinkage * total, 10.0);
  auto weight = torch::empty({m_config.regimes, width, d}, torch::kFloat64);
  for (int64_t k = 0; k < m_config.regimes; ++k)
    weight[k] =
        common + torch::linalg_solve(grams[k] + shrink, crosses[k] - grams[k].matmul(common));
  m_richWeight.copy_(weight);
}

/// The feet's gated values come first and are normal already: they stay as they are, and the rest
/// of the body is whitened given them.
void KinematicBase::fitWhitening(const torch::Tensor& residual, const torch::Tensor& regime) {
  const auto ordered = residual.index_select(1, m_order.to(residual.device())).to(torch::kFloat64);
  const auto centred = ordered - ordered.mean(0);
  const auto common = centred.t().matmul(centred) / static_cast<double>(ordered.size(0));
  const int64_t gated = 2 * static_cast<int64_t>(m_feet.size()), rest = ordered.size(1) - gated;
  for (int64_t k = 0; k < m_config.regimes; ++k) {
    const auto rows = ordered.index_select(0, regime.eq(k).nonzero().squeeze(1));
    const auto covariance = (rows.t().matmul(rows) + kPriorFrames * common) /
                            (static_cast<double>(rows.size(0)) + kPriorFrames);
    const auto cross = covariance.narrow(0, gated, rest).narrow(1, 0, gated);
    const auto slope =
        torch::linalg_solve(covariance.narrow(0, 0, gated).narrow(1, 0, gated), cross.t()).t();
    const auto left =
        covariance.narrow(0, gated, rest).narrow(1, gated, rest) - slope.matmul(cross.t());
    const auto [values, vectors] = torch::linalg_eigh(0.5 * (left + left.t()));
    const auto floored =
        values.clamp_min(std::max(m_config.baseFloor * values.max().item<double>(), 1e-8));
    auto factor = torch::eye(gated + rest, covariance.options());
    factor.narrow(0, gated, rest).narrow(1, 0, gated).copy_(slope);
    factor.narrow(0, gated, rest)
        .narrow(1, gated, rest)
        .copy_(torch::linalg_cholesky(vectors.matmul(torch::diag(floored)).matmul(vectors.t())));
    m_factor[k].copy_(factor);
    m_factorInverse[k].copy_(torch::linalg_inv(factor));
    m_factorLogDet[k] = -factor.diagonal().log().sum();
  }
}

void KinematicBase::fitNetFeatures(const Past& past) {
  const auto rich = richRegressors(past).to(torch::kFloat64);
  const auto mean = rich.mean(0), centred = rich - mean;
  const auto [values, vectors] =
      torch::linalg_eigh(centred.t().matmul(centred) / static_cast<double>(rich.size(0)));
  const auto count = m_config.netFeatures;
  // A floor of (0.2 cm)^2 keeps tiny directions from being blown up.
  m_netProjection.copy_(vectors.flip(1).narrow(1, 0, count) /
                        (values.flip(0).narrow(0, 0, count) + 0.04).sqrt());
  m_netMean.copy_(mean);
  const auto deviation = centred.square().mean(0).sqrt().clamp_min(1e-6);
  const int64_t speeds = m_speedScale.size(0), controls = m_controlScale.size(0),
                width = rich.size(1);
  m_speedScale.copy_(deviation.narrow(0, width - speeds, speeds));
  m_controlScale.copy_(deviation.narrow(0, width - speeds - controls, controls));
}

void KinematicBase::fit(const torch::Tensor& poses, const BaseInput& input,
                        const torch::Tensor& noise) {
  const torch::NoGradGuard guard;
  const auto motion = toCentimetres(poses);
  fitChart(motion);
  const Past past = pastOf(input);
  fitLimits(motion, past);
  fitForeseen(motion, past);
  fitHold(motion, past);
  // The body and what holds its feet are those of the motion; how far it strays, of what is seen.
  auto pose = motion;
  double floor = 0.0;
  if (noise.defined()) {
    auto generator = at::detail::createCPUGenerator(kNoiseSeed);
    const auto drawn = torch::randn(poses.sizes(), generator, torch::kFloat32).to(poses.device());
    pose = toCentimetres(poses + drawn * noise);
    floor = 100.0 * (noise * m_poseStd).min().item<double>();
  }
  const auto clusters = footClusters(past);
  const Foreseen foreseen = foreseenOn(past, clusters);
  fitRegimes(chartCoordinates(chart(), pose, foreseen).flatten(1), past);
  const auto regime = regimeOf(past);
  const auto predicted = predictedChart(past, richRegressors(past), regime);
  const Footing footing{clusters, foreseen, gateOf(past, clusters, predicted),
                        footPlaces(chart(), pose, foreseen), footScales(past)};
  fitGate(footing, floor);
  fitLegs(pose, footing, floor);
  const auto local =
      toChart(chart(), pose, foreseen, gateOf(past, clusters, predicted)).value.flatten(1);
  // The few frames in which feet leave would otherwise set the spread of all.
  const auto residual = local - predicted * m_predictable;
  fitWhitening(torch::where(m_predictable.eq(0.0), residual.clamp(-kFarthest, kFarthest), residual),
               regime);
  fitNetFeatures(past);
}

}  // namespace marey::moglow
