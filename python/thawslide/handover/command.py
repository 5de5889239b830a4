"""Commands `thawslide terrain`, `thawslide export` and `thawslide assets`: results of a run for other programs."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from thawslide.commands import print_line
from thawslide.errors import ReportError
from thawslide.handover.assets import Asset, assets_hit, write_assets
from thawslide.handover.dtopo import write_dtopo
from thawslide.handover.hydrographs import hydrographs, write_hydrographs
from thawslide.handover.terrain import terrain_after
from thawslide.number_text import plain_text
from thawslide.run_folder import Run


def terrain(arguments: Sequence[str] | None = None) -> int:
    """Run `thawslide terrain`; return the exit code, 2 for an error of the user."""
    parser = argparse.ArgumentParser(
        prog="thawslide terrain",
        description="Write the terrain after a run, without the release and with the deposit, for a next event.",
    )
    _add_run(parser)
    parser.add_argument(
        "--dem",
        metavar="FILE",
        type=Path,
        help="terrain before the event (default: that of the run, which is filtered)",
    )
    parser.add_argument("--output", metavar="FILE", type=Path, help="GeoTIFF (default: RUN/terrain-after.tif)")
    parser.add_argument("--overwrite", action="store_true", help="replace an existing file")
    given = parser.parse_args(arguments)

    def write() -> None:
        output = given.output or given.run / "terrain-after.tif"
        _require_new(output, given.overwrite)
        after = terrain_after(Run(given.run), given.dem)
        after.write(output)
        for note in after.notes:
            print_line(f"thawslide terrain: {note}", sys.stderr)
        taken = f", {plain_text(after.removed)} m3 of the release removed" if after.removed > 0.0 else ""
        print_line(
            f"deposit: {plain_text(after.deposit)} m3 added ({plain_text(after.deposit_of_run)} m3 on the map){taken}"
        )
        print_line(f"terrain: {output}")

    return _ended("terrain", write)


def export(arguments: Sequence[str] | None = None) -> int:
    """Run `thawslide export`; return the exit code, 2 for an error of the user."""
    parser = argparse.ArgumentParser(
        prog="thawslide export",
        description="Write a run for other programs: moving bottom of wave codes, inflow of flood codes.",
    )
    _add_run(parser)
    parser.add_argument(
        "--dtopo",
        metavar="FILE",
        type=Path,
        help="moving bottom at the times of the snapshots, dtopo type 3 (GeoClaw, D-Claw)",
    )
    parser.add_argument(
        "--hydrographs", metavar="FOLDER", type=Path, help="discharge at each line of the probes, one CSV file per line"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace existing files")
    given = parser.parse_args(arguments)

    def write() -> None:
        if given.dtopo is None and given.hydrographs is None:
            raise ReportError("nothing to export: specify --dtopo FILE or --hydrographs FOLDER.")
        run = Run(given.run)
        lines = hydrographs(run) if given.hydrographs is not None else []
        files = [given.hydrographs / f"{each.name}.csv" for each in lines]
        for path in [*files, *([given.dtopo] if given.dtopo is not None else [])]:
            _require_new(path, given.overwrite)
        if given.dtopo is not None:
            grid, times = write_dtopo(run, given.dtopo)
            print_line(
                f"dtopo: {given.dtopo} ({grid.columns} x {grid.rows} points, {len(times)} times from {times[0]:g} to "
                f"{times[-1]:g} s)"
            )
        if lines:
            write_hydrographs(lines, given.hydrographs)
        for path, each in zip(files, lines, strict=True):
            flow, time = each.peak
            peak = f"peak {plain_text(flow)} m3/s at {time:g} s"
            print_line(f"hydrograph: {path} ({peak}; {plain_text(each.volume)} m3 in total)")

    return _ended("export", write)


def assets(arguments: Sequence[str] | None = None) -> int:
    """Run `thawslide assets`; return the exit code, 2 for an error of the user."""
    parser = argparse.ArgumentParser(
        prog="thawslide assets",
        description="List the maximum pressure, thickness and speed at assets, with the times of arrival and peak.",
    )
    _add_run(parser)
    parser.add_argument(
        "--polygons",
        metavar="FILE",
        type=Path,
        help="outlines of assets, with the attribute `name`: GeoPackage, GeoJSON, Shapefile or KML",
    )
    parser.add_argument(
        "--point",
        metavar="NAME,X,Y",
        action="append",
        default=[],
        help="asset at a point, in the coordinate reference system of the run (may be repeated)",
    )
    parser.add_argument("--output", metavar="FILE", type=Path, help="CSV file (default: RUN/assets.csv)")
    parser.add_argument("--overwrite", action="store_true", help="replace an existing file")
    given = parser.parse_args(arguments)

    def write() -> None:
        if given.polygons is None and not given.point:
            raise ReportError("no assets: specify --polygons FILE or --point NAME,X,Y.")
        output = given.output or given.run / "assets.csv"
        _require_new(output, given.overwrite)
        found = assets_hit(Run(given.run), given.polygons, [_point(text) for text in given.point])
        write_assets(found, output)
        for line in _table(found):
            print_line(line)
        print_line(f"table: {output}")

    return _ended("assets", write)


def _add_run(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run", metavar="RUN", type=Path, help="folder of a 3D run on a DEM")


def _ended(name: str, write: Callable[[], None]) -> int:
    try:
        write()
    except ReportError as error:
        print_line(f"thawslide {name}: error: {error}", sys.stderr)
        return 2
    return 0


def _require_new(path: Path, overwrites: bool) -> None:
    if path.exists() and (not overwrites or path.is_dir()):
        raise ReportError(f"{path}: exists. Change the name, or specify --overwrite.")


def _point(text: str) -> tuple[str, float, float]:
    try:
        name, x, y = text.split(",")
        return name.strip(), float(x), float(y)
    except ValueError as error:
        raise ReportError(f"--point {text}: not NAME,X,Y, such as hut,2600123,1198456. Correct it.") from error


def _table(assets: Sequence[Asset]) -> list[str]:
    width = max(len(asset.name) for asset in assets)
    head = f"{'asset':{width}}  pressure [kPa]  at [s]  arrival [s]  thickness [m]  speed [m/s]"
    lines = [head]
    for asset in assets:
        if not asset.is_hit:
            lines.append(f"{asset.name:{width}}  not reached")
            continue
        cells = [
            f"{value:>{size}.3g}" if math.isfinite(value) else f"{'-':>{size}}"
            for value, size in (
                (asset.max_pressure_kpa, 14),
                (asset.max_pressure_time_s, 6),
                (asset.arrival_time_s, 11),
                (asset.max_thickness_m, 13),
                (asset.max_speed_m_s, 11),
            )
        ]
        lines.append(f"{asset.name:{width}}  " + "  ".join(cells))
    return lines
