// Damaged checkpoints are detected.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "sim/records/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

namespace fs = std::filesystem;
using testing_support::folder_of_this_test;

// Twelve cells of a 3D slide, with its maps.
config::Case small_slide() {
  return testing_support::slide_in_space("body.box.velocity=[8,1,0]; body.box.max=[2.0, 5.0, 1.0]");
}

// Two generations of the run's checkpoint, several time steps apart.
void write_two_generations(const fs::path& folder) {
  Simulation<3> simulation(small_slide());
  RunRecords<3> records(simulation, {});
  records.start(simulation);
  for (int generation = 0; generation < 2; ++generation) {
    for (int k = 0; k < 10; ++k) {
      simulation.step(0.002);
      records.after_step(simulation);
    }
    io::write_checkpoint<3>(folder, simulation.particles(), simulation.particles_at_start(), simulation.scalars(),
                            records.state());
  }
}

class CheckpointDamage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = folder_of_this_test();
    last_ = folder_ / io::checkpoint_name;
    previous_ = folder_ / io::previous_checkpoint_name;
    fs::remove(last_);
    fs::remove(previous_);
    write_two_generations(folder_);
    bytes_of_last_ = io::read_file(last_);
    bytes_of_previous_ = io::read_file(previous_);
  }

  // Damages the file in place, as hardware does. Returns the original byte.
  static char put(const fs::path& file, std::size_t offset, char byte) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(static_cast<std::streamoff>(offset));
    const char before = static_cast<char>(stream.get());
    stream.seekp(static_cast<std::streamoff>(offset));
    stream.put(byte);
    return before;
  }
  static char another(char byte, std::mt19937& random) {
    return static_cast<char>(byte ^ static_cast<char>(1 + random() % 255));
  }

  static std::string damage_words(const fs::path& file, std::size_t bytes) {
    return fmt::format("{} is damaged: its checksum does not fit its {} bytes", file.string(), bytes);
  }

  fs::path folder_, last_, previous_;
  std::string bytes_of_last_, bytes_of_previous_;
};

TEST_F(CheckpointDamage, OfAnySingleByteIsDetectedAndThePreviousCheckpointIsUsed) {
  ASSERT_NE(bytes_of_last_, bytes_of_previous_);
  std::mt19937 random(1);
  for (std::size_t offset = 0; offset < bytes_of_last_.size(); ++offset) {
    put(last_, offset, another(bytes_of_last_[offset], random));
    const io::WholeCheckpoint found = io::newest_checkpoint(folder_);
    ASSERT_EQ(found.file, previous_) << "byte " << offset;
    ASSERT_EQ(found.bytes, bytes_of_previous_) << "byte " << offset;
    ASSERT_EQ(found.warning, damage_words(last_, bytes_of_last_.size())) << "byte " << offset;
    put(last_, offset, bytes_of_last_[offset]);
  }
  const io::WholeCheckpoint last = io::newest_checkpoint(folder_);
  EXPECT_EQ(last.file, last_);
  EXPECT_EQ(last.bytes, bytes_of_last_);
  EXPECT_EQ(last.warning, "");
}

TEST_F(CheckpointDamage, OfATruncatedFileIsDetected) {
  for (const std::size_t left :
       {bytes_of_last_.size() - 1, bytes_of_last_.size() / 2, std::size_t{32}, std::size_t{1}, std::size_t{0}}) {
    fs::resize_file(last_, left);
    EXPECT_EQ(io::newest_checkpoint(folder_).bytes, bytes_of_previous_);
    EXPECT_EQ(io::newest_checkpoint(folder_).warning, damage_words(last_, left));
  }
}

TEST_F(CheckpointDamage, OfBothGenerationsIsRefused) {
  std::mt19937 random(2);
  for (int k = 0; k < 2000; ++k) {
    const std::size_t in_last = random() % bytes_of_last_.size(), in_previous = random() % bytes_of_previous_.size();
    const char before = put(last_, in_last, another(bytes_of_last_[in_last], random));
    const char before_that = put(previous_, in_previous, another(bytes_of_previous_[in_previous], random));
    ASSERT_EQ(testing_support::error_of([&] { static_cast<void>(io::newest_checkpoint(folder_)); }),
              damage_words(last_, bytes_of_last_.size()) + "; " + damage_words(previous_, bytes_of_previous_.size()) +
                  ". Use another copy, or run the case from its start.")
        << k;
    put(last_, in_last, before);
    put(previous_, in_previous, before_that);
  }
}

}  // namespace
}  // namespace thawslide::sim
