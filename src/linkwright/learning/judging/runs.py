"""Runs of a program in simulated worlds, as fast as possible, one for each seed."""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.judging.companions import start_companions
from linkwright.learning.judging.exercise import Exercise
from linkwright.learning.judging.judge import Judge
from linkwright.learning.judging.world import JudgePlugin, status, write_world
from linkwright.testing import BudgetExceededError, Program, SteppedSimulation
from linkwright.wire.switch import switched_off

_STEP_S = 0.2
_TIME_AFTER_END_S = 2.0
"""The simulated time for which a run continues after its program has ended, until the robot has stopped."""

_ALL_POINTS = 100.0

_SIMULATED_TIME = ("--ros-args", "-p", "use_sim_time:=true")


@dataclass(frozen=True)
class RunResult:
    """The result of a run.

    Attributes:
        seed: the seed of the run.
        score: the points, from 0 to 100.
        data: the state of the judge at the end, as in ``/judge/status``.
        error: the traceback of the exception that ended the program, or None.
    """

    seed: int
    score: float
    data: dict[str, Any]
    error: str | None

    def to_data(self) -> dict[str, Any]:
        """Return the result as data for JSON."""
        return {"seed": self.seed, **self.data, "error": self.error}


def judge_program(
    exercise: Exercise, program: Path, seeds: Sequence[int], *, rival: Path | None = None, budget: float = 30.0
) -> Iterator[RunResult]:
    """Run a program in the worlds of an exercise, and yield the result for each seed.

    The program runs in lockstep with the world, so a result depends on the program and the seed alone. It gets the
    topics of its robot, but not the simulator's services, which could move the robot or reveal its pose. It does not
    communicate with other processes.

    Args:
        exercise: the exercise with its world and judge.
        program: the file of the program.
        seeds: the seed of each run.
        rival: the program of the other robot; None for that of the exercise. It is ignored if there is no other robot.
        budget: the longest time for which a program may compute without waiting, in seconds, not counting the time in
            which it waits for a processor.

    Raises:
        LinkwrightError: the simulation is not installed, or a file of the exercise has errors.
        OSError: the program cannot be read.
    """
    for seed in seeds:
        with switched_off(), ScratchFolder("judge") as folder:
            result = _run_in_world(exercise, program, rival, seed, Path(folder), budget)
        yield result


def _run_in_world(
    exercise: Exercise, program: Path, rival_program: Path | None, seed: int, folder: Path, budget: float
) -> RunResult:
    arrangement = write_world(exercise, seed, folder, publishes=False)
    error: BaseException | None = None
    with SteppedSimulation(
        arrangement.world,
        arrangement.robot,
        pose=arrangement.pose,
        seed=seed,
        services=False,
        robot_state_publisher=arrangement.robot is not None,
        strict=False,
    ) as test:
        judge = _find_judge(test)
        companions = test.run(start_companions(exercise, arrangement.robot, test.graph))
        arguments = [str(argument) for argument in exercise.settings.get("program_arguments", ())]
        started = test.start_program(program, [*arguments, *_SIMULATED_TIME], budget=budget, seed=seed)
        rival = None
        if exercise.rival is not None:
            words = [*exercise.rival.ros_arguments, *_SIMULATED_TIME[1:]]
            rival = test.start_program(rival_program or exercise.rival.program, words, budget=budget, seed=seed)
        error = _advance_to_end(test, judge, started, rival)
        data, score = status(judge), judge.score
        for companion in companions:
            companion.close()
    lines = None if error is None else "".join(_format_user_traceback(error, program))
    return RunResult(seed, score, data, lines)


def _advance_to_end(
    test: SteppedSimulation, judge: Judge, program: Program, rival: Program | None
) -> BaseException | None:
    """Advance until the run ends, and return the exception of the learner's program."""
    end_s = judge.exercise.time_limit + 1.0
    while not judge.is_finished and test.now < end_s:
        test.advance(_STEP_S)
        if _commands_rival(test, judge.exercise, program):
            judge.penalize(_ALL_POINTS, en="", zh="")
            judge.fail(
                en="the program published on a topic of the other robot", zh="程序在另一个机器人的话题上发布了消息"
            )
        if not program.is_running:
            end_s = min(end_s, test.now + _TIME_AFTER_END_S)
    error = program.error or next((error for error in test.errors if not _is_fault_of(error, rival)), None)
    if error is not None:
        judge.note(en=f"the program ended with an error: {error}", zh=f"程序因错误而结束：{error}")
    elif not judge.is_finished and not program.is_running:
        judge.note(en="the program ended before the task was done", zh="任务完成之前程序就结束了")
    if rival is not None and not rival.is_running:
        judge.note(en="the program of the other robot ended", zh="另一个机器人的程序结束了")
    if not judge.is_finished:
        judge.at_time_limit()
    return error


def _commands_rival(test: SteppedSimulation, exercise: Exercise, program: Program) -> bool:
    """Return whether a program publishes on a topic of the other robot."""
    if exercise.rival is None:
        return False
    topics = [f"/{exercise.rival.model}/{topic}" for topic in exercise.rival.topics]
    own_names = set(program.node_names)
    publishers = (info for topic in topics for info in test.node.get_publishers_info_by_topic(topic))
    return any((info.node_name, info.node_namespace) in own_names for info in publishers)


def _is_fault_of(error: BaseException, program: Program | None) -> bool:
    if program is None:
        return False
    return error is program.error or (isinstance(error, BudgetExceededError) and error.program is program)


def _find_judge(test: SteppedSimulation) -> Judge:
    plugin = next(plugin for plugin in test.world_plugins() if isinstance(plugin, JudgePlugin))
    return plugin.judge


def _format_user_traceback(error: BaseException, program: Path) -> list[str]:
    """Return the lines of a traceback from the program's file on."""
    frames = traceback.extract_tb(error.__traceback__)
    first = next((i for i, frame in enumerate(frames) if frame.filename == str(program.resolve())), len(frames))
    return [*traceback.format_list(list(frames)[first:]), *traceback.format_exception_only(error)]
