// The reference of the tables, datasets and maps of a run, from their declarations.
#pragma once

#include <string>

namespace thawslide::app {

// As Markdown: the page "Columns, datasets and maps" of the site.
[[nodiscard]] std::string describe_outputs();

}  // namespace thawslide::app
