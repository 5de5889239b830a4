// checkpoint.bin: complete state for resuming a run, with a SHA-256 at its end. Two generations are kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/state_numbers.hpp"
#include "mpm/particles.hpp"

namespace thawslide::io {

// Current and previous checkpoint of a run folder.
inline constexpr const char* checkpoint_name = "checkpoint.bin";
inline constexpr const char* previous_checkpoint_name = "checkpoint.previous.bin";

// Bytes of a checkpoint, with rows by id. at_start: particles at t = 0; blocks: further state; case_text: resolved.
template <int Dim>
[[nodiscard]] std::string checkpoint_bytes(const mpm::Particles<Dim>& particles, std::size_t at_start,
                                           const std::vector<double>& scalars, const NamedNumbers& blocks = {},
                                           const std::string& case_text = {});

// Writes checkpoint.bin into `folder`; an existing one becomes checkpoint.previous.bin. Throws WriteError.
template <int Dim>
void write_checkpoint(const std::filesystem::path& folder, const mpm::Particles<Dim>& particles, std::size_t at_start,
                      const std::vector<double>& scalars, const NamedNumbers& blocks = {},
                      const std::string& case_text = {});

// Size of a particle in a checkpoint [bytes].
template <int Dim>
[[nodiscard]] std::size_t checkpoint_bytes_of_particle();

// Bytes of a checkpoint file with a verified checksum.
struct WholeCheckpoint {
  std::filesystem::path file;
  std::string bytes;
  std::string warning;  // about a newer checkpoint that is damaged, unreadable or absent; empty if there is none
  std::filesystem::path damaged = {};  // that newer checkpoint, if the file exists; empty otherwise
};

// Checkpoint in memory; file: its name in messages. Throws UserError if the bytes are damaged.
[[nodiscard]] WholeCheckpoint intact_checkpoint(const std::filesystem::path& file, const std::string& bytes);

// True if a run folder contains a checkpoint, intact or not.
[[nodiscard]] bool has_checkpoint(const std::filesystem::path& folder);

// Newest checkpoint of a run folder that is intact and readable. Throws UserError if there is none.
[[nodiscard]] WholeCheckpoint newest_checkpoint(const std::filesystem::path& folder);

// Resolved case of the run when it wrote the checkpoint. Throws UserError for a checkpoint of another program.
[[nodiscard]] std::string case_of(const WholeCheckpoint& checkpoint);

// Replaces particles at t = 0 by those of the checkpoint; returns the blocks. Throws UserError for one of another run.
template <int Dim>
NamedNumbers read_checkpoint(const WholeCheckpoint& checkpoint, mpm::Particles<Dim>& particles,
                             std::vector<double>& scalars);

}  // namespace thawslide::io
