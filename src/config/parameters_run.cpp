// Parameters of [case], [time], [grid], [guards], [terrain], [checkpoint], [maps], [probe.NAME], [report].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

void declare_times(Tables& tables) {
  declare(
      tables, "time", "Simulated time, time steps and output intervals", &Case::time,
      {parameter(&Time::end, "end", "s", above(0), "simulated time at which the run ends").required(),
       parameter(&Time::stepping, "stepping", "choice of the time step"),
       parameter(&Time::step, "step", "s", above(0), "fixed time step, or upper limit of the adaptive time step")
           .required_if(if_is(&Time::stepping, Stepping::fixed, "time.stepping", "stepping"))
           .otherwise("no upper limit", [](const Case&, Time& time) { time.step = time.end; }),
       parameter(&Time::safety, "safety", "", {.low = 0, .high = 1, .low_open = true},
                 "safety factor of the adaptive time step: fraction of the smallest stability limit"),
       parameter(&Time::output_interval, "output_interval", "s", above(0),
                 "simulated time between snapshots, at least a billionth of time.end"),
       parameter(&Time::history_interval, "history_interval", "s", at_least(0),
                 "simulated time between rows of history.csv, at least a billionth of time.end; 0: one row per step. "
                 "Adaptive steps are not shortened: a row follows the first step that reaches its time"),
       parameter(&Time::stop_at_rest, "stop_at_rest", "m/s", at_least(0),
                 "speed at rest: the run ends when at most 0.5 % of the mass has been faster for time.rest_time, and "
                 "more was faster before; 0: no stop at rest")
           .otherwise("no stop at rest"),
       parameter(&Time::rest_time, "rest_time", "s", at_least(0), "duration of rest after which the run ends")
           .only_if({"when time.stop_at_rest is given", "stop_at_rest",
                     [](const Case&, const Time& time) { return time.stop_at_rest >= 0.0; }}),
       parameter(&Time::moved_distance, "moved_distance", "m", at_least(0),
                 "travel distance beyond which a body has moved: only such bodies count for front, runout, travel "
                 "distance and rest. All count while no more than 0.5 % has moved that far")});
}

void declare_grid(Tables& tables) {
  declare(tables, "grid", "Background grid and domain", &Case::grid,
          {parameter(&Grid::cell, "cell", "m", above(0), "side length of a grid cell").required(),
           parameter(&Grid::min, "min", "m", {}, "minimum coordinates of the domain").required(),
           parameter(&Grid::max, "max", "m", {}, "maximum coordinates of the domain").required(),
           parameter(&Grid::leaving, "leaving", "treatment of particles that leave the domain or the DEM"),
           parameter(&Grid::steepest, "steepest", "degrees", between(30, 85),
                     "slope limit of cells, which follow the terrain: columns that rise more steeply from others are "
                     "lowered, because the time step shortens with the slope")});
  declare(tables, "grid.boundary", "Velocity boundary conditions on the sides of the grid", &Case::grid,
          six_sides(&Grid::boundary, "velocity boundary condition"));
  // Guards without a choice indicate a wrong step or case, which removing particles would not correct.
  declare(
      tables, "guards", "Limits beyond which a run has failed", &Case::guards,
      {parameter(&Guards::not_finite, "not_finite",
                 "treatment of particles whose position, volume, stress, temperature or pore pressure is not a finite "
                 "number"),
       parameter(&Guards::volume, "volume",
                 "treatment of particles that invert (det F <= 0), or whose volume relative to t = 0 is outside "
                 "guards.smallest_volume to guards.largest_volume"),
       parameter(&Guards::smallest_volume, "smallest_volume", "", {.low = 0, .high = 1, .high_open = true},
                 "minimum volume of a particle relative to t = 0, checked every 10 steps"),
       parameter(&Guards::largest_volume, "largest_volume", "", {.low = 1, .low_open = true, .infinity_allowed = true},
                 "maximum volume of a particle relative to t = 0, checked every 10 steps; inf: no limit"),
       parameter(&Guards::removed_mass, "removed_mass", "", between(0, 1),
                 "maximum fraction of the total mass that guards may remove; beyond it, the run ends"),
       parameter(
           &Guards::energy_growth, "energy_growth", "", {.low = 0, .low_open = true, .infinity_allowed = true},
           "maximum growth of energy without a physical cause within about 500 steps, relative to the largest energy "
           "so far, checked every 10 steps; inf: no limit. The reference is at least the energy of a fall by one cell"),
       parameter(&Guards::smallest_step, "smallest_step", "", {.low = 0, .high = 1, .high_open = true},
                 "minimum adaptive time step relative to the first one; below it, the run ends; 0: no limit"),
       parameter(&Guards::most_steps, "most_steps", "", {.low = 1, .infinity_allowed = true},
                 "maximum number of remaining time steps at the length of the next one; beyond it, the run ends; inf: "
                 "no limit")});
}

