// Names of files and folders that a command writes into a case. A case file is UTF-8, whereas file systems accept any
// bytes.
#pragma once

#include <string>

namespace thawslide::app {

// Throws UserError if a name cannot be written in a case file. `what`: subject of the message, including the name.
void require_utf8(const std::string& what, const std::string& name);

}  // namespace thawslide::app
