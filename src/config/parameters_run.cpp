// Parameters of a run as a whole: [case], [time], [grid], [terrain], [checkpoint], [maps], [probe.NAME], [report].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

std::vector<Parameter<General>> general_parameters() {
  return {
      parameter(&General::based_on,
                {.key = "based_on",
                 .text = "case file of the same folder that supplies all keys not specified here; \"\": none"}),
      parameter(&General::title, {.key = "title", .text = "title of figures and reports"}),
      parameter(&General::dimension, {.key = "dimension",
                                      .range = between(2, 3),
                                      .text = "number of dimensions; 2: plane strain with y up, 3: z up"}),
      parameter(&General::width, {.key = "width",
                                  .unit = "m",
                                  .range = at_least(0),
                                  .text = "width that multiplies extensive results; 0: results per metre of width; a "
                                          "table over x: width at x, linear between entries and constant beyond",
                                  .dimension = 2}),
      parameter(&General::gravity,
                {.key = "gravity", .unit = "m/s2", .range = at_least(0), .text = "gravitational acceleration"}),
      parameter(
          &General::gravity_tilt,
          {.key = "gravity_tilt",
           .unit = "degrees",
           .range = inside(-90, 90),
           .text = "angle by which gravity is rotated from the vertical towards +x, for an incline on a level grid",
           .source = "Lei et al., Sec. 3.3"}),
  };
}

std::vector<Parameter<Time>> time_parameters() {
  return {
      parameter(&Time::end,
                {.key = "end", .unit = "s", .range = above(0), .text = "simulated time at which the run ends"})
          .required(),
      parameter(&Time::stepping, {.key = "stepping", .text = "choice of the time step"}),
      parameter(&Time::step, {.key = "step",
                              .unit = "s",
                              .range = above(0),
                              .text = "fixed time step, or upper limit of the adaptive time step"})
          .required_if("when time.stepping is \"fixed\"",
                       [](const Case&, const Time& time) { return time.stepping == Stepping::fixed; })
          .otherwise("no upper limit", [](const Case&, Time& time) { time.step = time.end; }),
      parameter(&Time::safety,
                {.key = "safety",
                 .range = {.low = 0, .high = 1, .low_open = true},
                 .text = "safety factor of the adaptive time step: fraction of the smallest stability limit"}),
      parameter(&Time::output_interval, {.key = "output_interval",
                                         .unit = "s",
                                         .range = above(0),
                                         .text = "simulated time between snapshots, at least a billionth of time.end"}),
      parameter(&Time::history_interval,
                {.key = "history_interval",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "simulated time between rows of history.csv, at least a billionth of time.end; 0: one row per "
                         "step. Adaptive steps are not shortened: a row follows the first step that reaches its time"}),
      parameter(&Time::stop_at_rest,
                {.key = "stop_at_rest",
                 .unit = "m/s",
                 .range = at_least(0),
                 .text = "speed at rest: the run ends when at most 0.5 % of the mass has been faster for "
                         "time.rest_time, and more was faster before; 0: no stop at rest"})
          .otherwise("no stop at rest"),
      parameter(
          &Time::rest_time,
          {.key = "rest_time", .unit = "s", .range = at_least(0), .text = "duration of rest after which the run ends"})
          .only_if("when time.stop_at_rest is given", "stop_at_rest",
                   [](const Case&, const Time& time) { return time.stop_at_rest >= 0.0; }),
      parameter(&Time::moved_distance,
                {.key = "moved_distance",
                 .unit = "m",
                 .range = at_least(0),
                 .text = "travel distance beyond which a body has moved: only such bodies count for front, runout, "
                         "travel distance and rest. All count while no more than 0.5 % has moved that far"}),
  };
}

std::vector<Parameter<Grid>> grid_parameters() {
  return {
      parameter(&Grid::cell, {.key = "cell", .unit = "m", .range = above(0), .text = "side length of a grid cell"})
          .required(),
      parameter(&Grid::min, {.key = "min", .unit = "m", .text = "minimum coordinates of the domain"}).required(),
      parameter(&Grid::max, {.key = "max", .unit = "m", .text = "maximum coordinates of the domain"}).required(),
      parameter(&Grid::leaving, {.key = "leaving", .text = "treatment of particles that leave the domain or the DEM"}),
      parameter(&Grid::steepest,
                {.key = "steepest",
                 .unit = "degrees",
                 .range = between(30, 85),
                 .text = "slope limit of cells, which follow the terrain: columns that rise more steeply from others "
                         "are lowered, because the time step shortens with the slope"}),
  };
}

