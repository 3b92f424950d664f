"""``linkwright learn exercises``, ``judge`` and ``world``: exercises in simulated worlds.

A judge scores the programs.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from contextlib import contextmanager, redirect_stdout
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.simulation_options import add_simulation_options
from linkwright.cli.view import add_viewer_options
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, phrase
from linkwright.diagnostics.translation import language, localized
from linkwright.files.scratch_folders import ScratchFolder

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from linkwright.learning.judging.exercise import Exercise
    from linkwright.learning.judging.runs import RunResult
    from linkwright.viewer import Viewer

_PASS_SCORE = 50.0
"""The minimum mean score, of 100 points, with which a program passes."""


def configure_exercises(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn exercises``."""
    parser.add_argument("exercise", metavar="EXERCISE", nargs="?", help="print the text of an exercise")


def run_exercises(arguments: argparse.Namespace) -> int:
    """List the exercises, or print the text of one."""
    from linkwright.learning.judging.exercise import find_exercise, list_exercise_names

    if arguments.exercise is not None:
        print(find_exercise(arguments.exercise).text(language()))
        return 0
    for name in list_exercise_names():
        exercise = find_exercise(name)
        minutes = localized(phrase("{minutes} min", minutes=exercise.minutes))
        print(f"{name:<20} {'*' * exercise.difficulty:<5} {minutes:>7}  {exercise.title.get(language())}")
    return 0


def configure_judge(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn judge``."""
    parser.add_argument("exercise", metavar="EXERCISE", help="an exercise by its name, or the folder of one")
    parser.add_argument(
        "program", metavar="PROGRAM", nargs="?", type=Path, help="the program to judge (default: EXERCISE.py)"
    )
    parser.add_argument(
        "--seeds",
        metavar="N",
        type=int,
        default=3,
        help="the number of runs, which differ in their worlds (default: 3)",
    )
    _add_rival(parser)
    parser.add_argument("--start", action="store_true", help="create PROGRAM from the template of the exercise")
    parser.add_argument("--json", action="store_true", help="print the result as JSON, in all languages")


def run_judge(arguments: argparse.Namespace) -> int:
    """Judge a program, and return 1 if its mean score is below 50."""
    from linkwright.learning.judging.exercise import find_exercise
    from linkwright.learning.judging.runs import judge_program

    exercise = find_exercise(arguments.exercise)
    program = arguments.program or Path(f"{exercise.id}.py")
    if arguments.start:
        return _copy_template(exercise, program)
    _require_program(program, phrase("create it from the template of the exercise with --start"))
    rival = _find_rival_program(exercise, arguments.rival)
    if arguments.seeds < 1:
        raise LinkwrightError(Diagnostic("LEARN143", phrase("--seeds must be at least 1")))
    results: list[RunResult] = []
    with redirect_stdout(sys.stderr):  # the judged program may print, but stdout contains only the result
        for result in judge_program(exercise, program, range(arguments.seeds), rival=rival):
            results.append(result)
            if not arguments.json:
                print(_format_run(exercise, result), flush=True)
    mean = round(sum(result.score for result in results) / len(results), 1)
    if arguments.json:
        data = {"exercise": exercise.id, "score": mean, "runs": [result.to_data() for result in results]}
        print(json.dumps(data, ensure_ascii=False))
    else:
        _print_table(exercise, results, mean)
    return 0 if mean >= _PASS_SCORE else 1


def configure_world(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn world``."""
    parser.add_argument("exercise", metavar="EXERCISE", help="an exercise by its name, or the folder of one")
    parser.add_argument(
        "program",
        metavar="PROGRAM",
        nargs="?",
        type=Path,
        help="your program, which is created from the template if it does not exist (default: EXERCISE.py)",
    )
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="the seed of the world (default: 0)")
    _add_rival(parser)
    add_simulation_options(parser)
    add_viewer_options(parser, offers_terminal=False)


def _add_rival(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--rival",
        metavar="FILE",
        type=Path,
        help="the program of the other robot (default: the program of the exercise)",
    )


def _require_program(program: Path, hint: Phrase | None = None) -> None:
    if not program.is_file():
        message = phrase("there is no program '{path}'", path=display_path(program))
        raise LinkwrightError(Diagnostic("LEARN142", message, hint=hint))


