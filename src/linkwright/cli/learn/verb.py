"""The command ``learn`` and its subcommands."""

from __future__ import annotations

from functools import partial

from linkwright.cli.learn import classroom, grade, judge, lessons, pack, steps
from linkwright.cli.nested import SubVerb, configure_nested, run_nested

DEFAULT_VERB = "open"
"""The subcommand that runs if none is named."""

VERBS = {
    "open": SubVerb(classroom.configure, classroom.run, help="open a course in the page, with your files and robot"),
    "list": SubVerb(steps.configure_list, steps.run_list, help="list the lessons and steps of a course, with progress"),
    "show": SubVerb(steps.configure_show, steps.run_show, help="print the text of a step, and copy its lesson's files"),
    "check": SubVerb(steps.configure_check, steps.run_check, help="check a step, and print what is still missing"),
    "answer": SubVerb(steps.configure_answer, steps.run_answer, help="answer a step that asks for a number"),
    "hint": SubVerb(steps.configure_hint, steps.run_hint, help="print the next hint for a step"),
    "solution": SubVerb(
        steps.configure_solution, steps.run_solution, help="copy the solution of a step, or print the number"
    ),
    "catch-up": SubVerb(
        steps.configure_catch_up,
        steps.run_catch_up,
        help="copy the solutions of all steps before a step from the course",
    ),
    "exercises": SubVerb(judge.configure_exercises, judge.run_exercises, help="list the exercises with a judge"),
    "judge": SubVerb(judge.configure_judge, judge.run_judge, help="judge a program for an exercise in several worlds"),
    "world": SubVerb(
        judge.configure_world, judge.run_world, help="open an exercise in the page, with its world and judge"
    ),
    "new": SubVerb(lessons.configure_new, lessons.run_new, help="create a course with a first lesson to edit"),
    "test": SubVerb(lessons.configure_test, lessons.run_test, help="test the checks of a course against its solutions"),
    "pack": SubVerb(pack.configure, pack.run, help="make a folder from which a class installs without a network"),
    "grade": SubVerb(grade.configure_grade, grade.run_grade, help="check the folders of many students in a sandbox"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
