"""The Slurm job script of a sweep. It is generated and parsed here; no test submits it to Slurm."""

from __future__ import annotations

import subprocess

from thawslide.sweeps.engine import MOST_DEATHS
from thawslide.sweeps.slurm import slurm_cluster


def test_a_job_has_one_single_threaded_worker_for_each_core() -> None:
    cluster = slurm_cluster(
        jobs=4, cores=8, memory="16GB", walltime="02:00:00", account="hazards", queue="short",
        job_script_prologue=["module load gcc"], interface=None,
    )  # fmt: skip
    try:
        script = cluster.job_script()
        assert cluster.scheduler.allowed_failures == MOST_DEATHS - 1
    finally:
        cluster.close()
    for line in ("#SBATCH -A hazards", "#SBATCH -p short", "#SBATCH --cpus-per-task=8", "#SBATCH -t 02:00:00"):
        assert line in script.splitlines()
    assert "module load gcc" in script
    assert "--nthreads 1 " in script and "--nworkers 8 " in script and "tcp://" in script
    assert subprocess.run(["bash", "-n"], input=script, text=True, check=False).returncode == 0
