"""Measure how time and memory of commands grow with the number of objects.

Run it with ``python -m benchmarks sizes``. Each figure is measured in a separate process: its processor time and its
peak memory. The cost for a single object is subtracted before ratios are computed, so a ratio is the cost of ten times
as many objects; it is about ten for a linear command. Input that exceeds a limit of the program is reported as refused.
Sizes that take more than four minutes are left out, as are all larger sizes. As many rows are measured at once as there
are processors.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from benchmarks.measure import LINKWRIGHT, show
from linkwright.bag import BagWriter

SIZES = (1_000, 10_000, 100_000)
_SINGLE_OBJECT = 1
_MAX_RUN_S = 240
"""The maximum processor time of a run in seconds. A longer run is ended."""
_MIN_SIGNIFICANT_S = 0.1
"""Times below this, in seconds, are within the variation of a command's start."""
_MAX_S_BEFORE_LARGER_SIZE = 24.0
"""If a size takes more seconds than this, ten times as many objects are not tried."""

_XACRO = '<robot name="made" xmlns:xacro="http://ros.org/wiki/xacro">\n'
_LINK = (
    '<link name="{name}">'
    '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>\n'
)
_JOINT = (
    '<joint name="j{child}" type="revolute"><parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n'
)


class Figure(NamedTuple):
    """The cost of one run.

    Attributes:
        seconds: the processor time.
        megabytes: the peak memory.
        is_refused: whether a limit of the program ended the run.
    """

    seconds: float
    megabytes: float
    is_refused: bool = False

    def __str__(self) -> str:
        return "refused" if self.is_refused else f"{self.seconds:.2f} s, {self.megabytes:.0f} MB"


@dataclass(frozen=True)
class SizeRow:
    """A command with increasing numbers of one kind of object.

    Attributes:
        command: the command line.
        object_kind: the kind of object.
        single_object: the cost of a single object.
        figures: the cost of each of `SIZES`; None for omitted sizes.
    """

    command: str
    object_kind: str
    single_object: Figure
    figures: Sequence[Figure | None]

    def cells(self) -> tuple[str, ...]:
        """Return the command, the object, a figure per size, and the ratio of the last two sizes."""
        return (
            f"`{self.command}`",
            self.object_kind,
            *(str(figure or "-") for figure in self.figures),
            self._format_growth(),
        )

    def line(self) -> str:
        """Return the row as a line for a terminal."""
        figures = "".join(f"{figure or '-'!s:>20}" for figure in self.figures)
        return f"{self.command:20} {self.object_kind:32}{figures}   {self._format_growth()}"

    def _format_growth(self) -> str:
        measured = [figure for figure in self.figures if figure is not None and not figure.is_refused]
        if len(measured) < 2:
            return "-"
        *_, before, last = measured
        first = before.seconds - self.single_object.seconds
        seconds = f"{(last.seconds - self.single_object.seconds) / first:.1f}x" if first > _MIN_SIGNIFICANT_S else "-"
        return f"{seconds}, {last.megabytes / before.megabytes:.1f}x"


class Case(NamedTuple):
    """A measured case.

    Attributes:
        command: the name of the command in the table.
        object_kind: the kind of object.
        make: writes the input with a number of objects into a folder, and returns the command line.
    """

    command: str
    object_kind: str
    make: Callable[[Path, int], list[str]]


def cases() -> Iterator[Case]:
    """Yield all cases."""
    for command, thing in (
        ("check", "links in a chain"),
        ("check", "links in a star"),
        ("inertia", "links in a chain"),
        ("export OUT.html", "links in a star"),
        ("export OUT.glb", "links in a star"),
        ("diagram", "links in a star, laid out by Graphviz"),
    ):
        yield _make_description_case(command, thing, partial(_make_robot, chain="chain" in thing))
    yield Case("view, up to what it tells a page", "links in a star", _make_view_command)
    for thing, text in _PLAIN_TEXTS.items():
        yield _make_description_case("check", thing, text)
    for thing, text in _MACRO_TEXTS.items():
        yield _make_description_case("xacro", thing, text, ending="xacro")
    yield Case("xacro", "included files", _write_includes)
    yield Case("launch --print", "actions", partial(_write_launch, option="--print"))
    yield Case("launch --show-args", "declared arguments", partial(_write_launch, option="--show-args"))
    yield Case("a node reads a parameter file", "parameters", _write_parameters)
    yield Case("bag info", "messages", _write_recording)
    yield Case("a page opens a .rviz file", "displays", _write_configuration)


