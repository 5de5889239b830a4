// A checkpoint whose bytes are not those that a run wrote: damage is found, and what is signed anew never breaks the
// program.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "../support/slide_in_space.hpp"
#include "base/error.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "io/sha256.hpp"
#include "sim/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

namespace fs = std::filesystem;
using testing_support::folder_of_this_test;

// Twelve cells of a slide in space, with its maps.
config::Case small_slide() {
  return testing_support::slide_in_space("velocity = [8.0, 1.0, 0.0]", {"body.box.max=[2.0, 5.0, 1.0]"});
}

// Two generations of the run's checkpoint, some steps apart. Returns how many particles there were at t = 0.
std::size_t write_two_generations(const fs::path& folder) {
  Simulation<3, double> simulation(small_slide());
  RunRecords<3> records(simulation, {});
  records.start(simulation);
  for (int generation = 0; generation < 2; ++generation) {
    for (int k = 0; k < 10; ++k) {
      simulation.step(0.002);
      records.after_step(simulation);
    }
    io::write_checkpoint<3, double>(folder, simulation.particles(), simulation.particles_at_start(),
                                    simulation.scalars(), records.state());
  }
  return simulation.particles_at_start();
}

class CheckpointDamage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = folder_of_this_test();
    last_ = folder_ / io::checkpoint_name;
    previous_ = folder_ / io::previous_checkpoint_name;
    fs::remove(last_);
    fs::remove(previous_);
    at_start_ = write_two_generations(folder_);
    bytes_of_last_ = io::read_file(last_);
    bytes_of_previous_ = io::read_file(previous_);
  }

  // As damage happens: in its place. Returns the byte that stood there.
  static char put(const fs::path& file, std::size_t place, char byte) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(static_cast<std::streamoff>(place));
    const char before = static_cast<char>(stream.get());
    stream.seekp(static_cast<std::streamoff>(place));
    stream.put(byte);
    return before;
  }
  static char another(char byte, std::mt19937& random) {
    return static_cast<char>(byte ^ static_cast<char>(1 + random() % 255));
  }

  static std::string damage_words(const fs::path& file, std::size_t bytes) {
    return fmt::format("{} is damaged: its checksum does not fit its {} bytes", file.string(), bytes);
  }

  std::size_t at_start_ = 0;
  fs::path folder_, last_, previous_;
  std::string bytes_of_last_, bytes_of_previous_;
};

TEST_F(CheckpointDamage, OfAnyOneByteIsFoundAndTheOneBeforeIsTaken) {
  ASSERT_NE(bytes_of_last_, bytes_of_previous_);
  std::mt19937 random(1);
  for (std::size_t place = 0; place < bytes_of_last_.size(); ++place) {
    put(last_, place, another(bytes_of_last_[place], random));
    const io::WholeCheckpoint found = io::newest_checkpoint(folder_);
    ASSERT_EQ(found.file, previous_) << "byte " << place;
    ASSERT_EQ(found.bytes, bytes_of_previous_) << "byte " << place;
    ASSERT_EQ(found.warning, damage_words(last_, bytes_of_last_.size())) << "byte " << place;
    put(last_, place, bytes_of_last_[place]);
  }
  EXPECT_EQ(io::newest_checkpoint(folder_).bytes, bytes_of_last_);
}

TEST_F(CheckpointDamage, OfBothGenerationsIsRefused) {
  std::mt19937 random(2);
  for (int k = 0; k < 2000; ++k) {
    const std::size_t in_last = random() % bytes_of_last_.size(), in_previous = random() % bytes_of_previous_.size();
    const char before = put(last_, in_last, another(bytes_of_last_[in_last], random));
    const char before_that = put(previous_, in_previous, another(bytes_of_previous_[in_previous], random));
    try {
      const io::WholeCheckpoint found = io::newest_checkpoint(folder_);
      FAIL() << "damage " << k << " is not found in " << found.file;
    } catch (const UserError& error) {
      ASSERT_EQ(error.what(), damage_words(last_, bytes_of_last_.size()) + "; " +
                                  damage_words(previous_, bytes_of_previous_.size()) +
                                  ". Use another copy, or run the case from its start.");
    }
    put(last_, in_last, before);
    put(previous_, in_previous, before_that);
  }
}

// Past the checksum, by the hand of someone who signs what he changed.
class SignedCheckpoint : public CheckpointDamage {
 protected:
  static std::string body_of(const std::string& bytes) { return bytes.substr(0, bytes.size() - sizeof(io::Digest)); }

  // What reading says; empty: it gives a value.
  std::string error_of_signed(const std::string& body) const {
    const io::Digest digest = io::sha256(body.data(), body.size());
    fs::remove(last_);  // a new file: some systems wait for the disk where one is cut to nothing and written again
    std::ofstream(last_, std::ios::binary)
        << body << std::string_view(reinterpret_cast<const char*>(digest.data()), digest.size());
    mpm::Particles<3, double> particles;
    particles.resize(at_start_);
    std::vector<double> scalars;
    try {
      static_cast<void>(io::read_checkpoint<3, double>(io::newest_checkpoint(folder_), particles, scalars));
    } catch (const UserError& error) {
      EXPECT_EQ(std::string(error.what()).find(last_.string()), 0U) << error.what();
      return error.what();
    }
    return "";
  }