void declare_terrain(Tables& tables) {
  const Condition<Terrain> no_dem{"when terrain.type is not \"dem\"", "type",
                                  [](const Case&, const Terrain& terrain) { return terrain.kind != TerrainKind::dem; }};
  const auto on_dem = if_is(&Terrain::kind, TerrainKind::dem, "terrain.type", "type");
  const auto on_plane = if_is(&Terrain::kind, TerrainKind::plane, "terrain.type", "type");
  declare(
      tables, "terrain", "Terrain on which bodies slide", &Case::terrain,
      joined<Terrain>(
          {{parameter(&Terrain::kind, "type", "type of the rigid terrain"),
            parameter(&Terrain::elevation, "elevation", "m", {},
                      "elevation of the flat terrain, or of the plane at x = 0")
                .only_if(no_dem),
            parameter(&Terrain::slope, "slope", "degrees", inside(-90, 90),
                      "slope angle of the plane, positive if it falls towards +x")
                .only_if(on_plane),
            parameter(&Terrain::file, "file",
                      "file of the terrain; profile: CSV file with the columns "
                      "distance_m,terrain_elevation_m[,surface_elevation_m]; dem: GeoTIFF or ESRI ASCII grid",
                      {.is_path = true})
                .required_if({"when terrain.type is \"profile\" or \"dem\"", "type",
                              [](const Case& whole, const Terrain&) { return has_terrain(whole); }}),
            parameter(&Terrain::extend, "extend",
                      "true: the profile continues with its last gradients to the ends of a longer domain")
                .only_if(no_dem)},
           only_if(
               on_dem,
               {parameter(
                    &Terrain::crs, "crs",
                    "coordinate reference system of a DEM whose file has none or a wrong one, such as \"EPSG:31287\"; "
                    "\"\": as in the file"),
                parameter(&Terrain::resample, "resample", "m", at_least(0),
                          "point spacing to which the DEM is resampled; 0: spacing of the file"),
                parameter(&Terrain::smooth, "smooth", "m", at_least(0),
                          "standard deviation of the Gaussian filter applied to the DEM; 0: no filter; auto: "
                          "determined by noise and short bumps of the DEM, no filter on smooth terrain")})}));
}

