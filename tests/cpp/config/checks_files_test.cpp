// Input files other than maps: names that collide in the run folder, reported values.
#include "case_messages.hpp"
#include "config/reported_values.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

const Change profile{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"data.csv\""};
const Change targets{"[basal]", "[report]\ntargets = \"targets.csv\"\n[basal]"};
const std::string heights = "distance_m,terrain_elevation_m\n0,0\n100,0\n";
const std::string columns = "quantity,time_s,value,unit,source\n";

TEST(InputFiles, WithTheSameNameAreRefusedAtTheLaterKey) {
  write_next_to_the_case("data.csv", heights);
  write_next_to_the_case("reports/data.csv", columns);
  EXPECT_EQ(error_of_changed({profile, {"[basal]", "[report]\ntargets = \"reports/data.csv\"\n[basal]"}}),
            "FOLDER/case.toml:21:11: report.targets leads to FOLDER/reports/data.csv, and terrain.file to "
            "FOLDER/data.csv; allowed: names of their own, since a run keeps copies of all its inputs in one folder. "
            "Rename one.");
  EXPECT_EQ(error_of_changed({profile}), "no error");
}

TEST(InputFiles, OfAMapAreListedOnceWithTheirSidecarFiles) {
  for (const std::string folder : {"west", "east"}) {
    for (const std::string ending : {".shp", ".shx", ".dbf"}) {
      write_next_to_the_case(folder + "/area" + ending, "");
    }
  }
  write_map_files();
  const std::string text =
      changed({{"release.geojson", "west/area.shp"}, {"[basal]", "[maps]\npath = \"east/area.shp\"\n[basal]"}},
              valid_case_on_dem);
  EXPECT_EQ(error_of_text(text),
            "FOLDER/case.toml:20:11: body.slide.release leads to FOLDER/west/area.shp, and maps.path to "
            "FOLDER/east/area.shp; allowed: names of their own, since a run keeps copies of all its inputs in one "
            "folder. Rename one.");
}

TEST(InputFiles, ThatAreFoldersAreRefused) {
  std::filesystem::create_directories(folder_of_this_test() / "data.csv");
  EXPECT_EQ(error_of_changed({profile}),
            "FOLDER/case.toml:10:8: terrain.file is \"data.csv\", a folder; allowed: a file.");
}

// The report reads the same file and uses the same messages (tests/cli/targets_test.py).
TEST(ReportedValues, AreReadWithTheCaseAndEachMistakeIsReported) {
  write_next_to_the_case("targets.csv", "# from other publications\n" + columns +
                                            "mean_velocty,1,8,m/s,x\n"
                                            "mean_velocity,1,8,knots,x\n"
                                            "mean_velocity,1,fast,m/s,x\n"
                                            "mean_velocity,-100,8,m/s,x\n"
                                            "mean_velocity,1,-8,m/s,x\n"
                                            "band_SL,1,30,-,x\n"
                                            "max_seismic_force_150_35_s,1,2,N,x\n"
                                            "mean_displacement,1,2,m\n"
                                            "source_volume,-5,2,million m3,\"x, and others\"\n"
                                            "mean_displacement,1,2,m,x\n"
                                            "mean_displacement,1,3,m,x\n");
  const std::string location = "FOLDER/case.toml:21:11: report.targets: FOLDER/targets.csv:";
  EXPECT_EQ(error_of_changed({targets}),
            location +
                "3: no quantity is called 'mean_velocty'; did you mean mean_velocity? There are: start_velocity, "
                "mean_velocity, mean_displacement, front_distance, band_SL, band_saturation, band_temperature, "
                "band_pore_pressure, band_friction_coefficient, max_seismic_force, source_volume, "
                "source_mean_thickness, deposit_volume, deposit_area, travel_distance, drop_height, "
                "angle_of_reach; and max_seismic_force_35_150_s for a force between periods of 35 and 150 s\n" +
                location + "4: the unit 'knots' for mean_velocity; allowed: m/s, km/h\n" +  //
                location + "5: expected a number, found 'fast'\n" +                         //
                location + "7: mean_velocity is -8 m/s; allowed: at least 0 m/s\n" +        //
                location + "8: band_SL is 30; allowed: at least 0, at most 1\n" +           //
                location +
                "9: max_seismic_force_150_35_s: give the shorter period first, both from 0.001 to 100000 s\n" +  //
                location + "10: 4 values for 5 columns\n" +                                                      //
                location +
                "13: mean_displacement at this time from this source is in line 12 already; keep one of the two, or "
                "give them different sources\n" +
                location +
                "6: mean_velocity is of -100 s, before the run; allowed: 0 s and later, or a row "
                "start_velocity that sets their clock");
}

TEST(ReportedValues, HaveOneOfThreeKinds) {
  write_next_to_the_case("targets.csv",
                         "quantity,time_s,value,unit,kind\nmean_velocity,1,8,m/s,observation\n"
                         "mean_velocity,2,8,m/s,model\nmean_velocity,3,8,m/s,assumption\n");
  EXPECT_EQ(error_of_changed({targets}), "no error");
  write_next_to_the_case("targets.csv",
                         "quantity,time_s,value,unit,kind\nmean_velocity,1,8,m/s,guess\nmean_velocity,2,8,m/s,\n");
  const std::string location = "FOLDER/case.toml:21:11: report.targets: FOLDER/targets.csv:";
  EXPECT_EQ(error_of_changed({targets}),
            location + "2: the kind 'guess' for mean_velocity; allowed: observation, model, assumption\n" +  //
                location + "3: no kind for mean_velocity; allowed: observation, model, assumption");
}

