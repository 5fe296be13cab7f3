// Acclaim's pair of files: ASF (skeleton: bones with directions, axes and degrees of freedom) and
// AMC (values of those per frame), as the CMU motion data base has them.
//
// A joint of Marey stands where the bone of that name begins (so 'lfoot' is the left ankle), as in
// BVH conversions of the same takes; bones without children get an end site. With the bone's axis
// turn C and the turn M of a frame, the local rotation is C M C^-1; at rest every joint's frame is
// that of the world. Turns are applied in the order listed (RX RY RZ: R = Rz Ry Rx). The root's
// orientation is such an axis C, no turn of the whole body. The header's length L gives the unit,
// 1 = (1 / L) inch, unless that makes no person and another unit does (people write lengths in
// centimetres or inches and the factor for show): see checkedUnit.
#pragma once

#include <array>
#include <optional>

#include "io/format.h"
#include "io/units.h"
#include "motion/rotation.h"

namespace marey::io {

struct AsfChannel {
  enum class Kind { Shift, Turn, Length } kind = Kind::Shift;
  int axis = 0;  ///< of shifts and turns
};

/// Lengths in file units; joints in the order of the hierarchy, joint 0 is "root".
struct AsfSkeleton {
  Skeleton skeleton;
  std::vector<std::vector<AsfChannel>> channels;  ///< per joint, in the order of the AMC's values
  std::vector<Quatd> axes;                        ///< C of every joint
  LengthUnit unit;
  bool degrees = true;
  std::vector<std::string> notes;
};

/// Throws InputError with the line.
AsfSkeleton parseAsf(std::string_view bytes, const std::string& origin);

int canReadAmc(std::string_view head);
/// Every frame must give every degree of freedom. Where the file has no line ':SAMPLES-PER-SECOND
/// N' (or ':FPS N'), 120 is assumed, as in the CMU data base, and noted. Degree of freedom 'l' (the
/// bone's length) must be 0: whether other values add to the length or replace it is not known.
/// Throws InputError with the line.
Clip parseAmc(std::string_view bytes, const std::string& origin, const AsfSkeleton& asf,
              const ReadOptions& options = {});
/// Takes options.asf, else the ASF beside it whose name shares the longest beginning.
/// Throws InputError when there is none.
std::vector<Clip> readAmc(std::string_view bytes, const std::filesystem::path& path,
                          const ReadOptions& options);
std::filesystem::path asfBeside(const std::filesystem::path& amc);

}  // namespace marey::io
