"""Worker processes for jobs, on this machine or in a Ray cluster."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.grading.jobs import Job, run_job
from linkwright.learning.grading.marks import Mark
from linkwright.learning.sandbox import permit_reading
from linkwright.sweep.ray_cluster import LostTask, RayCluster, connect_to_ray

JobResult = Mark | LinkwrightError | None
"""The mark of a job, or why it has none: an error of the sandbox, or None if the process of the job was lost."""

RunJobs = Callable[[Sequence[Job]], Iterator[tuple[int, JobResult]]]
"""Runs jobs, and yields the end of each with its index."""

FolderContent = dict[str, "tuple[int, bytes] | None"]
"""The mode and content of each file by its path in a folder, and None for each folder."""


@contextmanager
def create_scratch_folder() -> Iterator[Path]:
    """Yield a folder that the users of runs may traverse but not list."""
    with ScratchFolder("grade", ignore_cleanup_errors=True) as name:
        Path(name).chmod(0o711)
        yield Path(name)


@contextmanager
def open_local_workers(count: int) -> Iterator[RunJobs]:
    """Yield a function that runs jobs in parallel processes of this machine."""
    yield partial(_run_locally, count)


@contextmanager
def open_ray_workers(address: str) -> Iterator[RunJobs]:
    """Yield a function that runs jobs in a Ray cluster.

    The course and copies of the students' folders are sent to the cluster.

    Raises:
        LinkwrightError: SWEEP113, Ray is not installed; SWEEP114, there is no cluster at the address.
    """
    with connect_to_ray(address) as cluster:
        yield partial(_run_on_ray, cluster)


def _run_locally(count: int, jobs: Sequence[Job]) -> Iterator[tuple[int, JobResult]]:
    spawn = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(count, mp_context=spawn, initializer=_end_with_grader, initargs=(os.getpid(),))
    try:
        futures = {pool.submit(run_job, job): index for index, job in enumerate(jobs)}
        for future in as_completed(futures):
            error = future.exception()
            if isinstance(error, LinkwrightError):
                yield futures[future], error
            elif isinstance(error, BrokenExecutor):  # a student's program, or the system, has ended a process
                yield futures[future], None
            else:
                yield futures[future], future.result()
    finally:
        pool.shutdown(cancel_futures=True)


def _end_with_grader(grader: int) -> None:
    """End this process when the grader ends, however it ends.

    The supervisor of its run then ends the run.
    """
    if sys.platform == "linux":
        from linkwright.learning.sandbox.linux import die_with_parent

        die_with_parent(signal.SIGTERM, grader)


def _run_on_ray(cluster: RayCluster, jobs: Sequence[Job]) -> Iterator[tuple[int, JobResult]]:
    for index, mark in cluster.run_tasks(_run_in_cluster, _iterate_task_arguments(cluster, jobs)):
        yield index, None if isinstance(mark, LostTask) else mark


def _iterate_task_arguments(cluster: RayCluster, jobs: Sequence[Job]) -> Iterator[tuple[object, ...]]:
    """Yield the arguments of `_run_in_cluster`.

    A folder's content is sent when its first job begins.
    """
    course = copy = None
    content_of: Path | None = None
    for job in jobs:
        course = course or cluster.share(read_folder(job.course))
        if job.copy != content_of:
            copy, content_of = cluster.share(read_folder(job.copy)), job.copy
        yield course, copy, job


def _run_in_cluster(course: FolderContent, copy: FolderContent, job: Job) -> Mark | LinkwrightError:
    """Run a job in a process of the cluster, in separate folders.

    An error is returned instead of raised, because Ray would replace it with another error.
    """
    with create_scratch_folder() as scratch:
        lessons, own_copy = scratch / "course", scratch / "copy"
        write_folder(lessons, course)
        permit_reading(lessons)
        write_folder(own_copy, copy)
        own_copy.chmod(0o700)
        lesson = replace(job.step.lesson, folder=lessons / job.step.lesson.folder.relative_to(job.course))
        own_job = replace(job, step=replace(job.step, lesson=lesson), copy=own_copy, course=lessons)
        try:
            return run_job(own_job)
        except LinkwrightError as error:
            return error


def read_folder(folder: Path) -> FolderContent:
    """Return the content of a folder that contains only folders and regular files."""
    content: FolderContent = {}
    for path in sorted(folder.rglob("*")):
        file = (path.stat().st_mode & 0o777, path.read_bytes()) if path.is_file() else None
        content[path.relative_to(folder).as_posix()] = file
    return content


def write_folder(folder: Path, content: FolderContent) -> None:
    """Create a folder with the content of another."""
    folder.mkdir()
    for name, file in content.items():
        path = folder / name
        if file is None:
            path.mkdir()
        else:
            mode, data = file
            path.write_bytes(data)
            path.chmod(mode)
