"""The program `thawslide`, started in a separate process: none of its libraries is loaded into QGIS."""

from __future__ import annotations

import os
import queue
import re
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import IO

from processing.core.ProcessingConfig import ProcessingConfig
from qgis.core import QgsProcessingException, QgsProcessingFeedback

SETTING = "THAWSLIDE_BINARY"  # name of the setting and of the environment variable
STOPPED = 4  # exit code after a signal
PROGRESS = re.compile(r"\s*(\d+) % \|")
POLL = 0.2  # s between checks whether the user has cancelled


def find_program() -> Path:
    """Return the program that the setting, the environment variable or PATH specifies."""
    chosen = ProcessingConfig.getSetting(SETTING) or os.environ.get(SETTING)
    if chosen:
        program = Path(chosen).expanduser()
        if not (program.is_file() and os.access(program, os.X_OK)):
            raise QgsProcessingException(f"{SETTING}: {program} is not a program. Correct the setting of Thawslide.")
        return program
    found = shutil.which("thawslide")
    if not found:
        raise QgsProcessingException(
            "thawslide: the program is not on PATH. "
            "Specify it in Settings > Options > Processing > Providers > Thawslide."
        )
    return Path(found)


def run_program(arguments: Sequence[str], feedback: QgsProcessingFeedback) -> None:
    """Run a command of the program and show its output and progress; raise its error message if it fails.

    If the user cancels, the program is asked to stop, and a run then writes its checkpoint.
    """
    command = [str(find_program()), *arguments]
    feedback.pushCommandInfo(" ".join(command))
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as errors:
        last, code = _follow(command, errors, feedback)
        errors.seek(0)
        message = errors.read().strip()
    if code == STOPPED and feedback.isCanceled():
        feedback.pushInfo(message)
    elif code != 0:
        raise QgsProcessingException(message or f"thawslide ended with code {code}: {last}")
    elif message:
        feedback.pushWarning(message)


def _follow(command: Sequence[str], errors: IO[str], feedback: QgsProcessingFeedback) -> tuple[str, int]:
    """Show the output while the command runs; return its last line and the exit code."""
    # A list of arguments without a shell: no text of the user is a command.
    with subprocess.Popen(  # nosec B603
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=errors,
        env=_environment(Path(command[0])),
        encoding="utf-8",
        errors="replace",
    ) as process:
        lines: queue.Queue[str | None] = queue.Queue()
        threading.Thread(target=_read_lines, args=(process.stdout, lines), daemon=True).start()
        last = ""
        is_stopping = False
        while (line := _next_line(lines)) is not None:
            if feedback.isCanceled() and not is_stopping:
                process.terminate()  # SIGTERM: unlike SIGINT, it is not ignored in the background of a shell
                is_stopping = True
            if line:
                last = line
                _show(line, feedback)
    return last, process.returncode


def _next_line(lines: queue.Queue[str | None]) -> str | None:
    """Return the next line, None after the last one, or an empty text if there is none yet."""
    try:
        return lines.get(timeout=POLL)
    except queue.Empty:
        return ""


def _read_lines(output: IO[str], lines: queue.Queue[str | None]) -> None:
    """Put the lines of an output into a queue, and None at its end."""
    for line in output:
        lines.put(line.rstrip())
    lines.put(None)


def _show(line: str, feedback: QgsProcessingFeedback) -> None:
    """Show a line of output: as progress, as a warning or as information."""
    progress = PROGRESS.match(line)
    if progress:
        feedback.setProgress(float(progress.group(1)))
    if line.startswith("warning:"):
        feedback.pushWarning(line)
    else:
        feedback.pushInfo(line)


def _environment(program: Path) -> dict[str, str]:
    """Return the environment without the Python of QGIS, and with `thawslide-report` of the repository on PATH."""
    environment = {key: value for key, value in os.environ.items() if key not in {"PYTHONHOME", "PYTHONPATH"}}
    scripts = [str(parent / ".venv" / "bin") for parent in program.resolve().parents]
    places = [environment.get("PATH", os.defpath), *(folder for folder in scripts if Path(folder).is_dir())]
    return {**environment, "PATH": os.pathsep.join(places)}
