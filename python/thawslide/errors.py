"""The errors a user can cause: their text says what is wrong, where, and what to do."""


class ReportError(Exception):
    """A run that cannot be read or drawn as asked; the command line prints it and exits with 2."""


class NotInRunError(ReportError):
    """A figure that this run has nothing for (no snapshots, a column that is not there): the report leaves it out."""
