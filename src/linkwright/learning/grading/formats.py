"""The marks of a class in the formats of other programs."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from linkwright.diagnostics.translation import LANGUAGES
from linkwright.learning.course import Course
from linkwright.learning.grading.marks import Mark, StudentMarks
from linkwright.learning.progress import StepProgress
from linkwright.learning.sandbox import Limits

_FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")
"""The beginnings of a cell that a spreadsheet would calculate."""


def format_gradebook_csv(students: Sequence[StudentMarks], language: str) -> str:
    """Return the grades as CSV, one line per student, for Moodle and other gradebooks.

    The columns are the student, the points, the possible points, a column of points for each step, and the feedback.
    The points of a step that was not graded are empty instead of 0.
    """
    steps = list(students[0].points) if students else []
    lines = [["username", "points", "max_points", *steps, "feedback"]]
    for student in students:
        points = [_format_points(student, [step]) for step in steps]
        feedback = "\n".join(_list_feedback(student, language))
        total = _format_points(student, steps)
        lines.append([student.submission.student, total, _format_number(student.possible), *points, feedback])
    return _to_csv(lines)


def format_nbgrader_csv(students: Sequence[StudentMarks]) -> str:
    """Return the grades as CSV, one line per lesson and student, as nbgrader exports them."""
    names = ["assignment", "duedate", "timestamp", "student_id", "last_name", "first_name", "email"]
    lines = [[*names, "raw_score", "late_submission_penalty", "score", "max_score"]]
    for lesson in dict.fromkeys(step.split("/")[0] for student in students for step in student.points):
        for student in students:
            steps = [step for step in student.points if step.split("/")[0] == lesson]
            score = _format_points(student, steps)
            possible = _format_number(sum(student.points[step] for step in steps))
            identity = [lesson, "", "", student.submission.student, "", "", ""]
            lines.append([*identity, score, "0", score, possible])
    return _to_csv(lines)


def format_grades_json(course: Course, students: Sequence[StudentMarks], limits: Mapping[str, Any]) -> str:
    """Return all data about the marks as one JSON document."""
    data = {
        "course": course.id,
        "limits": dict(limits),
        "protections": list_protections_in_force(students),
        "students": [_student_to_data(student) for student in students],
    }
    return json.dumps(data, ensure_ascii=False, indent=1) + "\n"


def list_protections_in_force(students: Iterable[StudentMarks]) -> list[str]:
    """Return the protections that were in force in all runs."""
    marks = [mark for student in students for mark in student.marks.values() if mark.protections]
    if not marks:
        return []
    return sorted(set.intersection(*(set(mark.protections) for mark in marks)))


def limits_to_data(limits: Limits) -> dict[str, Any]:
    """Return the limits as JSON values."""
    return dict(vars(limits))


def _student_to_data(student: StudentMarks) -> dict[str, Any]:
    submission = student.submission
    return {
        "student": submission.student,
        "graded": student.is_graded,
        "points": student.total,
        "max_points": student.possible,
        "notes": [note.texts for note in submission.notes],
        "steps": [
            {
                **mark.to_data(),
                "points": _get_points(student, step),
                "max_points": student.points[step],
                "claims": _claims_to_data(submission.progress.step(step)),
            }
            for step, mark in student.marks.items()
        ],
        "autograding": _encode_autograding(student),
    }


def _claims_to_data(progress: StepProgress) -> dict[str, Any]:
    """Return the claims of the student's own progress file."""
    return {"hints": progress.hints, "solution": progress.solution, "answer": progress.answer}


def _encode_autograding(student: StudentMarks) -> dict[str, Any]:
    """Return the marks as Base64 in the format of GitHub Classroom's autograding reporter."""
    return {
        "version": 1,
        "status": "pass" if student.marks and all(mark.passed for mark in student.marks.values()) else "fail",
        "max_score": student.possible,
        "tests": [
            {
                "name": step,
                "status": _get_status(mark),
                "score": _get_points(student, step),
                "message": "\n".join(message.get(LANGUAGES[0]) for message in mark.messages),
                "test_code": "",
                "filename": "",
                "line_no": 0,
                "duration": round(mark.seconds * 1000),
            }
            for step, mark in student.marks.items()
        ],
    }


def _get_status(mark: Mark) -> str:
    if mark.passed:
        return "pass"
    return "fail" if mark.reason is None and mark.is_graded else "error"


def _format_points(student: StudentMarks, steps: Sequence[str]) -> str:
    """Return the total points of steps as text, or an empty string if one is not graded."""
    if any(step not in student.marks or not student.marks[step].is_graded for step in steps):
        return ""
    return _format_number(sum(_get_points(student, step) for step in steps))


def _get_points(student: StudentMarks, step: str) -> float:
    mark = student.marks.get(step)
    return student.points[step] if mark is not None and mark.passed else 0


def _list_feedback(student: StudentMarks, language: str) -> list[str]:
    notes = [note.get(language) for note in student.submission.notes]
    messages = [f"{step}: {message.get(language)}" for step, mark in student.marks.items() for message in mark.messages]
    return notes + messages


def _format_number(value: float) -> str:
    return f"{value:g}"


def _to_csv(lines: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([_to_cell(value) for value in line] for line in lines)
    return text.getvalue()


def _to_cell(value: str) -> str:
    """Return a value in a form that a spreadsheet reads as text, not as a formula."""
    return f"'{value}" if value.startswith(_FORMULA_STARTS) else value
