"""3D view: the projection, the direction of the viewer, and the speeds that are painted on the terrain."""

import sys
from pathlib import Path

import numpy as np
import pytest
from map_runs import MIDDLE, SPEED, WEST, write_map_run
from matplotlib.collections import PolyCollection

import thawslide.figures  # noqa: F401
from thawslide import Run
from thawslide.figures.site import make_site

VIEW = sys.modules["thawslide.figures.view"]  # the package exports a function of the same name


@pytest.fixture
def run(tmp_path: Path) -> Run:
    write_map_run(tmp_path / "run", snapshots=2)
    return Run(tmp_path / "run")


@pytest.mark.parametrize("towards", [0.0, 1.0, -2.5])
def test_projection_keeps_lengths_to_the_right_and_hides_what_is_behind(towards: float) -> None:
    project = VIEW.Projection(towards)
    at = np.zeros(1)
    right, nearer = project.right, project.to_viewer
    np.testing.assert_allclose(project(at + right[0], at + right[1], at), [[1.0, 0.0]], atol=1e-12)
    np.testing.assert_allclose(project(at, at, at + 1.0), [[0.0, np.cos(np.radians(32.0))]], atol=1e-12)
    np.testing.assert_allclose(
        project(at + nearer[0], at + nearer[1], at), [[0.0, -np.sin(np.radians(32.0))]], atol=1e-12
    )
    assert np.isnan(project(at, at, np.full(1, np.nan))).all()


def test_viewer_is_in_front_of_the_slide(run: Run) -> None:
    assert VIEW._direction(make_site(run)) == pytest.approx(0.0, abs=1e-9)  # the slab moves to the east


def test_speeds_are_painted_where_the_slide_was(run: Run) -> None:
    x = np.array([WEST + 100.0, WEST + 300.0, WEST + 590.0])
    speeds = VIEW._on(run.maps["max_speed"], x, np.full(3, MIDDLE))
    np.testing.assert_array_equal(speeds, [SPEED, SPEED, np.nan])


def test_nearer_terrain_is_painted_last(run: Run) -> None:
    figure = VIEW.view(run)
    (surface,) = [each for each in figure.axes[0].collections if isinstance(each, PolyCollection) and
                  len(each.get_paths()) > 100]  # fmt: skip
    site = make_site(run)
    terrain = VIEW._surroundings(site)
    assert len(surface.get_paths()) == (terrain.grid.rows - 1) * (terrain.grid.columns - 1)
    first, last = surface.get_paths()[0].vertices.mean(axis=0), surface.get_paths()[-1].vertices.mean(axis=0)
    assert first[1] > last[1]
    assert figure.axes[1].get_ylabel() == "maximum speed (m/s)"
