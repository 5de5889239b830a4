// What must hold between several keys of a case, and between keys and files.
#pragma once

#include "config/case.hpp"
#include "config/profile_csv.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

// Adds a problem for each thing that does not fit. Checks whose keys already have a problem are left out.
void check_case(const Case& checked, Reading& reading);

// That the material named by a table is there.
void check_material(const Case& checked, const std::string& table, const std::string& name, Reading& reading);

// The part on terrain, bodies and frames. `profile` is empty where there is none, or it could not be read.
void check_bodies(const Case& checked, const ProfileTable& profile, Reading& reading);

// The part on what bodies slide on: [basal], and [substrate.NAME] with where it lies.
void check_grounds(const Case& checked, Reading& reading);

// The part on what the slide takes up: [bed].
void check_bed(const Case& checked, Reading& reading);

// The part on what acts between bodies: [contact] and [contact_pair.NAME].
void check_contact(const Case& checked, Reading& reading);

// The part on a DEM, releases, what maps give to bodies, and probes. Whether the maps hold what is asked of them is not
// known here.
void check_maps(const Case& checked, Reading& reading);

// The part on the width of a section. After the others.
void check_width(const Case& checked, Reading& reading);

// The part on the names of input files, and on reported values.
void check_files(const Case& checked, Reading& reading);

}  // namespace thawslide::config
