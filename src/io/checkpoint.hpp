// checkpoint.bin: everything a run needs to go on, in a container of its own. A SHA-256 over the whole file stands at
// its end and is verified before anything is parsed. Two generations are kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/named_numbers.hpp"
#include "mpm/particles.hpp"

namespace thawslide::io {

// The checkpoint of a run folder, and the one before it.
inline constexpr const char* checkpoint_name = "checkpoint.bin";
inline constexpr const char* previous_checkpoint_name = "checkpoint.previous.bin";

// Writes checkpoint.bin into `folder`; what stood there becomes checkpoint.previous.bin. Rows by id, so that the bytes
// do not depend on storage order. at_start: how many particles there were at t = 0; blocks: what else the run needs to
// go on; case_text: the resolved case it runs. Throws WriteError.
template <int Dim, class Real>
void write_checkpoint(const std::filesystem::path& folder, const mpm::Particles<Dim, Real>& particles,
                      std::size_t at_start, const std::vector<double>& scalars, const NamedNumbers& blocks = {},
                      const std::string& case_text = {});

// What a particle takes of a checkpoint [bytes].
template <int Dim>
[[nodiscard]] std::size_t checkpoint_bytes_of_particle();

// A checkpoint as it stands in its file, its checksum verified.
struct WholeCheckpoint {
  std::filesystem::path file;
  std::string bytes;
  std::string warning;  // of one that was passed over because it is damaged, cannot be read or is absent; empty: none
  std::filesystem::path damaged = {};  // the one that was passed over, if it is there; empty: there is nothing to keep
};

// Whether a run folder holds a checkpoint, whole or not.
[[nodiscard]] bool has_checkpoint(const std::filesystem::path& folder);

// The newest checkpoint of a run folder that is whole and can be read. Throws UserError where there is none.
[[nodiscard]] WholeCheckpoint newest_checkpoint(const std::filesystem::path& folder);

// The resolved case that the run had when it wrote the checkpoint. Throws UserError for one of another program.
[[nodiscard]] std::string case_of(const WholeCheckpoint& checkpoint);

// particles: those at t = 0, which the ones of the checkpoint replace. Returns the blocks. Throws UserError for a
// checkpoint of another kind of run (dimension, number type, fields, particles at t = 0), and for bytes that no run
// wrote although their checksum fits; it never asks for more memory than particles and numbers of the file's size take.
template <int Dim, class Real>
NamedNumbers read_checkpoint(const WholeCheckpoint& checkpoint, mpm::Particles<Dim, Real>& particles,
                             std::vector<double>& scalars);

}  // namespace thawslide::io
