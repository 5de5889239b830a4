"""Maps of a run: GeoTIFF files as numbers on a grid, parts of them, and values along lines."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Literal, cast

import numpy as np
import rasterio
from rasterio.errors import NotGeoreferencedWarning, RasterioError

from thawslide.errors import NotInRunError, ReportError
from thawslide.run_folder import Numbers, Run
from thawslide.text_files import is_file
from thawslide.units import cf_unit

if TYPE_CHECKING:
    import xarray

Box = tuple[float, float, float, float]  # west, east, south, north [m]

# Reduction of the values of a block: the mean of a terrain, the maximum of a map of maxima.
_REDUCTIONS: dict[str, Callable[..., Numbers]] = {"mean": np.nanmean, "maximum": np.nanmax}
MOST_CELLS = 100_000_000  # of a map: 0.8 GB of numbers
_TYPES = ("float32", "float64", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64")
_MOST_CELLS_OF_BLOCK = 25_000_000
_MAX_COMPRESSION = 1100.0  # of DEFLATE, with a margin


@dataclass(frozen=True)
class Grid:
    """Cell centres on the horizontal plane; the first is in the south-west [m]."""

    x0: float
    y0: float
    cell_x: float
    cell_y: float
    columns: int
    rows: int

    @property
    def x(self) -> Numbers:
        """Eastings of the columns [m]."""
        return self.x0 + self.cell_x * np.arange(self.columns, dtype=np.float64)

    @property
    def y(self) -> Numbers:
        """Northings of the rows [m], from south to north."""
        return self.y0 + self.cell_y * np.arange(self.rows, dtype=np.float64)

    @property
    def box(self) -> Box:
        """The outer edges of the cells."""
        west, south = self.x0 - 0.5 * self.cell_x, self.y0 - 0.5 * self.cell_y
        return west, west + self.columns * self.cell_x, south, south + self.rows * self.cell_y

    @property
    def cell_area(self) -> float:
        """Area of one cell [m2]."""
        return self.cell_x * self.cell_y

    def part(self, box: Box) -> tuple[slice, slice]:
        """Return the rows and columns whose cells overlap a box, at least one of each."""
        west, _, south, _ = self.box
        return (
            _overlap(box[2], box[3], south, self.cell_y, self.rows),
            _overlap(box[0], box[1], west, self.cell_x, self.columns),
        )

    def cropped(self, box: Box) -> Grid:
        """Return the grid of the cells that overlap a box."""
        rows, columns = self.part(box)
        return replace(
            self,
            x0=self.x0 + columns.start * self.cell_x,
            y0=self.y0 + rows.start * self.cell_y,
            columns=columns.stop - columns.start,
            rows=rows.stop - rows.start,
        )

    def thinned(self, factor: int) -> Grid:
        """Return the grid whose cells are blocks of factor x factor cells; those at the edge can extend over it."""
        return Grid(
            self.x0 + 0.5 * (factor - 1) * self.cell_x,
            self.y0 + 0.5 * (factor - 1) * self.cell_y,
            self.cell_x * factor,
            self.cell_y * factor,
            -(-self.columns // factor),
            -(-self.rows // factor),
        )

    def factor(self, most: int) -> int:
        """Return the smallest factor that thins the grid to at most `most` cells per side."""
        return max(1, -(-max(self.columns, self.rows) // most))


@dataclass(frozen=True)
class Map:
    """Values on a grid, shape (rows, columns), rows from south to north, nan for no data."""

    grid: Grid
    values: Numbers
    unit: str = ""  # as in the CF conventions
    description: str = ""
    crs: str = ""  # name of the coordinate reference system, "" if unknown
    wkt: str = ""  # the same as well-known text

    def __repr__(self) -> str:
        values = self.values[np.isfinite(self.values)]
        found = f"{values.min():.6g} to {values.max():.6g} {self.unit}".strip() if values.size else "no data"
        return f"Map({self.description!r}, {self.grid.rows} x {self.grid.columns} cells, {found})"

    def cropped(self, box: Box) -> Map:
        """Return the part whose cells overlap a box.

        Parameters
        ----------
        box : tuple of float
            West, east, south and north [m].

        """
        rows, columns = self.grid.part(box)
        return replace(self, grid=self.grid.cropped(box), values=self.values[rows, columns])

    def thinned(self, most: int, reduction: Literal["mean", "maximum"] = "mean") -> Map:
        """Return the map with larger cells: each block of cells is reduced to one value.

        Parameters
        ----------
        most : int
            Maximum number of cells per side.
        reduction : str
            "mean" or "maximum" of the block.

        """
        factor = self.grid.factor(most)
        if factor == 1:
            return self
        grid = self.grid.thinned(factor)
        missing = ((0, grid.rows * factor - self.grid.rows), (0, grid.columns * factor - self.grid.columns))
        blocks = np.pad(self.values, missing, constant_values=np.nan).reshape(grid.rows, factor, grid.columns, factor)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # blocks without data
            values = _REDUCTIONS[reduction](blocks, axis=(1, 3))
        return replace(self, grid=grid, values=values)

    def averaged_over(self, grid: Grid) -> Map:
        """Return the area-weighted means over the cells of another grid; no data and the outside count as zero.

        Parameters
        ----------
        grid : Grid
            The other grid, such as that of another map.

        """
        own = self.grid
        rows = _means(np.nan_to_num(self.values), (own.y0, own.cell_y), (grid.y0, grid.cell_y, grid.rows))
        values = _means(rows.T, (own.x0, own.cell_x), (grid.x0, grid.cell_x, grid.columns)).T
        return replace(self, grid=grid, values=values)

    def at(self, x: Numbers, y: Numbers) -> Numbers:
        """Return values at points by bilinear interpolation.

        Parameters
        ----------
        x, y : array
            Eastings and northings [m], of equal shape.

        Returns
        -------
        numpy.ndarray
            Values of the same shape; nan outside and next to no-data cells.

        """
        grid = self.grid
        u, v = (np.asarray(x) - grid.x0) / grid.cell_x, (np.asarray(y) - grid.y0) / grid.cell_y
        inside = (u >= 0.0) & (u <= grid.columns - 1) & (v >= 0.0) & (v <= grid.rows - 1)
        column = np.clip(np.floor(u), 0, max(grid.columns - 2, 0)).astype(np.intp)
        row = np.clip(np.floor(v), 0, max(grid.rows - 2, 0)).astype(np.intp)
        a, b = u - column, v - row
        total = np.zeros(np.broadcast(u, v).shape)
        for dr, wr in ((0, 1.0 - b), (1, b)):
            for dc, wc in ((0, 1.0 - a), (1, a)):
                value = self.values[np.minimum(row + dr, grid.rows - 1), np.minimum(column + dc, grid.columns - 1)]
                total += np.where(wr * wc == 0.0, 0.0, wr * wc * value)
        return np.where(inside, total, np.nan)

    def to_xarray(self) -> xarray.DataArray:
        """Return the map as an xarray.DataArray with the dimensions y and x [m], rows from south to north.

        Attributes: `units` and `long_name`. If the package rioxarray is installed, its accessor `rio` has the
        coordinate reference system. ImportError without the package xarray.
        """
        import xarray  # an optional package

        array = xarray.DataArray(
            self.values,
            coords={"y": self.grid.y, "x": self.grid.x},
            dims=("y", "x"),
            attrs={"units": cf_unit(self.unit), "long_name": self.description},
        )
        if self.wkt:
            with suppress(ImportError):
                import_module("rioxarray")  # adds the accessor
                return cast("xarray.DataArray", array.rio.write_crs(self.wkt))
        return array

    def volume(self) -> float:
        """Return the volume [m3] under a map of thickness [m]."""
        return float(np.nansum(self.values)) * self.grid.cell_area


class Maps(Mapping[str, Map]):
    """Maps of a run by name; each is read at every access, because keeping all would need much memory.

    An unknown name raises NotInRunError, a damaged file ReportError.
    """

    def __init__(self, run: Run) -> None:
        """Find the maps; NotInRunError for a run without any."""
        self.folder = run.folder / "maps"
        if not self.folder.is_dir():
            raise NotInRunError(f"{self.folder}: no such folder. Only a 3D run on a DEM writes maps.")

    @cached_property
    def names(self) -> list[str]:
        """The names of all maps."""
        return sorted(path.stem for path in self.folder.glob("*.tif"))

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"Maps({', '.join(self.names)})"

    def __getitem__(self, name: str) -> Map:
        if name not in self.names:
            raise NotInRunError(f"{self.folder / name}.tif: no such map (found: {', '.join(self.names) or 'none'}).")
        return read_map(self.folder / f"{name}.tif")

    def about(self, name: str) -> tuple[str, str]:
        """Return description and unit of a map, from its file."""
        with _open(self.folder / f"{name}.tif") as file:
            return file.descriptions[0] or "", _unit_of(file)


def read_map(path: Path) -> Map:
    """Read the first band of a GeoTIFF; ReportError if it is missing, damaged or not aligned with north."""
    try:
        with _open(path) as file:
            _check_size(file, path)
            transform, crs = file.transform, file.crs
            band = file.read(1, masked=True, out_dtype="float64")
            unit, description = _unit_of(file), file.descriptions[0] or ""
    except (RasterioError, OSError, ValueError, MemoryError) as error:
        raise ReportError(f"{path}: cannot be read as a GeoTIFF ({error}). Repeat the run.") from error
    if not np.isfinite(transform[:6]).all():
        raise ReportError(f"{path}: coordinates are not finite. Repeat the run.")
    if transform.b != 0.0 or transform.d != 0.0 or transform.a <= 0.0 or transform.e >= 0.0:
        raise ReportError(f"{path}: not aligned with north. Repeat the run.")
    rows, columns = band.shape
    grid = Grid(
        transform.c + 0.5 * transform.a,
        transform.f + (rows - 0.5) * transform.e,
        transform.a,
        -transform.e,
        columns,
        rows,
    )
    values = np.ma.filled(band, np.nan)[::-1]
    return Map(grid, values, unit, description, _crs_words(crs), crs.to_wkt() if crs else "")


def on_map(run: Run) -> bool:
    """Return whether figures of a run are maps: a 3D run on a DEM."""
    return run.dimension == 3 and (run.section("terrain").get("type") == "dem" or (run.folder / "maps").is_dir())


def _unit_of(file: rasterio.DatasetReader) -> str:
    return cf_unit(file.units[0]) if file.units[0] else ""


def _open(path: Path) -> rasterio.DatasetReader:
    if not is_file(path) and path.exists():  # a pipe would block forever
        raise ReportError(f"{path}: not a file. Repeat the run.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NotGeoreferencedWarning)
            file = rasterio.open(path, driver="GTiff")  # no other format, which could refer to further files
            has_coordinates = file.transform != rasterio.Affine.identity()
    except (RasterioError, OSError) as error:
        raise ReportError(f"{path}: cannot be read as a GeoTIFF ({error}). Repeat the run.") from error
    if not has_coordinates:
        raise ReportError(f"{path}: no coordinates; not a map of the simulator. Repeat the run.")
    return file


def _check_size(file: rasterio.DatasetReader, path: Path) -> None:
    """Raise ReportError for a map that is too large, or larger than its file can contain."""
    kind, cells, block = file.dtypes[0], file.width * file.height, math.prod(file.block_shapes[0])
    if kind not in _TYPES or not 0 < cells <= MOST_CELLS or block > _MOST_CELLS_OF_BLOCK:
        raise ReportError(
            f"{path}: not a valid map (found {file.width} x {file.height} cells of {kind} in blocks of {block:,}; "
            f"allowed {MOST_CELLS:,} cells of numbers in blocks of {_MOST_CELLS_OF_BLOCK:,}). Use larger map cells."
        )
    if max(cells, block) * np.dtype(kind).itemsize > _MAX_COMPRESSION * path.stat().st_size:
        raise ReportError(f"{path}: damaged (found {cells:,} cells, more than the file can contain). Repeat the run.")


def _means(values: Numbers, own: tuple[float, float], other: tuple[float, float, int]) -> Numbers:
    """Return means of rows over other rows; both are given by the first centre and the size, the other with a count."""
    (first, size), (other_first, other_size, count) = own, other
    ends = (other_first - first + (np.arange(count + 1) - 0.5) * other_size) / size + 0.5  # in rows of `values`
    ends = np.clip(ends, 0.0, len(values))
    whole = np.minimum(ends.astype(np.intp), len(values) - 1)
    sums = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)])
    integral = sums[whole] + (ends - whole)[:, None] * values[whole]
    return np.asarray(np.diff(integral, axis=0) * size / other_size)


def _overlap(low: float, high: float, start: float, cell: float, count: int) -> slice:
    first = int(np.clip(np.floor((low - start) / cell + 1e-9), 0, count - 1))
    last = int(np.clip(np.ceil((high - start) / cell - 1e-9), first + 1, count))
    return slice(first, last)


def named_system(text: str) -> tuple[str, str]:
    """Return name and well-known text of a coordinate reference system given as text, "" if it is unknown."""
    if not text:
        return "", ""
    crs = rasterio.crs.CRS.from_user_input(text)
    return _crs_words(crs), crs.to_wkt()


def _crs_words(crs: rasterio.crs.CRS | None) -> str:
    """Return name and number of a reference system, e.g. "MGI / Austria GK West (EPSG:31254)"."""
    if not crs:
        return ""
    name = str(crs.to_dict(projjson=True).get("name", ""))
    code = crs.to_epsg()
    number = f"EPSG:{code}" if code else ""
    return f"{name} ({number})" if name and number and name != number else name or number