def _find_rival_program(exercise: Exercise, chosen_program: Path | None) -> Path | None:
    """Return the program of the other robot, or None if the exercise has no other robot.

    Raises:
        LinkwrightError: LEARN142, there is no such program; LEARN145, a program is chosen for an exercise with one
            robot.
    """
    if chosen_program is None:
        return None if exercise.rival is None else exercise.rival.program
    if exercise.rival is None:
        message = phrase("the exercise '{name}' has only one robot, so `--rival` has no effect", name=exercise.id)
        raise LinkwrightError(Diagnostic("LEARN145", message, hint=phrase("leave out the option")))
    _require_program(chosen_program)
    return chosen_program.absolute()


def run_world(arguments: argparse.Namespace) -> int:
    """Simulate the world of an exercise in real time, with its robot and its judge."""
    from linkwright.cli.command import create_parser
    from linkwright.cli.sim import run
    from linkwright.learning.judging.companions import plan_companions
    from linkwright.learning.judging.exercise import find_exercise
    from linkwright.learning.judging.world import write_world

    exercise = find_exercise(arguments.exercise)
    program = (arguments.program or Path(f"{exercise.id}.py")).absolute()
    rival = _find_rival_program(exercise, arguments.rival)
    if not arguments.headless and not program.exists():
        _copy_template(exercise, program)
    with ScratchFolder("exercise") as folder:
        arrangement = write_world(exercise, arguments.seed, Path(folder), publishes=True)
        words = [str(arrangement.world)]
        if arrangement.robot is not None:
            words.append(str(arrangement.robot))
        sim_arguments = create_parser("sim").parse_args(words)
        vars(sim_arguments).update(vars(arguments), terminal=not arguments.headless)
        sim_arguments.x, sim_arguments.y, sim_arguments.z, _, _, sim_arguments.Y = arrangement.pose
        with _running_rival(exercise, rival):
            nodes = plan_companions(exercise, arrangement.robot)
            return run(sim_arguments, partial(_show_exercise, exercise, program, rival), nodes)


@contextmanager
def _running_rival(exercise: Exercise, program: Path | None) -> Iterator[None]:
    """Run the program of the other robot, if there is one.

    The program runs in a process with the environment of ``linkwright shell``. It starts with the first command to the
    learner's robot.
    """
    if exercise.rival is None or program is None:
        yield
        return
    shell_command = [sys.executable, "-m", "linkwright", "shell", "--", sys.executable]
    rival_arguments = ["-m", "linkwright.cli.learn.rival", f"/{exercise.rival.start}", str(program)]
    command = [*shell_command, *rival_arguments, *exercise.rival.ros_arguments, "-p", "use_sim_time:=true"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL) as process:  # noqa: S603 - the user's own program
        try:
            yield
        finally:
            process.terminate()


def _show_exercise(exercise: Exercise, program: Path, rival: Path | None, viewer: Viewer) -> None:
    from linkwright.learning.page.exercise_guide import ExerciseGuide
    from linkwright.learning.page.feature import CourseFeature
    from linkwright.panels.source_editor.feature import SourceEditorFeature

    viewer.add_feature(SourceEditorFeature).edit_workspace(program.parent)
    context = viewer.context
    viewer.add_feature(CourseFeature).show(ExerciseGuide(exercise, program, context.pages.publish, context.node, rival))


def _copy_template(exercise: Exercise, program: Path) -> int:
    if program.exists():
        raise LinkwrightError(
            Diagnostic("LEARN144", phrase("'{path}' already exists, so it is not changed", path=display_path(program)))
        )
    program.write_text(exercise.template.read_text(encoding="utf-8"), encoding="utf-8")
    print(display_path(program))
    return 0


def _format_run(exercise: Exercise, result: RunResult) -> str:
    return localized(phrase("seed {seed}: {figure}", seed=result.seed, figure=_format_figure(exercise, result)))


def _format_figure(exercise: Exercise, result: RunResult) -> str:
    figure = exercise.figure
    value = f"{result.data['figure']:.{figure.decimals}f} {figure.unit}".strip()
    return value if result.data["is_solved"] else f"({value})"


def _print_table(exercise: Exercise, results: Sequence[RunResult], mean: float) -> None:
    lang = language()
    print(exercise.title.get(lang))
    for result in results:
        print(f"  {result.seed:>3}  {_format_figure(exercise, result):>12}  {result.score:>6.1f}")
        for reason in result.data["reasons"]:
            print(f"         {reason.get(lang) or reason['en']}")
        if result.error is not None:
            print("".join(f"         {line}\n" for line in result.error.rstrip().splitlines()), end="")
    print(
        localized(phrase("{name}: mean score {score} of 100", name=exercise.figure.name.get(lang), score=f"{mean:.1f}"))
    )
