// Files beside a clip that say more of it. Of 'walk.bvh':
//   walk.labels.csv          from,to,label (seconds; without 'to' up to the next row), or
//   time,label walk.NAME.csv or .npy    a signal: a row per sample; a column 'time' (seconds) gives
//   its rate
#pragma once

#include <filesystem>

#include "motion/clip.h"
#include "motion/control/control_layout.h"

namespace marey::io {

/// In the order of time; a row with an empty label is a stretch without. Throws FileError or
/// InputError naming the line.
std::vector<LabelSpan> readLabels(const std::filesystem::path& path);

/// CSV, or an .npy of numbers (T) or (T, C). `fps`: where the file has no column 'time'; 0: that of
/// `clip`, if it has one row for each of its frames (one more or less is let pass). Throws
/// FileError or InputError.
Signal readSignal(const std::filesystem::path& path, double fps, const Clip* clip = nullptr);

/// The file of the labels that lies beside a motion file; empty: there is none.
std::filesystem::path labelsBeside(const std::filesystem::path& motion);
/// Whether a file is a label file or signal of a motion file beside it ('walk.speech.csv' beside
/// 'walk.bvh').
bool isAnnotation(const std::filesystem::path& path);

/// Reads the arrays of a layout that lie beside a clip's file and are not known yet. Throws
/// FileError or InputError.
void readSignals(Clip& clip, const ControlLayout& layout);
void readSignals(std::vector<Clip>& clips, const ControlLayout& layout);

}  // namespace marey::io