def rows(names: Sequence[str] = ()) -> list[SizeRow]:
    """Measure, and print each row to standard error as soon as it is complete."""
    selected_cases = [
        case for case in cases() if not names or any(name in f"{case.command}: {case.object_kind}" for name in names)
    ]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(_measure_row, selected_cases))


def _measure_row(case: Case) -> SizeRow:
    figures: list[Figure | None] = []
    for count in SIZES:
        previous_figure = figures[-1] if figures else None
        is_long = bool(figures) and (
            previous_figure is None or previous_figure.is_refused or previous_figure.seconds > _MAX_S_BEFORE_LARGER_SIZE
        )
        figures.append(None if is_long else _measure_figure(case, count))
    bare = _measure_figure(case, _SINGLE_OBJECT)
    assert bare is not None
    row = SizeRow(case.command, case.object_kind, bare, figures)
    print(row.line(), file=sys.stderr, flush=True)
    return row


def _measure_figure(case: Case, count: int) -> Figure | None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = case.make(folder, count)
        known = {**os.environ, "LC_ALL": "C.UTF-8"}
        known.pop("PYTHONDONTWRITEBYTECODE", None)
        run = [sys.executable, "-c", _PROBE_CODE, str(_MAX_RUN_S), *words]
        result = subprocess.run(run, cwd=folder, env=known, check=True, capture_output=True, text=True)
        status, seconds, peak = json.loads(result.stdout)
        if status in (-signal.SIGXCPU, -signal.SIGKILL):
            return None
        if status not in (0, 1):
            raise RuntimeError(f"{words} ended with {status}: {result.stderr[-2000:]}")
        kilo = 1000 if sys.platform != "darwin" else 1_000_000
        return Figure(seconds, peak / kilo, _LIMIT_MESSAGE_START in result.stderr)


_PROBE_CODE = """
import json, resource, subprocess, sys
most = int(sys.argv[1])
resource.setrlimit(resource.RLIMIT_CPU, (most, most))
done = subprocess.run(sys.argv[2:], stdout=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([done.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss]))
"""
"""A small process that starts the command; otherwise, the peak memory of the command would include this process's."""

_LIMIT_MESSAGE_START = "error[XAC60"
"""The beginning of a message about a limit."""


def _make_description_case(command: str, object_kind: str, text: Callable[[int], str], ending: str = "urdf") -> Case:
    def make(folder: Path, count: int) -> list[str]:
        path = folder / f"made.{ending}"
        path.write_text(text(count), encoding="utf-8")
        return [LINKWRIGHT, *command.replace("OUT", "out").split(), path.name]

    return Case(command, object_kind, make)


def _make_robot(count: int, *, chain: bool) -> str:
    links = "".join(_LINK.format(name=f"l{number}") for number in range(count + 1))
    parents = range(count) if chain else [0] * count
    joints = "".join(_JOINT.format(parent=f"l{parent}", child=f"l{n + 1}") for n, parent in enumerate(parents))
    return f'<robot name="made">\n{links}{joints}</robot>\n'


def _repeat_part(part: str, count: int, head: str = '<robot name="made">\n', tail: str = '<link name="l"/>') -> str:
    return head + "".join(part.replace("N", str(number)) for number in range(count)) + tail + "</robot>\n"


_PLAIN_TEXTS: dict[str, Callable[[int], str]] = {
    "materials": lambda count: _repeat_part('<material name="mN"><color rgba="1 0 0 1"/></material>\n', count),
    "attributes on one element": lambda count: _repeat_part(
        ' aN="1"', count, '<robot name="made"><link name="l"', "/>"
    ),
    "comments": lambda count: _repeat_part("<!-- remark N -->\n", count),
    "unknown elements": lambda count: _repeat_part("<thingN/>\n", count),
    "elements below <gazebo>": lambda count: _repeat_part(
        "<partN>1</partN>\n", count, '<robot name="made"><gazebo>', '</gazebo><link name="l"/>'
    ),
}

