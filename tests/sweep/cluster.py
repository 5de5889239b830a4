"""A Dask cluster of separate processes: a scheduler, and two workers with one thread each."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

WORKERS = 2
ALLOWED_FAILURES = 1  # of the scheduler: a member fails after two deaths of workers
_LIMIT = 600.0  # seconds until the scheduler is ready


@contextlib.contextmanager
def cluster(folder: Path, preload: str = "") -> Iterator[str]:
    """Yield the address of a scheduler; the workers run the Python text `preload` at their start."""
    folder.mkdir()
    file, script = folder / "scheduler.json", folder / "preload.py"
    script.write_text(preload)
    environment = os.environ | {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(ALLOWED_FAILURES)}
    scheduler = ["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
    worker = ["worker", "--nthreads", "1", "--no-dashboard", "--scheduler-file", str(file), "--preload", str(script)]
    with contextlib.ExitStack() as ended:
        for arguments in (scheduler, *WORKERS * [worker]):
            command = [sys.executable, "-m", "dask", *arguments]
            quiet = {"stderr": subprocess.DEVNULL, "start_new_session": True}
            process = subprocess.Popen(command, cwd=folder, env=environment, **quiet)
            ended.callback(_end, process)
        deadline = time.monotonic() + _LIMIT
        while not file.is_file():
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.1)
        yield str(json.loads(file.read_text())["address"])


def _end(process: subprocess.Popen[bytes]) -> None:
    """Kill a process with those that it started."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