// Guards without a choice between stopping and removing indicate a wrong step or case. Removing single particles would
// not correct such a run.
std::vector<Parameter<Guards>> guard_parameters() {
  return {
      parameter(&Guards::not_finite, {.key = "not_finite",
                                      .text = "treatment of particles whose position, volume, stress, temperature or "
                                              "pore pressure is not a finite number"}),
      parameter(&Guards::volume, {.key = "volume",
                                  .text = "treatment of particles that invert (det F <= 0), or whose volume relative "
                                          "to t = 0 is outside guards.smallest_volume to guards.largest_volume"}),
      parameter(&Guards::smallest_volume,
                {.key = "smallest_volume",
                 .range = {.low = 0, .high = 1, .high_open = true},
                 .text = "minimum volume of a particle relative to t = 0, checked every 10 steps"}),
      parameter(&Guards::largest_volume,
                {.key = "largest_volume",
                 .range = {.low = 1, .low_open = true, .infinity_allowed = true},
                 .text = "maximum volume of a particle relative to t = 0, checked every 10 steps; inf: no limit"}),
      parameter(&Guards::removed_mass,
                {.key = "removed_mass",
                 .range = between(0, 1),
                 .text = "maximum fraction of the total mass that guards may remove; beyond it, the run ends"}),
      parameter(&Guards::energy_growth,
                {.key = "energy_growth",
                 .range = {.low = 0, .low_open = true, .infinity_allowed = true},
                 .text = "maximum growth of energy without a physical cause within about 500 steps, relative to the "
                         "largest energy so far, checked every 10 steps; inf: no limit. The reference is at least the "
                         "energy of a fall by one cell"}),
      parameter(&Guards::smallest_step,
                {.key = "smallest_step",
                 .range = {.low = 0, .high = 1, .high_open = true},
                 .text = "minimum adaptive time step relative to the first one; below it, the run ends; 0: no limit"}),
      parameter(&Guards::most_steps, {.key = "most_steps",
                                      .range = {.low = 1, .infinity_allowed = true},
                                      .text = "maximum number of remaining time steps at the length of the next one; "
                                              "beyond it, the run ends; inf: no limit"}),
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
                                .text = "coordinate reference system of a DEM whose file has none or a wrong one, such "
                                        "as \"EPSG:31287\"; \"\": as in the file"})
          .only_if(when_dem, "type", is_dem),
      parameter(&Terrain::resample, {.key = "resample",
                                     .unit = "m",
                                     .range = at_least(0),
                                     .text = "point spacing to which the DEM is resampled; 0: spacing of the file"})
          .only_if(when_dem, "type", is_dem),
      parameter(&Terrain::smooth,
                {.key = "smooth",
                 .unit = "m",
                 .range = at_least(0),
                 .text = "standard deviation of the Gaussian filter applied to the DEM; 0: no filter; auto: determined "
                         "by noise and short bumps of the DEM, no filter on smooth terrain"})
          .only_if(when_dem, "type", is_dem),
  };
}

std::vector<Parameter<Terrain>> terrain_parameters() {
  const std::string when_no_dem = "when terrain.type is not \"dem\"";
  std::vector<Parameter<Terrain>> result{
      parameter(&Terrain::kind, {.key = "type", .text = "type of the rigid terrain"}),
      parameter(&Terrain::elevation,
                {.key = "elevation", .unit = "m", .text = "elevation of the flat terrain, or of the plane at x = 0"})
          .only_if(when_no_dem, "type", is_no_dem),
      parameter(&Terrain::slope, {.key = "slope",
                                  .unit = "degrees",
                                  .range = inside(-90, 90),
                                  .text = "slope angle of the plane, positive if it falls towards +x"})
          .only_if(when_no_dem, "type", is_no_dem),
      parameter(&Terrain::file,
                {.key = "file",
                 .text = "file of the terrain; profile: CSV file with the columns "
                         "distance_m,terrain_elevation_m[,surface_elevation_m]; dem: GeoTIFF or ESRI ASCII grid",
                 .is_path = true})
          .required_if("when terrain.type is \"profile\" or \"dem\"", has_file),
      parameter(&Terrain::extend,
                {.key = "extend",
                 .text = "true: the profile continues with its last gradients to the ends of a longer domain"})
          .only_if(when_no_dem, "type", is_no_dem),
  };
  for (auto& of_dem : dem_parameters()) {
    result.push_back(std::move(of_dem));
  }
  return result;
}

std::vector<Parameter<Checkpoint>> checkpoint_parameters() {
  return {parameter(&Checkpoint::interval, {.key = "interval",
                                            .unit = "s",
                                            .range = at_least(0),
                                            .text = "simulated time between checkpoints, at least a billionth of "
                                                    "time.end; 0: no checkpoints by simulated time"}),
          parameter(&Checkpoint::wall_interval,
                    {.key = "wall_interval",
                     .unit = "s",
                     .range = at_least(0),
                     .text = "wall-clock time between checkpoints, in addition to those before the first step and at "
                             "the end; the last two are kept; 0: no checkpoints by wall-clock time"})};
}

