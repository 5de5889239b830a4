// Parameters of a run as a whole: [case], [time], [grid], [terrain], [checkpoint], [maps], [probe.NAME], [report].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

std::vector<Parameter<General>> general_parameters() {
  return {
      parameter(
          &General::based_on,
          {.key = "based_on", .text = "case file of the same folder that holds wherever this one gives nothing else"}),
      parameter(&General::title, {.key = "title", .text = "title for figures and reports"}),
      parameter(&General::dimension,
                {.key = "dimension", .range = between(2, 3), .text = "2: plane strain, y is up; 3: z is up"}),
      parameter(
          &General::width,
          {.key = "width",
           .unit = "m",
           .range = at_least(0),
           .text = "width that extensive results are multiplied by; 0: results per metre of width; a table over x: "
                   "width of the section at x, linear between entries and constant beyond",
           .dimension = 2}),
      parameter(&General::gravity, {.key = "gravity", .unit = "m/s2", .range = at_least(0), .text = "gravity"}),
      parameter(&General::gravity_tilt,
                {.key = "gravity_tilt",
                 .unit = "degrees",
                 .range = inside(-90, 90),
                 .text = "turn of gravity from straight down towards +x: an incline on a level grid",
                 .source = "Sec. 3.3"}),
  };
}

std::vector<Parameter<Time>> time_parameters() {
  return {
      parameter(&Time::end,
                {.key = "end", .unit = "s", .range = above(0), .text = "simulated time at which the run ends"})
          .required(),
      parameter(&Time::stepping, {.key = "stepping", .text = "how the time step is chosen"}),
      parameter(
          &Time::step,
          {.key = "step", .unit = "s", .range = above(0), .text = "the fixed time step, or the largest adaptive one"})
          .required_if("when time.stepping is \"fixed\"",
                       [](const Case&, const Time& time) { return time.stepping == Stepping::fixed; })
          .otherwise("time.end, that is no cap", [](const Case&, Time& time) { time.step = time.end; }),
      parameter(&Time::safety, {.key = "safety",
                                .range = {.low = 0, .high = 1, .low_open = true},
                                .text = "share of the smallest limit that an adaptive step takes"}),
      parameter(&Time::output_interval, {.key = "output_interval",
                                         .unit = "s",
                                         .range = above(0),
                                         .text = "simulated time between snapshots, at least a billionth of time.end"}),
      parameter(&Time::history_interval,
                {.key = "history_interval",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "simulated time between rows of history.csv, at least a billionth of time.end; 0: a row "
                         "every step. Adaptive steps are not cut to it: a row follows the first step that reaches its "
                         "time"}),
      parameter(&Time::stop_at_rest,
                {.key = "stop_at_rest",
                 .unit = "m/s",
                 .range = at_least(0),
                 .text = "the run ends before time.end when, for time.rest_time, no more than 0.5 % of the slide's "
                         "mass has been faster than this; never before more of it has; 0: it does not"})
          .otherwise("the run continues to time.end"),
      parameter(&Time::rest_time,
                {.key = "rest_time",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "how long the slide has to be slower than time.stop_at_rest for the run to end"})
          .only_if("when time.stop_at_rest is given", "stop_at_rest",
                   [](const Case&, const Time& time) { return time.stop_at_rest >= 0.0; }),
  };
}

std::vector<Parameter<Grid>> grid_parameters() {
  return {
      parameter(&Grid::cell, {.key = "cell", .unit = "m", .range = above(0), .text = "side of a grid cell"}).required(),
      parameter(&Grid::min, {.key = "min", .unit = "m", .text = "lowest corner of the domain"}).required(),
      parameter(&Grid::max, {.key = "max", .unit = "m", .text = "highest corner of the domain"}).required(),
      parameter(&Grid::leaving,
                {.key = "leaving", .text = "what becomes of particles that leave the domain or the DEM"}),
  };
}

