// Units of pose values in data sets and models: which of them are lengths, in which unit a
// likelihood is shown, and what an observation floor is for values that are no lengths.
#pragma once

#include <string>
#include <vector>

#include "model/motion_model.h"
#include "motion/representation/representation.h"

namespace marey {

/// A rotation's observation floor is the angle by which a point this far from the joint moves by
/// the floor: 0.5 mm become 0.002 rad.
inline constexpr double kFloorArmM = 0.25;

/// The channels of poses [.., poseDim]. Models that were imported without a skeleton (null) have
/// lengths alone, without names.
std::vector<Channel> channelsOf(const FeatureSpec& features, const Skeleton* skeleton, int poseDim);
std::vector<Channel> channelsOf(const ModelInfo& info);

/// How many joints the model's poses have.
int jointsOf(const ModelInfo& info);

/// "nats per frame, cm" or "nats per frame, cm and rad": the unit of every likelihood that is
/// shown, unless said otherwise. Only likelihoods of one unit can be compared.
std::string likelihoodUnit(const FeatureSpec& features);
std::string likelihoodUnit(const ModelInfo& info);
/// Of a frame's number, or of one per direction: "nats, cm" for "nats per frame, cm".
std::string natsUnit(const std::string& unit);

/// Added to a log-density of standardised poses it gives that of poses in the units that are shown
/// (lengths in centimetres, angles in radians), per frame; 0 for models without a standardiser.
double toShownPerFrame(const Standardiser& standardiser, const std::vector<Channel>& channels);

/// What a floor of one metre is in the unit of each channel [D]: 1 for lengths, 1 / kFloorArmM for
/// angles.
std::vector<double> floorScales(const std::vector<Channel>& channels);
/// Whether the values of its poses are lengths alone.
bool allLengths(const ModelInfo& info);
/// "0.5 mm", or "0.5 mm and 0.002 rad (...)".
std::string floorSizeText(const ModelInfo& info);

/// Throws InputError naming `origin` unless poses and standardiser of a stored model or data set
/// are those of its representation and skeleton.
void requireFittingPoses(const ModelInfo& info, const std::string& origin);

}  // namespace marey
