"""Read, plot and report runs of Thawslide."""

from thawslide.errors import NotInRunError, ReportError
from thawslide.run import History, Run, Snapshot, Target

__all__ = ["History", "NotInRunError", "ReportError", "Run", "Snapshot", "Target"]
