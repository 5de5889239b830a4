"""Files of a sweep: the plan, and one record per member."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.text_files import MEGABYTE, is_file, read_json

PLAN = "sweep.json"
PRIOR, PRIOR_FILE = "prior", "prior.json"  # folder of the prior check of a forecast, and a file in it
INPUTS = "inputs"  # in the plan: digests of the inputs of each member
DONE, FAILED, RUNNING, PENDING = "done", "failed", "running", "pending"
FINISHED = (DONE, FAILED)


@dataclass(frozen=True)
class SweepFolder:
    """Paths of a sweep, and the records in it."""

    path: Path

    @property
    def plan_file(self) -> Path:
        """The file of the plan."""
        return self.path / PLAN

    def run_folder(self, number: int) -> Path:
        """Return the run folder of a member."""
        return self.path / "members" / f"{number:06d}"

    def record_file(self, number: int) -> Path:
        """Return the file of a member's record."""
        return self.path / "members" / f"{number:06d}.json"

    def series_file(self, number: int) -> Path:
        """Return the file of a member's thinned time series."""
        return self.path / "members" / f"{number:06d}.npz"

    def done_members(self) -> list[int]:
        """Return the numbers of the members that are done; ReportError if there are none."""
        done = [number for number in self._numbers() if self.record(number)["status"] == DONE]
        if not done:
            raise ReportError(f"{self.path}: no member is done. Wait, or read the errors in members.parquet.")
        return done

    def weights(self) -> dict[int, float] | None:
        """Return the weights of the members by number, None if all are equally probable."""
        path = self.path / PRIOR / PRIOR_FILE
        found = read_json(path, 64 * MEGABYTE).get("weights") if is_file(path) else None
        return {int(number): float(weight) for number, weight in found.items()} if found else None

    def unfinished(self) -> int:
        """Return the number of members that are neither done nor failed."""
        return sum(self.record(number)["status"] not in FINISHED for number in self._numbers())

    def _numbers(self) -> range:
        """Return the numbers of the members in the plan."""
        count = read_json(self.plan_file, 64 * MEGABYTE).get("members")
        if not isinstance(count, int):
            raise ReportError(f"{self.plan_file}: members: not a whole number (found {count}). Repeat the sweep.")
        return range(count)

    def start(self, plan: dict[str, Any]) -> list[int]:
        """Write the plan, or compare it with the plan of an interrupted sweep; ReportError if they differ.

        Removes the members whose inputs alone have changed, and returns their numbers.
        """
        plan = json.loads(json.dumps(plan))
        changed: list[int] = []
        if is_file(self.plan_file):
            found = read_json(self.plan_file, 64 * MEGABYTE)
            names = plan.keys() | found.keys()
            if isinstance(before := found.get(INPUTS), list) and len(before) == len(plan[INPUTS]):
                names -= {INPUTS}
                changed = [number for number, inputs in enumerate(plan[INPUTS]) if inputs != before[number]]
            different = sorted(name for name in names if plan.get(name) != found.get(name))
            if different:
                raise ReportError(
                    f"{self.path}: contains another sweep (different: {', '.join(different)}). Repeat its command, or "
                    f"specify another --output."
                )
            if not changed:
                return []
            for number in changed:
                self.forget(number)
        elif self.path.is_dir() and any(path.name != PRIOR for path in self.path.iterdir()):
            raise ReportError(f"{self.path}: not empty, and not a sweep. Specify another --output.")
        try:
            (self.path / "members").mkdir(parents=True, exist_ok=True)
            with atomic_file(self.plan_file) as temporary:
                temporary.write_text(json.dumps(plan, indent=1) + "\n", encoding="utf-8")
        except OSError as error:
            raise ReportError(
                f"{error.filename or self.path}: cannot be written ({error.strerror or error}). Select another "
                f"--output."
            ) from error
        return changed

    def forget(self, number: int) -> None:
        """Remove the run and the record of a member, which then runs again."""
        shutil.rmtree(self.run_folder(number), ignore_errors=True)
        self.record_file(number).unlink(missing_ok=True)

    def record(self, number: int) -> dict[str, Any]:
        """Return the record of a member; if it has never started, a record with 0 starts."""
        path = self.record_file(number)
        if not is_file(path):
            return {"status": PENDING, "starts": 0}
        return read_json(path, MEGABYTE)

    def write_record(self, number: int, record: dict[str, Any]) -> None:
        """Replace the record of a member."""
        with atomic_file(self.record_file(number)) as temporary:
            temporary.write_text(json.dumps(record), encoding="utf-8")
