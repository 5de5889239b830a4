"""Execution of members by Dask: on a local cluster with one run per core, or on any scheduler."""

from __future__ import annotations

import contextlib
import logging
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from multiprocessing import resource_tracker
from typing import Any

import dask
from distributed import Client, LocalCluster, as_completed, get_worker
from distributed.scheduler import KilledWorker

from thawslide.errors import ReportError
from thawslide.sweeps.folder import FAILED
from thawslide.sweeps.member import MemberInterruptedError, Task, perform
from thawslide.sweeps.progress import Progress

_TOPIC = "thawslide-member"  # of events that report progress
_WINDOW = 2000  # members submitted at once: the scheduler keeps them until a worker is free
MOST_DEATHS = 5  # of workers during one member, which then counts as failed
_CLOSE_TIMEOUT = 10.0  # seconds
_CONNECT_TIMEOUT = 20.0  # seconds, to a given scheduler
_REPORT_INTERVAL = 1.0  # seconds between two reports of a member

_SETTINGS = {
    "distributed.scheduler.allowed-failures": MOST_DEATHS - 1,
    "distributed.scheduler.worker-saturation": 1.0,  # a worker receives a member when it can start it
    "distributed.comm.timeouts.connect": "60s",
    # On a busy machine, the restart of a dead worker exceeds the default of 15 s, after which it would be abandoned.
    "distributed.deploy.lost-worker-timeout": "7 days",
}

OnFinished = Callable[[Task, dict[str, Any]], None]


class TooManyFailuresError(Exception):
    """More members failed than allowed; the others are not started."""


def perform_on_worker(task: Task) -> dict[str, Any]:
    """Perform a member and report its progress to the client."""
    worker = get_worker()
    last = 0.0

    def report(number: int, fraction: float) -> None:
        nonlocal last
        if time.monotonic() - last >= _REPORT_INTERVAL:
            last = time.monotonic()
            worker.log_event(_TOPIC, {"number": number, "fraction": fraction})

    return perform(task, report)


@contextlib.contextmanager
def connected(scheduler: str | None, workers: int) -> Iterator[Client]:
    """Connect to a scheduler, or start a local cluster of single-threaded processes."""
    with dask.config.set(_SETTINGS):
        if scheduler is not None:
            try:
                client = Client(scheduler, timeout=_CONNECT_TIMEOUT)
            except Exception as error:  # of any kind: the address, the network, the versions of packages
                raise ReportError(
                    f"--scheduler {scheduler}: no connection ({type(error).__name__}: {error}). Start it (dask "
                    f"scheduler), and correct the address, e.g. tcp://node1:8786."
                ) from error
            with client:
                yield client
            return
        cluster = None
        try:
            with _deferred_interrupt():
                cluster = LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address="127.0.0.1:0",
                    silence_logs=logging.CRITICAL,
                )
            with Client(cluster) as client:
                yield client
        finally:
            # A worker that is being restarted can block this call; it ends with this process.
            with contextlib.suppress(TimeoutError):
                if cluster is not None:
                    cluster.close(timeout=_CLOSE_TIMEOUT)


@contextlib.contextmanager
def _deferred_interrupt() -> Iterator[None]:
    """Raise KeyboardInterrupt at the end only. Threads and processes started within never receive Ctrl-C.

    A terminal sends it to all processes. Workers would print tracebacks; the driver stops them instead.
    """
    if threading.current_thread() is not threading.main_thread():  # Python calls handlers in the main thread only
        yield
        return
    resource_tracker.ensure_running()  # its start by the first worker would unblock the signal
    received: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda number, _: received.append(number))
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # inherited by processes, unlike a handler
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, handler)
    if received:
        raise KeyboardInterrupt


def perform_all(
    tasks: Sequence[Task], client: Client, progress: Progress, on_finished: OnFinished, max_failures: int | None
) -> None:
    """Perform all tasks; TooManyFailuresError if more than `max_failures` members of the sweep fail.

    If a member is interrupted, those that run finish, no other one starts, and MemberInterruptedError is raised.
    Dask also blames the members that wait on a worker that dies. Such suspects run again at the end, one at a time: a
    member fails if workers die while it is the only one.
    """
    client.subscribe_topic(_TOPIC, lambda event: progress.advance(event[1]["number"], event[1]["fraction"]))
    waiting = deque(tasks)
    suspects: deque[Task] = deque()
    is_only_one = False
    submitted: dict[Any, tuple[Task, Any]] = {}
    running = as_completed()
    interruption: MemberInterruptedError | None = None

    def submit_next() -> None:
        nonlocal is_only_one
        if not waiting and suspects and not submitted:
            waiting.append(suspects.popleft())
            is_only_one = True
        if waiting:
            task = waiting.popleft()
            key = ("member", str(task.folder), task.number, int(is_only_one))
            future = client.submit(perform_on_worker, task, key=key, pure=False)
            submitted[future.key] = (task, future)
            running.add(future)

    try:
        for _ in range(_WINDOW):
            submit_next()
        for future in running:
            task, _ = submitted.pop(future.key)
            if interruption and future.cancelled():
                continue
            try:
                record = _record_of(task, future)
            except MemberInterruptedError as error:
                if interruption is None:
                    interruption = MemberInterruptedError(f"member {task.number}: interrupted: {error}")
                    _cancel_waiting(client, submitted)
                continue
            except KilledWorker as error:
                if not is_only_one:
                    suspects.append(task)
                    if interruption is None:
                        submit_next()
                    continue
                deaths = error.allowed_failures + 1  # a setting of the scheduler
                text = f"{deaths} workers died during this member"
                record = {"status": FAILED, "error": text, "is_unrecorded": True}
            future.release()
            on_finished(task, record)
            progress.finish(task.number, record["status"] == FAILED)
            if max_failures is not None and progress.failed > max_failures:
                raise TooManyFailuresError
            if interruption is None:
                submit_next()
    finally:
        client.unsubscribe_topic(_TOPIC)
        progress.end()
    if interruption:
        raise interruption


def _cancel_waiting(client: Client, submitted: dict[Any, tuple[Task, Any]]) -> None:
    """Cancel the members that no worker has received."""
    received = {key for keys in client.processing().values() for key in keys}
    client.cancel([future for key, (_, future) in submitted.items() if key not in received])


def _record_of(task: Task, future: Any) -> dict[str, Any]:
    """Return the record of a finished member.

    KilledWorker if its workers died, MemberInterruptedError if it cannot write its files, and ReportError without a
    connection to the scheduler.
    """
    try:
        record: dict[str, Any] = future.result()
        return record
    except (OSError, CancelledError) as error:
        raise ReportError(
            f"member {task.number}: interrupted ({str(error) or 'no connection to the scheduler'}). Check the "
            f"scheduler. To continue, repeat the command."
        ) from error
