// Input, output and messages of the process.
#pragma once

namespace thawslide::app {

// From now on no file that is opened takes the place of a stream that whoever started the program has closed: what is
// told would be written into it. Reading from such a stream, and writing to it, fails as before.
void hold_standard_streams();

}  // namespace thawslide::app