  // What reading and going on from it say; empty: they do not mind.
  std::string error_of_restored(const std::string& body) const {
    if (const std::string error = error_of_signed(body); !error.empty()) {
      return error;
    }
    Simulation<3, double> simulation(small_slide());
    RunRecords<3> records(simulation, {});
    std::vector<double> scalars;
    try {
      const NamedNumbers blocks =
          io::read_checkpoint<3, double>(io::newest_checkpoint(folder_), simulation.particles(), scalars);
      simulation.restore(scalars);
      records.restore(blocks);
    } catch (const UserError& error) {
      EXPECT_EQ(std::string(error.what()).find("the checkpoint's state of the "), 0U) << error.what();
      return error.what();
    }
    return "";
  }

  // Where the count of particles stands, after dimension, bytes of a number and particles at t = 0; that of the scalars
  // follows.
  std::size_t place_of_counts(const std::string& body) const {
    const std::array<std::uint64_t, 3> before{3, sizeof(double), at_start_};
    const std::size_t place = body.find(std::string(reinterpret_cast<const char*>(before.data()), sizeof before));
    EXPECT_NE(place, std::string::npos);
    return place + sizeof before;
  }

  // The body with another number of 8 bytes at a place.
  static std::string with_number(std::string body, std::size_t place, std::uint64_t number) {
    std::memcpy(body.data() + place, &number, sizeof number);
    return body;
  }
};

TEST_F(SignedCheckpoint, CutOffAnywhereIsRefused) {
  const std::string body = body_of(bytes_of_last_);
  EXPECT_EQ(error_of_signed(body), "");
  std::mt19937 random(3);
  for (int k = 0; k < 300; ++k) {
    const std::size_t left = k < 100 ? static_cast<std::size_t>(k) + 1 : 1 + random() % (body.size() - 1);
    EXPECT_NE(error_of_signed(body.substr(0, left)), "") << left << " bytes";
  }
  EXPECT_EQ(error_of_signed(body + "more"),
            last_.string() +
                " has a checksum that fits, but 4 bytes are left at its end: no version of this program writes that. "
                "Use another copy, or run the case from its start.");
}

// Each of these asked for as much memory as it says, or read beyond the end.
TEST_F(SignedCheckpoint, CountsBeyondTheFileAreRefused) {
  const std::string body = body_of(bytes_of_last_);
  const std::size_t particles = place_of_counts(body), scalars = particles + sizeof(std::uint64_t);
  for (const std::uint64_t number : {std::uint64_t{1} << 62U, ~std::uint64_t{0}, std::uint64_t{body.size()}}) {
    EXPECT_NE(error_of_signed(with_number(body, particles, number)).find(fmt::format("it specifies {} part", number)),
              std::string::npos);
    EXPECT_NE(error_of_signed(with_number(body, scalars, number)).find(fmt::format("it specifies {} numb", number)),
              std::string::npos);
  }
}

TEST_F(SignedCheckpoint, AnyOtherBytesGiveAStateOrAMessage) {
  const std::string body = body_of(bytes_of_last_);
  EXPECT_EQ(error_of_restored(body), "");
  std::mt19937 random(4);
  for (int k = 0; k < 300; ++k) {
    std::string changed = body;
    char& byte = changed[random() % changed.size()];
    byte = another(byte, random);
    static_cast<void>(error_of_restored(changed));
  }
}

// Without these a particle's cell, body or id would be looked up where there is none.
TEST_F(SignedCheckpoint, ParticlesThatNoRunHasAreRefused) {
  const auto with = [&](const auto& change) {
    Simulation<3, double> simulation(small_slide());
    std::vector<double> scalars;
    try {
      static_cast<void>(
          io::read_checkpoint<3, double>(io::newest_checkpoint(folder_), simulation.particles(), scalars));
      change(simulation.particles(), scalars);
      simulation.restore(scalars);
    } catch (const UserError& error) {
      const std::string said = error.what();
      return said.substr(0, said.find(". Use another copy"));
    }
    return std::string();
  };
  using Particles = mpm::Particles<3, double>;
  using Numbers = std::vector<double>;
  const std::string run = "the checkpoint's state of the run is none that a run has: ";
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(with([](Particles& of, Numbers&) { EXPECT_EQ(of.size(), 32U); }), "");
  EXPECT_EQ(with([](Particles& of, Numbers&) { of.position(5, 1) = missing; }),
            run + "particle 5 lies outside the domain");
  EXPECT_EQ(with([](Particles& of, Numbers&) { of.position(5, 1) = 1e300; }),
            run + "particle 5 lies outside the domain");
  EXPECT_EQ(with([](Particles& of, Numbers&) { of.body(5) = 7; }),
            run + "particle 5 has the body 7 and the material 0, which the case does not have");
  EXPECT_EQ(with([](Particles& of, Numbers&) { of.id(5) = 4; }),
            run + "the particle in row 5 has the id 4; allowed: from 5 to 31");
  EXPECT_EQ(with([](Particles& of, Numbers&) { of.mass(5) = -1.0; }).find(run + "particle 5 has a mass of -1 kg"), 0U);
  EXPECT_EQ(with([](Particles&, Numbers& scalars) { scalars[3] = 0.5; }),
            run + "it has 0.5 for its number 4; allowed: whole numbers from 0 to 9007199254740992");
  EXPECT_EQ(with([](Particles&, Numbers& scalars) { scalars[0] = missing; }),
            run + "it has nan for its number 1, which must be finite");
  EXPECT_EQ(with([](Particles&, Numbers& scalars) { scalars.resize(7); }), run + "it has 7 numbers, which are too few");
}

}  // namespace
}  // namespace thawslide::sim
