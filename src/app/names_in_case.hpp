// Names of files and folders that a command writes into a case: a case file is UTF-8, and file systems take any bytes.
#pragma once

#include <string>

namespace thawslide::app {

// Throws UserError where a name cannot stand in a case file. `what`: has the name, as the message says it.
void require_utf8(const std::string& what, const std::string& name);

}  // namespace thawslide::app