void declare_output(Tables& tables) {
  const Condition<Report> record{"when force_record is given", "force_record",
                                 [](const Case&, const Report& report) { return !report.force_record.empty(); }};
  declare(
      tables, "checkpoint", "Checkpoints, from which a run can be resumed", &Case::checkpoint,
      {parameter(
           &Checkpoint::interval, "interval", "s", at_least(0),
           "simulated time between checkpoints, at least a billionth of time.end; 0: no checkpoints by simulated time"),
       parameter(&Checkpoint::wall_interval, "wall_interval", "s", at_least(0),
                 "wall-clock time between checkpoints, in addition to those before the first step and at the end; the "
                 "last two are kept; 0: no checkpoints by wall-clock time")});
  declare(
      tables, "maps", "Maps of the sliding mass, in 3D", &Case::maps,
      {parameter(&Maps::cell, "cell", "m", at_least(0),
                 "cell size of the maps; 0: smallest multiple of the DEM cell that is at least grid.cell and three "
                 "particle spacings, or grid.cell without a DEM",
                 {.dimension = 3}),
       parameter(&Maps::arrival_thickness, "arrival_thickness", "m", above(0),
                 "flow thickness above which the sliding mass has arrived", {.dimension = 3}),
       parameter(&Maps::area_thickness, "area_thickness", "m", above(0),
                 "thickness above which ground counts in the deposit area and the inundated area of run.json",
                 {.dimension = 3}),
       parameter(&Maps::path, "path",
                 "file of the flow path along which the front is measured and `thawslide block` slides; \"\": path of "
                 "the centre of mass",
                 {.dimension = 3, .is_path = true})});
  declare(tables, "probe",
          "A point or cross section with a name of your choice, in 3D. Flow thickness and speed are recorded there, "
          "and at a cross section also flow area and discharge",
          &Case::probes,
          {parameter(&Probe::point, "point", "m", {}, "horizontal coordinates of the probe",
                     {.dimension = 3, .horizontal = true})
               .required_if({"when line is not given", "line",
                             [](const Case& whole, const Probe& probe) {
                               return whole.general.dimension == 3 && probe.line.empty();
                             }}),
           parameter(&Probe::line, "line", "file of the line of the cross section", {.dimension = 3, .is_path = true})
               .otherwise("the probe is a point")});
  declare(
      tables, "report", "Figures and comparison with reported values", &Case::report,
      {parameter(&Report::author, "author", "name or office that the report and the summary state"),
       parameter(&Report::scenario, "scenario",
                 "sentences with which the description of the event in the report begins"),
       parameter(&Report::logo, "logo",
                 "image at the top of the report and the summary, a PNG or JPEG file; \"\": none", {.is_path = true}),
       parameter(&Report::times, "times", "s", at_least(0),
                 "times of the snapshot figures since the start of the run; []: at 0, 20, ..., 100 % of the final mean "
                 "displacement"),
       parameter(&Report::targets, "targets",
                 "CSV file of reported values with the columns quantity,time_s,value,unit,source,kind; \"\": none",
                 {.is_path = true}),
       parameter(&Report::force_record, "force_record",
                 "CSV file of the force on the Earth, inverted from seismic waves, to plot next to that of the run; "
                 "columns time_s,up_N,north_N,east_N; \"\": none",
                 {.is_path = true}),
       parameter(&Report::force_periods, "force_periods", "s", above(0),
                 "shortest and longest period of the waves in force_record, to which both forces are filtered")
           .required_if(record)
           .only_if(record),
       parameter(&Report::force_source, "force_source", "publication of the inversion, for the legend")
           .only_if(record)});
}

}  // namespace

void declare_run(Tables& tables) {
  declare(
      tables, "case", "The case as a whole", &Case::general,
      {parameter(&General::based_on, "based_on",
                 "case file of the same folder that supplies all keys not specified here; \"\": none"),
       parameter(&General::title, "title", "title of figures and reports"),
       parameter(&General::dimension, "dimension", "", between(2, 3),
                 "number of dimensions; 2: plane strain with y up, 3: z up"),
       parameter(&General::width, "width", "m", at_least(0),
                 "width that multiplies extensive results; 0: results per metre of width; a table over x: width at x, "
                 "linear between entries and constant beyond",
                 {.dimension = 2}),
       parameter(&General::gravity, "gravity", "m/s2", at_least(0), "gravitational acceleration"),
       parameter(&General::gravity_tilt, "gravity_tilt", "degrees", inside(-90, 90),
                 "angle by which gravity is rotated from the vertical towards +x, for an incline on a level grid",
                 {.source = "Lei et al., Sec. 3.3"})});
  declare_times(tables);
  declare_grid(tables);
  declare_terrain(tables);
  declare_output(tables);
}

}  // namespace thawslide::config