std::vector<Parameter<Maps>> map_parameters() {
  return {
      parameter(&Maps::cell, {.key = "cell",
                              .unit = "m",
                              .range = at_least(0),
                              .text = "cell size of the maps; 0: smallest multiple of the DEM cell that is at least "
                                      "grid.cell and three particle spacings, or grid.cell without a DEM",
                              .dimension = 3}),
      parameter(&Maps::arrival_thickness, {.key = "arrival_thickness",
                                           .unit = "m",
                                           .range = above(0),
                                           .text = "flow thickness above which the sliding mass has arrived",
                                           .dimension = 3}),
      parameter(&Maps::area_thickness, {.key = "area_thickness",
                                        .unit = "m",
                                        .range = above(0),
                                        .text = "thickness above which ground counts in the deposit area and the "
                                                "inundated area of run.json",
                                        .dimension = 3}),
      parameter(&Maps::path, {.key = "path",
                              .text = "file of the flow path along which the front is measured and `thawslide block` "
                                      "slides; \"\": path of the centre of mass",
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
                {.key = "point", .unit = "m", .text = "horizontal coordinates of the probe", .horizontal = true})
          .required_if("when line is not given", has_no_line),
      parameter(&Probe::line, {.key = "line", .text = "file of the line of the cross section", .is_path = true})
          .otherwise("the probe is a point"),
  };
}

std::vector<Parameter<Report>> report_parameters() {
  const std::string when_record = "when force_record is given";
  const auto has_record = [](const Case&, const Report& report) { return !report.force_record.empty(); };
  return {
      parameter(&Report::author, {.key = "author", .text = "name or office that the report and the summary state"}),
      parameter(&Report::scenario,
                {.key = "scenario", .text = "sentences with which the description of the event in the report begins"}),
      parameter(&Report::logo,
                {.key = "logo",
                 .text = "image at the top of the report and the summary, a PNG or JPEG file; \"\": none",
                 .is_path = true}),
      parameter(&Report::times, {.key = "times",
                                 .unit = "s",
                                 .range = at_least(0),
                                 .text = "times of the snapshot figures since the start of the run; "
                                         "[]: at 0, 20, ..., 100 % of the final mean displacement"}),
      parameter(
          &Report::targets,
          {.key = "targets",
           .text = "CSV file of reported values with the columns quantity,time_s,value,unit,source,kind; \"\": none",
           .is_path = true}),
      parameter(&Report::force_record,
                {.key = "force_record",
                 .text = "CSV file of the force on the Earth, inverted from seismic waves, to plot next to that of the "
                         "run; columns time_s,up_N,north_N,east_N; \"\": none",
                 .is_path = true}),
      parameter(&Report::force_periods,
                {.key = "force_periods",
                 .unit = "s",
                 .range = above(0),
                 .text = "shortest and longest period of the waves in force_record, to which both forces are filtered"})
          .required_if(when_record, has_record)
          .only_if(when_record, "force_record", has_record),
      parameter(&Report::force_source, {.key = "force_source", .text = "publication of the inversion, for the legend"})
          .only_if(when_record, "force_record", has_record),
  };
}

}  // namespace

void declare_run(Tables& tables) {
  tables.push_back(
      std::make_unique<SingleTable<General>>("case", "The case as a whole", &Case::general, general_parameters()));
  tables.push_back(std::make_unique<SingleTable<Time>>("time", "Simulated time, time steps and output intervals",
                                                       &Case::time, time_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Grid>>("grid", "Background grid and domain", &Case::grid, grid_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Grid>>("grid.boundary", "Velocity boundary conditions on the sides of the grid",
                                          &Case::grid, six_sides(&Grid::boundary, "velocity boundary condition")));
  tables.push_back(std::make_unique<SingleTable<Guards>>("guards", "Limits beyond which a run has failed",
                                                         &Case::guards, guard_parameters()));
  tables.push_back(std::make_unique<SingleTable<Terrain>>("terrain", "Terrain on which bodies slide", &Case::terrain,
                                                          terrain_parameters()));
  tables.push_back(std::make_unique<SingleTable<Checkpoint>>(
      "checkpoint", "Checkpoints, from which a run can be resumed", &Case::checkpoint, checkpoint_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Maps>>("maps", "Maps of the sliding mass, in 3D", &Case::maps, map_parameters()));
  tables.push_back(std::make_unique<NamedTable<Probe>>(
      "probe",
      "A point or cross section with a name of your choice, in 3D. Flow thickness and speed are recorded there, and at "
      "a cross section also flow area and discharge",
      &Case::probes, probe_parameters()));
  tables.push_back(std::make_unique<SingleTable<Report>>("report", "Figures and comparison with reported values",
                                                         &Case::report, report_parameters()));
}

}  // namespace thawslide::config
