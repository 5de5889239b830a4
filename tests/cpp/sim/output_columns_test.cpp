// The declared columns are those written by a run.
#include "sim/records/output_columns.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "../support/base_cases.hpp"
#include "../support/column_slab.hpp"
#include "../support/two_bodies.hpp"
#include "sim/block/block.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/history.hpp"
#include "sim/records/run_records.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

using Names = std::vector<std::string>;

// Names of columns; for each axis if a name contains a star.
Names declared(const std::vector<ColumnGroup>& groups, int dimension = 2, bool only_always = false) {
  Names names;
  for (const ColumnGroup& group : groups) {
    for (const OutputColumn& column : group.columns) {
      const std::string name = column.name;
      const std::size_t star = name.find('*');
      if (only_always && *group.condition != '\0') {
        continue;
      }
      for (const char axis : std::string(star == std::string::npos ? "-" : dimension == 2 ? "xy" : "xyz")) {
        names.push_back(axis == '-' ? name : name.substr(0, star) + axis + name.substr(star + 1));
      }
    }
  }
  return names;
}

std::set<std::string> sorted(const Names& names) {
  std::set<std::string> all(names.begin(), names.end());
  EXPECT_EQ(all.size(), names.size());
  return all;
}

std::set<std::string> written(const HistoryRow& row) {
  Names names;
  for (const auto& [name, value] : row) {
    names.push_back(name);
  }
  return sorted(names);
}

template <int Dim>
void expect_declared_history() {
  const Sets sets = loose_bed() + "bed.law=strength; guards.not_finite=remove";
  const Simulation<Dim> plain(two_bodies<Dim>(5e3, Dim == 2 ? 20.0 : 8.0, 5.0, 20.0));
  const Simulation<Dim> bed(two_bodies<Dim>(5e3, Dim == 2 ? 20.0 : 8.0, 5.0, 20.0, sets));
  const Simulation<Dim> columns(case_from_text(column_slab(Dim)));
  EXPECT_EQ(written(history_row(plain)), sorted(declared(history_columns(), Dim, true)));
  std::set<std::string> all = written(history_row(bed));
  all.merge(written(history_row(columns)));
  EXPECT_EQ(all, sorted(declared(history_columns(), Dim)));
}

TEST(OutputColumns, OfTheHistoryAreDeclared2D) { expect_declared_history<2>(); }
TEST(OutputColumns, OfTheHistoryAreDeclared3D) { expect_declared_history<3>(); }

TEST(OutputColumns, OfTheBlockAreDeclaredInOrder) {
  const HistoryRow row = run_block(case_from_text(column_slab(), {"time.end=0.01"})).front();
  Names names;
  for (const auto& [name, value] : row) {
    names.push_back(name);
  }
  EXPECT_EQ(names, declared({block_columns()}));
}

TEST(OutputColumns, OfBasalSegmentsAreDeclared) {
  Simulation<2> simulation(case_from_text(column_slab()));
  run_until(simulation, 0.1);
  std::set<std::string> names;
  for (const auto& [name, values] : base_table(simulation)) {
    names.insert(name);
  }
  EXPECT_EQ(names, sorted(declared({base_columns()})));
}

TEST(OutputColumns, OfProbesAreDeclaredInOrder) {
  const Simulation<3> simulation(slide_in_space());
  config::Site site;
  site.probes = {{"gauge", {{3.5, 4.5}}}, {"section", {{3.5, 4.5}, {3.5, -4.5}}}};
  RunRecords<3> records(simulation, site);
  records.start(simulation);
  Names names;
  for (const auto& [name, value] : records.probe_row(simulation)) {
    names.push_back(name == "time_s" ? name : name.substr(name.find('_') + 1));
  }
  EXPECT_EQ(names, declared(probe_columns()));
}

}  // namespace
}  // namespace thawslide::sim
