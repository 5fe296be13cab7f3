// Scores and motions as bytes, between the processes of a run.
#pragma once

#include <string>
#include <vector>

#include "base/packing.h"
#include "model/scorer.h"

namespace marey {

void pack(const ClipScore& score, Packer& packer);
ClipScore unpackScore(Unpacker& bytes);
/// Poses alone: the receiver knows control and start.
void pack(const Matrix& poses, Packer& packer);
Matrix unpackPoses(Unpacker& bytes);

}  // namespace marey
