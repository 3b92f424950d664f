"""The commands of ROS 2, with the arguments, output and exit statuses of the originals."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from linkwright.cli.command import main as linkwright
from linkwright.cli.exit_status import FINDINGS, FINE, run_command
from linkwright.cli.tools.gz import run_gz, run_simulator
from linkwright.cli.tools.ros2 import ros2
from linkwright.diagnostics import LinkwrightError, missing_extra, print_diagnostics
from linkwright.hosting.rqt_programs import RQT_COMMANDS
from linkwright.process.interruption import raise_interrupts

_FAILURE_STATUS = 255
"""The exit status of urdfdom's programs for errors (``return -1``)."""


def main(name: str, words: Sequence[str]) -> int:
    """Run one of the commands of ROS 2.

    Args:
        name: a key of `TOOLS`.
        words: the arguments after the program's name.

    Returns:
        The exit status.
    """
    return run_command(lambda: TOOLS[name](words))


def _run_xacro(words: Sequence[str]) -> int:
    return linkwright(["xacro", *words], program="")


def _check_urdf(words: Sequence[str]) -> int:
    """Check a URDF file, and print the result as urdfdom's ``check_urdf`` does.

    The findings of Linkwright's own rules are not printed; use ``linkwright check`` for them.
    """
    if not words:
        print("Expect URDF xml file to parse", file=sys.stderr)
        return _FAILURE_STATUS
    from linkwright.descriptions import examine
    from linkwright.urdf import tree_text

    try:
        reading = examine(words[0])
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return _FAILURE_STATUS
    print_diagnostics(reading.diagnostics, sys.stderr)
    if reading.robot is None:
        print("ERROR: Model Parsing the xml failed", file=sys.stderr)
        return _FAILURE_STATUS
    print(tree_text(reading.robot), end="")
    return FINE


def _run_urdf_to_graphviz(words: Sequence[str]) -> int:
    if not 1 <= len(words) <= 2:
        print(
            "Usage: urdf_to_graphviz input.xml [OUTPUT]\n"
            "  Will create either $ROBOT_NAME.gv & $ROBOT_NAME.pdf in CWD\n"
            "  or OUTPUT.gv & OUTPUT.pdf.",
            file=sys.stderr,
        )
        return _FAILURE_STATUS
    return linkwright(["diagram", *words])


def _run(package: str, executable: str, words: Sequence[str]) -> int:
    return linkwright(["run", package, executable, *words])


def _run_rqt_bag(words: Sequence[str]) -> int:
    """Show a recording, or open the page, which can record, if no recording is given."""
    recordings = [word for word in words if not word.startswith("-") and Path(word).exists()]
    return linkwright(["view", recordings[0]]) if recordings else _run("rqt_bag", "rqt_bag", words)


def _run_launch_test(words: Sequence[str]) -> int:
    return linkwright(["test", *words], program="launch_test")


def _run_colcon(words: Sequence[str]) -> int:
    try:
        from colcon_core.command import main as colcon  # type: ignore[import-untyped]  # it ships no types
    except ModuleNotFoundError as error:
        print_diagnostics(missing_extra("SHELL102", error).diagnostics, sys.stderr)
        return FINDINGS

    sys.argv[0] = "colcon"
    raise_interrupts()
    status = colcon(argv=list(words))
    return status if isinstance(status, int) else FINE


TOOLS: dict[str, Callable[[Sequence[str]], int]] = {
    "ros2": ros2,
    "xacro": _run_xacro,
    "check_urdf": _check_urdf,
    "urdf_to_graphviz": _run_urdf_to_graphviz,
    "rviz2": partial(_run, "rviz2", "rviz2"),
    "gz": partial(run_gz, "gz"),
    "ign": partial(run_gz, "ign"),
    **{name: partial(run_simulator, name) for name in ("gazebo", "gzserver", "gzclient")},
    **{executable: partial(_run, package, executable) for executable, package in RQT_COMMANDS.items()},
    "rqt_bag": _run_rqt_bag,
    "launch_test": _run_launch_test,
    "colcon": _run_colcon,
}
"""The functions that run the commands with their arguments and return the exit status."""