TEST(ReportedValues, WithASeparateStartTimeMayBeNegative) {
  write_next_to_the_case("targets.csv", columns + "start_velocity,-50,8,m/s,x\nmean_velocity,-40,8,m/s,x\n");
  EXPECT_EQ(error_of_changed({targets}), "no error");
}

TEST(ReportedValues, AfterTheEndCauseAWarning) {
  const std::string rows = "mean_velocity,1,8,m/s,x\nmean_velocity,75,8,m/s,x\ndeposit_volume,900,1,m3,x\n";
  write_next_to_the_case("targets.csv", columns + rows + "mean_displacement,80,8,m,x\n");
  const std::string warning = warning_of_late_values(testing_support::case_from_text(changed({targets})));
  EXPECT_NE(
      warning.find("/case.toml:21:11: report.targets is targets.csv: 2 of its values are later than the run, which "
                   "ends at 2 s: mean_velocity of 75 s in line 3. The run is not compared with them."),
      std::string::npos)
      << warning;
  write_next_to_the_case("targets.csv", columns + "start_velocity,40,8,m/s,x\n" + rows);
  EXPECT_EQ(warning_of_late_values(testing_support::case_from_text(changed({targets}))), "")
      << "with a separate start time";
}

TEST(ReportedValues, AreTextInUtf8) {
  const auto error_of_file = [](const std::string& bytes) {
    write_next_to_the_case("targets.csv", bytes);
    const std::string found = error_of_changed({targets}), location = "FOLDER/case.toml:21:11: report.targets: FOLDER/";
    return found.compare(0, location.size(), location) == 0 ? found.substr(location.size()) : found;
  };
  const std::string row = "mean_displacement,1,0.6,km,M\xC3\xBCller\n";
  EXPECT_EQ(error_of_file("\xEF\xBB\xBF" + columns + row), "no error");
  EXPECT_EQ(error_of_file("quantity,time_s,value,unit,source\r" + row + "\r\n\r\n"), "no error");
  EXPECT_EQ(error_of_file(columns + "mean_velocity,1,8,m/s,M\xFCller\n"),
            "targets.csv:2: byte 0xfc is not UTF-8; save the file as UTF-8");
  EXPECT_EQ(error_of_file("\xFF\xFEq"), "targets.csv: encoded as UTF-16; save it as UTF-8");
  EXPECT_EQ(error_of_file(columns + std::string("a\0b\n", 4)),
            "targets.csv:2: a zero byte; this is not a text file, or it is damaged");
  EXPECT_EQ(error_of_file(columns + "mean_velocity,4,8,m/s,\"x\n"),
            "targets.csv:2: not a row of comma-separated cells: a quote that does not end");
  EXPECT_EQ(error_of_file(""), "targets.csv: empty; expected the columns quantity, value, unit");
  EXPECT_EQ(error_of_file("quantity,time_s,value\n"),
            "targets.csv:1: no column unit; found 'quantity', 'time_s', 'value'");
  EXPECT_EQ(
      error_of_file("quantity;time_s;value;unit\n"),
      "targets.csv:1: no column quantity; found 'quantity;time_s;value;unit'. Columns are parted by commas: write , "
      "in place of ;");
  EXPECT_EQ(error_of_file("quantity,value,unit\n"),
            "targets.csv:1: give one column of times, time_s, time_min, time_h; found none");
  EXPECT_EQ(error_of_file("quantity,time_s,value,unit,sorce\n"),
            "targets.csv:1: no column is called 'sorce'; did you mean source? allowed are quantity, value, unit, "
            "time_s, time_min, time_h, source, kind");
  EXPECT_EQ(error_of_file(std::string(1100000, '#')),
            "targets.csv: the file has 1.1 MB; allowed: 1 MB. Is it the right file?");
}

// The contents of its rows are tested with the reader of the report (tests/cli/force_record_test.py).
TEST(ForceRecord, NeedsTwoPeriodsAndAReadableFile) {
  const auto error_of_report = [](const std::string& keys) {
    return error_of_changed({{"[basal]", "[report]\nforce_record = \"force.csv\"\n" + keys + "[basal]"}});
  };
  write_next_to_the_case("force.csv", "time_s,up_N,north_N,east_N\n0,0,0,0\n1,0,0,0\n");
  EXPECT_EQ(error_of_report("force_periods = [10.0, 200.0]\n"), "no error");
  EXPECT_EQ(
      error_of_report("force_periods = [10.0]\n"),
      "FOLDER/case.toml:22:17: report.force_periods is an array of 1 numbers; allowed: 2 numbers, the shortest and "
      "the longest period of the waves.");
  EXPECT_EQ(error_of_report("force_periods = [200.0, 10.0]\n")
                .find("FOLDER/case.toml:22:25: report.force_periods holds "
                      "10 after 200; allowed: ascending numbers"),
            0U);
  EXPECT_NE(error_of_report("").find("report.force_periods"), std::string::npos);
  EXPECT_NE(error_of_changed({{"[basal]", "[report]\nforce_periods = [10.0, 200.0]\n[basal]"}}).find("force_periods"),
            std::string::npos);
  write_next_to_the_case("force.csv", "time_s,up_N,north_N,east_N\n0,0,0,0\n0,0,0,0\n");
  EXPECT_EQ(error_of_report("force_periods = [10.0, 200.0]\n"),
            "FOLDER/case.toml:21:16: report.force_record: FOLDER/force.csv:3: time_s does not rise (found 0 after 0; "
            "allowed: more than that). Sort the rows by time.");
}

}  // namespace
}  // namespace thawslide::config
