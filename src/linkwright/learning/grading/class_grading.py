"""Grade a class: run one job for each student and step, and collect the marks."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, missing_extra, phrase
from linkwright.diagnostics.extras import EXTRAS
from linkwright.learning.checks.findings import describe_error
from linkwright.learning.course import CASES_FILE, Course, Step
from linkwright.learning.grading.jobs import Job
from linkwright.learning.grading.journal import Journal, compute_mark_key, hash_folder
from linkwright.learning.grading.marks import Mark, StudentMarks
from linkwright.learning.grading.submissions import Submission, copy_workspace
from linkwright.learning.grading.workers import RunJobs, create_scratch_folder
from linkwright.learning.local_text import LocalText
from linkwright.learning.sandbox import Limits, permit_reading

_DOMAIN_COUNT = 100

Progress = Callable[[int, int], None]
"""Called with the number of finished checks, and of all."""


def grade_class(
    course: Course,
    steps: Sequence[Step],
    submissions: Sequence[Submission],
    *,
    limits: Limits,
    run_jobs: RunJobs,
    journal: Journal,
    progress: Progress,
) -> list[StudentMarks]:
    """Check steps on copies of the students' folders in the sandbox, and return the marks.

    A run is repeated alone at the end if other runs may have made it fail, or if the grader failed.

    Args:
        course: the course with the lessons to grade.
        steps: the steps to check.
        submissions: the folders of the students.
        limits: the limits of each run.
        run_jobs: runs jobs in parallel processes.
        journal: stores the marks, so that an interrupted run can be resumed.
        progress: called after each step.

    Raises:
        LinkwrightError: LEARN121, the journal cannot be written; LEARN901, LEARN902, no run can use the sandbox.
    """
    marks: list[dict[str, Mark]] = [{} for _ in submissions]
    with create_scratch_folder() as scratch:
        lessons = _copy_lessons(course, scratch)
        keyed_jobs = _make_jobs(steps, submissions, limits, lessons, scratch)
        pending_jobs: list[tuple[str, Job]] = []
        for key, job in keyed_jobs:
            stored_mark = journal.find(key)
            if stored_mark is None:
                pending_jobs.append((key, job))
            else:
                marks[job.student][stored_mark.step] = stored_mark
        done_count = len(keyed_jobs) - len(pending_jobs)
        for key, job, mark in _run_all(pending_jobs, run_jobs):
            if mark.is_graded:
                journal.add(key, mark)
            marks[job.student][mark.step] = mark
            done_count += 1
            progress(done_count, len(keyed_jobs))
    points = {step.address: step.points for step in steps}
    return [
        StudentMarks(submission, {step: student_marks[step] for step in points if step in student_marks}, points)
        for submission, student_marks in zip(submissions, marks, strict=True)
    ]


def check_extras(steps: Sequence[Step]) -> None:
    """Raise LEARN116 if an extra that a lesson needs is not installed."""
    for extra in dict.fromkeys(extra for step in steps for extra in step.lesson.needs):
        if find_spec(EXTRAS[extra]) is None:
            raise missing_extra("LEARN116", ModuleNotFoundError(name=EXTRAS[extra]))


def _copy_lessons(course: Course, scratch: Path) -> Path:
    """Copy the course without its solutions, which students' programs must not read."""
    copy = scratch / course.id
    shutil.copytree(course.folder, copy, ignore=shutil.ignore_patterns("solution", CASES_FILE, "__pycache__", ".git"))
    permit_reading(copy)
    return copy


def _make_jobs(
    steps: Sequence[Step], submissions: Sequence[Submission], limits: Limits, lessons: Path, scratch: Path
) -> list[tuple[str, Job]]:
    """Copy the folders of the students, and return the jobs with the keys of their marks."""
    course_hash = hash_folder(lessons)
    jobs: list[tuple[str, Job]] = []
    for index, submission in enumerate(submissions):
        if not submission.is_readable:
            continue
        job_folder = scratch / f"{index}"
        job_folder.mkdir()
        job_folder.chmod(0o711)
        copy = job_folder / "copy"
        if not copy_workspace(submission, copy):
            continue
        copy_hash = hash_folder(copy)
        copy.chmod(0o700)
        for step in steps:
            answer = submission.progress.step(step.address).answer
            step_of_copy = replace(step, lesson=replace(step.lesson, folder=lessons / step.lesson.id))
            domain = 1 + len(jobs) % _DOMAIN_COUNT
            job = Job(index, step_of_copy, copy, answer, limits, lessons, domain)
            jobs.append((compute_mark_key(job, course_hash, copy_hash), job))
    return jobs


def _run_all(jobs: Sequence[tuple[str, Job]], run_jobs: RunJobs) -> Iterator[tuple[str, Job, Mark]]:
    """Run jobs in parallel, then repeat jobs alone that may have failed because of other jobs."""
    repeated_jobs: list[tuple[str, Job]] = []
    errors: list[LinkwrightError] = []
    has_mark = False
    for index, mark in run_jobs([job for _, job in jobs]):
        key, job = jobs[index]
        has_mark = has_mark or isinstance(mark, Mark)
        if isinstance(mark, LinkwrightError):
            errors.append(mark)
        if not isinstance(mark, Mark) or mark.may_differ:
            repeated_jobs.append((key, job))
        else:
            yield key, job, mark
    if errors and not has_mark:
        raise errors[0]
    for key, job in sorted(repeated_jobs, key=lambda pair: (pair[1].student, pair[1].domain)):
        yield key, job, _run_alone(replace(job, is_repeated=True), run_jobs)


def _run_alone(job: Job, run_jobs: RunJobs) -> Mark:
    ((_, mark),) = run_jobs([job])
    if isinstance(mark, Mark):
        return mark
    if mark is None:
        reason = phrase("the process of the grader ended twice; perhaps the student's program has ended it")
    else:
        reason = describe_error(mark)
    text = LocalText.from_phrase(reason)
    return Mark(job.step.address, passed=False, reason=text, is_repeated=True, is_graded=False)