_MACRO_TEXTS: dict[str, Callable[[int], str]] = {
    "properties": lambda count: _repeat_part('<xacro:property name="pN" value="${N + 1}"/>\n', count, _XACRO),
    "expressions": lambda count: _repeat_part(
        '<material name="mN"><color rgba="${N / 1e6} 0 0 1"/></material>\n', count, _XACRO
    ),
    "calls of a macro": lambda count: _repeat_part(
        '<xacro:m name="mN"/>\n',
        count,
        _XACRO + '<xacro:macro name="m" params="name">'
        '<material name="${name}"><color rgba="1 0 0 1"/></material></xacro:macro>\n',
    ),
    "macros": lambda count: _repeat_part(
        '<xacro:macro name="mN" params="a"><link name="${a}"/></xacro:macro>\n', count, _XACRO
    ),
    "comments": lambda count: _repeat_part("<!-- remark N -->\n", count, _XACRO),
}


def _write_includes(folder: Path, count: int) -> list[str]:
    for number in range(count):
        (folder / f"part{number}.xacro").write_text(f'<robot><material name="m{number}"/></robot>\n', encoding="utf-8")
    text = _repeat_part('<xacro:include filename="partN.xacro"/>\n', count, _XACRO)
    (folder / "made.xacro").write_text(text, encoding="utf-8")
    return [LINKWRIGHT, "xacro", "made.xacro"]


def _write_launch(folder: Path, count: int, *, option: str) -> list[str]:
    action = "DeclareLaunchArgument(f'a{n}', default_value='1')" if "args" in option else "LogInfo(msg=f'{n}')"
    (folder / "made.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch.actions import DeclareLaunchArgument, LogInfo\n"
        f"def generate_launch_description():\n    return LaunchDescription([{action} for n in range({count})])\n",
        encoding="utf-8",
    )
    return [LINKWRIGHT, "launch", option, "made.launch.py"]


def _write_parameters(folder: Path, count: int) -> list[str]:
    lines = "".join(f"    p{number}: {number}\n" for number in range(count))
    (folder / "made.yaml").write_text(f"node:\n  ros__parameters:\n{lines}", encoding="utf-8")
    return _make_program_command(
        "from linkwright.graph.parameters.files import read_parameter_file as read; read('made.yaml')"
    )


def _write_recording(folder: Path, count: int) -> list[str]:
    with BagWriter(folder / "made") as bag:
        bag.add_topic("/chatter", "std_msgs/msg/String")
        for number in range(count):
            bag.write("/chatter", number + 1, b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00")
    return [LINKWRIGHT, "bag", "info", "made"]


def _write_configuration(folder: Path, count: int) -> list[str]:
    displays = "".join(
        f"    - Class: rviz_default_plugins/Axes\n      Name: Axes{number}\n      Enabled: true\n"
        for number in range(count)
    )
    (folder / "made.rviz").write_text(f"Visualization Manager:\n  Displays:\n{displays}", encoding="utf-8")
    return _make_program_command("from linkwright.viewer import RvizConfig; RvizConfig.load('made.rviz').text()")


def _make_view_command(folder: Path, count: int) -> list[str]:
    (folder / "made.urdf").write_text(_make_robot(count, chain=False), encoding="utf-8")
    return _make_program_command(
        "from linkwright.cli.exit_status import run_command\n"
        "from linkwright.descriptions import DescriptionLibrary, examine\n"
        "from linkwright.packages import PackageFinder\n"
        "from linkwright.viewer.model_snapshot import take_model_snapshot\n"
        "finder, library = PackageFinder(), DescriptionLibrary()\n"
        "def load():\n"
        "    made = examine('made.urdf', packages=finder, xacro=True)\n"
        "    take_model_snapshot(library.store(made), made.robot, library, finder)\n"
        "    return 0\n"
        "raise SystemExit(run_command(load))"
    )


def _make_program_command(text: str) -> list[str]:
    return [sys.executable, "-c", text]


def main() -> None:
    """Measure and print; words choose rows."""
    show(rows(sys.argv[1:]))


if __name__ == "__main__":
    main()
