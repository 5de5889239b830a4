"""Moving bottom for wave codes: thickness of the slide over time as a `dtopo` file of type 3 (GeoClaw, D-Claw).

The file contains the change of the bottom since the start [m] on a regular grid, one block per time: thickness at that
time minus thickness at the start. Format: Clawpack 5, "Topography displacement files", topotype 3.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thawslide.arrays import Numbers
from thawslide.atomic_file import atomic_file
from thawslide.binning import FIELDS, gather
from thawslide.errors import ReportError
from thawslide.maps import Grid
from thawslide.run_folder import Run


def write_dtopo(run: Run, path: Path) -> tuple[Grid, Numbers]:
    """Write the moving bottom of a 3D run on the snapshots' times; return its grid and times [s].

    GeoClaw reads times at equal intervals: NotInRunError without maps, ReportError for fewer than two snapshots or
    unequal intervals. The last snapshot of a slide at rest is moved to the next multiple of the interval.
    """
    grid = run.maps["max_thickness"].grid
    width = float(run.section("grid")["cell"])
    times = _equal_times(run)
    at_start: Numbers | None = None
    with atomic_file(path) as part, part.open("w", encoding="ascii") as file:
        file.write(_header(grid, times))
        for index in range(len(times)):
            shot = run.snapshot(index, fields=list(FIELDS))
            thickness = np.asarray(gather(grid, shot, width).thickness.values)
            at_start = thickness if at_start is None else at_start
            for row in (thickness - at_start)[::-1]:  # from north to south
                file.write(" ".join(f"{value:.6g}" for value in row) + "\n")
    return grid, times


def _equal_times(run: Run) -> Numbers:
    times = np.array(run.times, dtype=np.float64)
    if len(times) < 2:
        raise ReportError(f"{run.folder}: {len(times)} snapshot, and a moving bottom needs two or more. Repeat it.")
    step = times[1] - times[0]
    equal = times[0] + step * np.arange(len(times))
    if run.is_at_rest and len(times) > 2 and equal[-2] < times[-1] < equal[-1]:
        times[-1] = equal[-1]  # nothing moves any more
    if not np.allclose(times, equal, rtol=0.0, atol=1e-6 * step):
        raise ReportError(
            f"{run.folder}: snapshots at unequal intervals (found {', '.join(f'{time:g}' for time in times[-3:])} at "
            "the end), which GeoClaw does not read. Run the case to rest, or to a multiple of time.output_interval."
        )
    return np.asarray(equal)


def _header(grid: Grid, times: Numbers) -> str:
    values = (
        (grid.columns, "mx"),
        (grid.rows, "my"),
        (len(times), "mt"),
        (grid.x0, "xlower"),
        (grid.y0, "ylower"),
        (times[0], "t0"),
        (grid.cell_x, "dx"),
        (grid.cell_y, "dy"),
        (times[1] - times[0], "dt"),
    )
    return "".join(f"{value:<20.12g} {name}\n" for value, name in values)
