"""Workers of a sweep as Slurm jobs, through dask-jobqueue."""

from __future__ import annotations

from typing import Any


def slurm_cluster(*, jobs: int, cores: int, memory: str, walltime: str, **options: Any) -> Any:
    """Return a Dask cluster whose workers are Slurm jobs, each with a single-threaded worker per core.

    `memory` is the memory of a job, e.g. "64GB", and `walltime` its time limit, e.g. "12:00:00". Other options are
    those of dask_jobqueue.SLURMCluster, for example `account`, `queue` and `job_script_prologue`. A job that reaches
    its limit ends its members, which continue from their checkpoints in the next one. A member that five jobs do not
    finish counts as failed, as after the death of a worker.
    """
    from dask_jobqueue import SLURMCluster

    from thawslide.sweeps.engine import MOST_DEATHS

    scheduler = {"allowed_failures": MOST_DEATHS - 1} | options.pop("scheduler_options", {})
    cluster = SLURMCluster(
        cores=cores, processes=cores, memory=memory, walltime=walltime, scheduler_options=scheduler, **options
    )
    cluster.adapt(minimum_jobs=0, maximum_jobs=jobs)
    return cluster
