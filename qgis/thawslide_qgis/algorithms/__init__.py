"""The algorithms, in the order of their use."""

from __future__ import annotations

from .base import ThawslideAlgorithm
from .check_case import CheckCase
from .load_results import LoadResults
from .new_case import NewCase
from .resume_run import ResumeRun
from .run_case import RunCase

ALGORITHMS: list[type[ThawslideAlgorithm]] = [NewCase, CheckCase, RunCase, ResumeRun, LoadResults]
