// Edits of the document: free functions that change a plain struct. Whoever keeps a history
// commits the result.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiment/document.h"
#include "model/motion_model.h"

namespace marey {

/// `wanted`, or "wanted 2", "wanted 3", ... where a system (path) has that name already.
std::string freeSystemName(const Experiment& experiment, const std::string& wanted);
std::string freePathName(const Experiment& experiment, const std::string& wanted);

/// Adds a model under a free name; returns its index.
size_t addSystem(Experiment& experiment, const std::string& model, const std::string& name,
                 double temperature = 1.0);
/// Adds a path under a free name; returns its index.
size_t addPath(Experiment& experiment, ExperimentPath path);
/// Adds sources of natural motion that are not there yet; returns how many were added.
size_t addNatural(Experiment& experiment, const std::vector<std::string>& sources);
/// Renames the item at `index`. Throws InputError where the name is empty or taken.
void renameSystem(Experiment& experiment, size_t index, const std::string& name);
void renamePath(Experiment& experiment, size_t index, const std::string& name);
void removeSystem(Experiment& experiment, size_t index);
void removeNatural(Experiment& experiment, const std::string& source);
/// Sets how long a path is followed; what rounds to 0 means as long as it takes, other values are
/// raised to the shortest one that a document may hold.
void setPathSeconds(Experiment& experiment, size_t index, double seconds);
/// The types of motion that models know and the document's paths name, sorted.
std::vector<std::string> motionTypes(const Experiment& experiment,
                                     const std::vector<std::shared_ptr<const MotionModel>>& models);
/// Makes the file names of the document fit `folder`, so that a document saved there finds its
/// files: relative ones where they lie in it or below, which then move along with it, else whole.
void moveToFolder(Experiment& experiment, const std::filesystem::path& folder);
/// Whether it names no motion, no system and no path.
bool isEmpty(const Experiment& experiment);
/// The document as it would be after saving and opening it again. Throws InputError naming the key
/// where such a file could not be opened.
Experiment asStored(const Experiment& experiment);
/// What differs: the JSON pointer of the narrowest value (a whole way-point, not one of its
/// coordinates) that holds all differences; empty: the whole document, or nothing.
std::string changedPlace(const Experiment& before, const Experiment& after);

}  // namespace marey
