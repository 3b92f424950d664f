"""The command ``learn`` and its subcommands."""

from __future__ import annotations

from functools import partial

from linkwright.cli.learn import grade, judge, lessons, steps
from linkwright.cli.nested import SubVerb, configure_nested, run_nested

VERBS = {
    "list": SubVerb(steps.configure_list, steps.run_list, help="list the lessons and steps of a course, with progress"),
    "show": SubVerb(steps.configure_show, steps.run_show, help="print the text of a step, and copy its lesson's files"),
    "check": SubVerb(steps.configure_check, steps.run_check, help="check a step, and print what is still missing"),
    "answer": SubVerb(steps.configure_answer, steps.run_answer, help="answer a step that asks for a number"),
    "hint": SubVerb(steps.configure_hint, steps.run_hint, help="print the next hint for a step"),
    "solution": SubVerb(steps.configure_solution, steps.run_solution, help="copy the solution of a step"),
    "exercises": SubVerb(judge.configure_exercises, judge.run_exercises, help="list the exercises with a judge"),
    "judge": SubVerb(judge.configure_judge, judge.run_judge, help="judge a program for an exercise in several worlds"),
    "world": SubVerb(judge.configure_world, judge.run_world, help="simulate the world of an exercise in real time"),
    "new": SubVerb(lessons.configure_new, lessons.run_new, help="create a course with a first lesson to edit"),
    "test": SubVerb(lessons.configure_test, lessons.run_test, help="test the checks of a course against its solutions"),
    "grade": SubVerb(grade.configure_grade, grade.run_grade, help="check the folders of many students in a sandbox"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