// Guards without a choice between stopping and removing indicate a wrong step or case. Removing single particles would
// not correct such a run.
std::vector<Parameter<Guards>> guard_parameters() {
  return {
      parameter(&Guards::not_finite, {.key = "not_finite",
                                      .text = "what becomes of particles whose position, volume, stress, "
                                              "temperature or pore pressure is not a finite number"}),
      parameter(&Guards::volume, {.key = "volume",
                                  .text = "what becomes of particles that invert (det F <= 0), or whose volume over "
                                          "that of t = 0 leaves guards.smallest_volume to guards.largest_volume"}),
      parameter(&Guards::smallest_volume,
                {.key = "smallest_volume",
                 .range = {.low = 0, .high = 1, .high_open = true},
                 .text = "smallest volume of a particle over that of t = 0, checked every 10 steps"}),
      parameter(&Guards::largest_volume,
                {.key = "largest_volume",
                 .range = {.low = 1, .low_open = true, .infinity_allowed = true},
                 .text = "largest volume of a particle over that of t = 0, checked every 10 steps; inf: any"}),
      parameter(&Guards::removed_mass, {.key = "removed_mass",
                                        .range = between(0, 1),
                                        .text = "fraction of all mass that guards may remove before the run ends"}),
      parameter(&Guards::energy_growth,
                {.key = "energy_growth",
                 .range = {.low = 0, .low_open = true, .infinity_allowed = true},
                 .text = "growth of energy without a physical cause within some 500 steps, as a fraction of the energy "
                         "so far (at least of a fall by a cell), that ends the run, checked every 10 steps; inf: any"}),
      parameter(&Guards::smallest_step,
                {.key = "smallest_step",
                 .range = {.low = 0, .high = 1, .high_open = true},
                 .text = "smallest adaptive step over the first one, below which the run ends; 0: any"}),
      parameter(&Guards::most_steps,
                {.key = "most_steps",
                 .range = {.low = 1, .infinity_allowed = true},
                 .text = "steps still to come, at the length of the next adaptive one, above which the run ends"}),
  };
}

bool has_file(const Case&, const Terrain& terrain) {
  return terrain.kind == TerrainKind::profile || terrain.kind == TerrainKind::dem;
}
bool is_dem(const Case&, const Terrain& terrain) { return terrain.kind == TerrainKind::dem; }
bool is_no_dem(const Case&, const Terrain& terrain) { return terrain.kind != TerrainKind::dem; }

std::vector<Parameter<Terrain>> dem_parameters() {
  const std::string when_dem = "when terrain.type is \"dem\"";
  return {
      parameter(&Terrain::crs, {.key = "crs",
                                .text = "coordinate reference system of a DEM whose file has none, or a wrong one, as "
                                        "\"EPSG:31287\"; \"\": that of the file"})
          .only_if(when_dem, "type", is_dem),
      parameter(&Terrain::resample, {.key = "resample",
                                     .unit = "m",
                                     .range = at_least(0),
                                     .text = "distance of points that the DEM is brought to; 0: as the file has them"})
          .only_if(when_dem, "type", is_dem),
      parameter(&Terrain::smooth, {.key = "smooth",
                                   .unit = "m",
                                   .range = at_least(0),
                                   .text = "standard deviation of a Gaussian filter over the DEM; 0: no filter; auto: "
                                           "what the DEM's noise and short bumps need, none on smooth ground"})
          .only_if(when_dem, "type", is_dem),
  };
}

std::vector<Parameter<Terrain>> terrain_parameters() {
  const std::string when_no_dem = "when terrain.type is not \"dem\"";
  std::vector<Parameter<Terrain>> result{
      parameter(&Terrain::kind, {.key = "type", .text = "the rigid ground that bodies slide on"}),
      parameter(&Terrain::elevation,
                {.key = "elevation", .unit = "m", .text = "elevation of the flat ground, or of the plane at x = 0"})
          .only_if(when_no_dem, "type", is_no_dem),
      parameter(&Terrain::slope, {.key = "slope",
                                  .unit = "degrees",
                                  .range = inside(-90, 90),
                                  .text = "slope of the plane, which falls towards +x"})
          .only_if(when_no_dem, "type", is_no_dem),
      parameter(
          &Terrain::file,
          {.key = "file",
           .text = "profile: CSV file with the columns distance_m,terrain_elevation_m[,surface_elevation_m]; dem: "
                   "GeoTIFF or ESRI ASCII grid",
           .is_path = true})
          .required_if("when terrain.type is \"profile\" or \"dem\"", has_file),
      parameter(&Terrain::extend,
                {.key = "extend", .text = "continue the last gradient of the profile where the domain is longer"})
          .only_if(when_no_dem, "type", is_no_dem),
      parameter(&Terrain::form, {.key = "representation",
                                 .text = "representation of the terrain at the grid nodes",
                                 .formerly = "description"}),
      parameter(&Terrain::layers, {.key = "layers",
                                   .range = between(1, 1000),
                                   .text = "layers of rigid points, two to a cell",
                                   .source = "Secs. 3.3, 4"})
          .only_if(when_no_dem, "type", is_no_dem),
  };
  for (auto& of_dem : dem_parameters()) {
    result.push_back(std::move(of_dem));
  }
  return result;
}

