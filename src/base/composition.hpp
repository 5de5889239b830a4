// Letters with marks: programs and systems write "u" with a diaeresis as one character or as two.
#pragma once

#include <string>

namespace thawslide {

// Text with each letter and its mark as one character (Unicode Standard, Annex 15, form C) for Latin, Greek, Cyrillic
// and kana. Other text, and bytes that are not UTF-8, remain.
[[nodiscard]] std::string composed(const std::string& text);

}  // namespace thawslide
