// checkpoint.bin: everything a run needs to go on, in a container of its own. A SHA-256 over the whole file stands at
// its end and is verified before anything is parsed.
#pragma once

#include <filesystem>
#include <vector>

#include "base/named_numbers.hpp"
#include "mpm/particles.hpp"

namespace thawslide::io {

// Rows by id, so that the bytes do not depend on storage order. at_start: how many particles there were at t = 0;
// blocks: what else the run needs to go on.
template <int Dim, class Real>
void write_checkpoint(const std::filesystem::path& file, const mpm::Particles<Dim, Real>& particles,
                      std::size_t at_start, const std::vector<double>& scalars, const NamedNumbers& blocks = {});

// particles: those at t = 0, which the ones of the checkpoint replace. Returns the blocks. Throws UserError for a file
// that is damaged, cut short, or of another kind of run (dimension, number type, fields, particles at t = 0).
template <int Dim, class Real>
NamedNumbers read_checkpoint(const std::filesystem::path& file, mpm::Particles<Dim, Real>& particles,
                             std::vector<double>& scalars);

}  // namespace thawslide::io