std::vector<Parameter<Checkpoint>> checkpoint_parameters() {
  return {
      parameter(&Checkpoint::interval,
                {.key = "interval",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "simulated time between checkpoints, at least a billionth of time.end; 0: none by "
                         "simulated time"}),
      parameter(&Checkpoint::wall_interval,
                {.key = "wall_interval",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "wall-clock time between checkpoints; 0: none by wall-clock time. One is written before the "
                         "first step and one at the end anyhow, and the one before the last is kept"})};
}

std::vector<Parameter<Maps>> map_parameters() {
  return {
      parameter(&Maps::cell,
                {.key = "cell",
                 .unit = "m",
                 .range = at_least(0),
                 .text = "side of a map's cell; 0: as many of the DEM's cells as it takes to be as wide as "
                         "grid.cell and three particle distances; without a DEM grid.cell",
                 .dimension = 3}),
      parameter(&Maps::arrival_thickness, {.key = "arrival_thickness",
                                           .unit = "m",
                                           .range = above(0),
                                           .text = "thickness from which on the slide has arrived at a place",
                                           .dimension = 3}),
      parameter(&Maps::path, {.key = "path",
                              .text = "file of the line along which the front is measured, and `thawslide block` "
                                      "slides; \"\": the path of the centre of mass",
                              .dimension = 3,
                              .is_path = true}),
  };
}

std::vector<Parameter<Probe>> probe_parameters() {
  const auto has_no_line = [](const Case& whole, const Probe& probe) {
    return whole.general.dimension == 3 && probe.line.empty();
  };
  return {
      parameter(&Probe::point,
                {.key = "point", .unit = "m", .text = "place of the probe on the map", .horizontal = true})
          .required_if("when line is not given", has_no_line),
      parameter(&Probe::line, {.key = "line", .text = "file of the line of a cross section", .is_path = true})
          .otherwise("no line, but a point"),
  };
}

std::vector<Parameter<Report>> report_parameters() {
  const std::string when_record = "when force_record is given";
  const auto has_record = [](const Case&, const Report& report) { return !report.force_record.empty(); };
  return {
      parameter(&Report::times,
                {.key = "times",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "times of the snapshot figures, on their clock; []: at 0, 20, ..., 100 % of the "
                         "final mean displacement"}),
      parameter(&Report::targets, {.key = "targets",
                                   .text = "CSV file of reported values, columns "
                                           "quantity,time_s,value,unit,source,kind",
                                   .is_path = true}),
      parameter(&Report::force_record,
                {.key = "force_record",
                 .text = "CSV file of a force inverted from seismic waves, of the slide on the Earth, to draw next to "
                         "that of the run, columns time_s,up_N,north_N,east_N; \"\": none",
                 .is_path = true}),
      parameter(&Report::force_periods, {.key = "force_periods",
                                         .unit = "s",
                                         .range = above(0),
                                         .text = "shortest and longest period of the waves of force_record, to which "
                                                 "both forces are filtered"})
          .required_if(when_record, has_record)
          .only_if(when_record, "force_record", has_record),
      parameter(&Report::force_source, {.key = "force_source", .text = "who inverted force_record, for the legend"})
          .only_if(when_record, "force_record", has_record),
  };
}

}  // namespace

void declare_run(Tables& tables) {
  tables.push_back(
      std::make_unique<SingleTable<General>>("case", "The case as a whole", &Case::general, general_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Time>>("time", "Time, its steps and outputs", &Case::time, time_parameters()));
  tables.push_back(std::make_unique<SingleTable<Grid>>("grid", "The background grid", &Case::grid, grid_parameters()));
  tables.push_back(std::make_unique<SingleTable<Grid>>("grid.boundary", "Velocity conditions at the sides of the grid",
                                                       &Case::grid, six_sides(&Grid::boundary, "velocity condition")));
  tables.push_back(std::make_unique<SingleTable<Guards>>("guards", "Limits that abort a failing run", &Case::guards,
                                                         guard_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Terrain>>("terrain", "The ground", &Case::terrain, terrain_parameters()));
  tables.push_back(std::make_unique<SingleTable<Checkpoint>>("checkpoint", "States to resume from", &Case::checkpoint,
                                                             checkpoint_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Maps>>("maps", "Maps of the slide, in 3D", &Case::maps, map_parameters()));
  tables.push_back(std::make_unique<NamedTable<Probe>>("probe",
                                                       "A place or a cross section, by a name of your choice, at which "
                                                       "thickness and speed are written, in 3D; of a cross "
                                                       "section its flow area and discharge too",
                                                       &Case::probes, probe_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Report>>("report", "Figures and comparisons", &Case::report, report_parameters()));
}

}  // namespace thawslide::config
