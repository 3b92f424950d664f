"""Measure how time and memory of commands grow with their input: 1 000, 10 000 and 100 000 objects.

Run it with ``python -m benchmarks sizes``. Each figure is a process of its own: the time of the processor that it took,
and the most memory that it had at once. What a command takes for a single thing is taken off before the ratios, so that
they say what ten times as much costs; a command that is linear stays near ten. What a bound of the program refuses is
said to be refused; what takes more than four minutes is left out, and so is what is more than that. As many rows are
measured at once as there are processors.
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
_BARE = 1
_MOST_SECONDS = 240
"""The maximum processor time of a run in seconds. A longer run is ended."""
_LEAST_SECONDS = 0.1
"""Times below this, in seconds, are within the variation of a command's start."""
_LIKELY_SECONDS = 24.0
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
        refused: whether a limit of the program ended the run.
    """

    seconds: float
    megabytes: float
    refused: bool = False

    def __str__(self) -> str:
        return "refused" if self.refused else f"{self.seconds:.2f} s, {self.megabytes:.0f} MB"


@dataclass(frozen=True)
class SizeRow:
    """A command with increasing numbers of one kind of object.

    Attributes:
        command: the command line.
        thing: the kind of object.
        bare: the cost of a single object.
        figures: the cost of each of `SIZES`; None for omitted sizes.
    """

    command: str
    thing: str
    bare: Figure
    figures: Sequence[Figure | None]

    def cells(self) -> tuple[str, ...]:
        """Return the command, the object, a figure for each size, and the ratio of the last two sizes."""
        return (f"`{self.command}`", self.thing, *(str(figure or "-") for figure in self.figures), self._growth())

    def line(self) -> str:
        """Return the row as a line for a terminal."""
        figures = "".join(f"{figure or '-'!s:>20}" for figure in self.figures)
        return f"{self.command:20} {self.thing:32}{figures}   {self._growth()}"

    def _growth(self) -> str:
        measured = [figure for figure in self.figures if figure is not None and not figure.refused]
        if len(measured) < 2:
            return "-"
        *_, before, last = measured
        first = before.seconds - self.bare.seconds
        seconds = f"{(last.seconds - self.bare.seconds) / first:.1f}x" if first > _LEAST_SECONDS else "-"
        return f"{seconds}, {last.megabytes / before.megabytes:.1f}x"


class Case(NamedTuple):
    """A measured case.

    Attributes:
        command: the name of the command in the table.
        thing: the kind of object.
        make: writes the input with so many into a folder, and returns the command line.
    """

    command: str
    thing: str
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
        yield _description(command, thing, partial(_robot, chain="chain" in thing))
    yield Case("view, up to what it tells a page", "links in a star", _view)
    for thing, text in _PLAIN.items():
        yield _description("check", thing, text)
    for thing, text in _MACROS.items():
        yield _description("xacro", thing, text, ending="xacro")
    yield Case("xacro", "included files", _includes)
    yield Case("launch --print", "actions", partial(_launch, option="--print"))
    yield Case("launch --show-args", "declared arguments", partial(_launch, option="--show-args"))
    yield Case("a node reads a parameter file", "parameters", _parameters)
    yield Case("bag info", "messages", _recording)
    yield Case("a page opens a .rviz file", "displays", _configuration)


def rows(names: Sequence[str] = ()) -> list[SizeRow]:
    """Measure, and print each row to standard error as soon as it is complete."""
    wanted = [case for case in cases() if not names or any(name in f"{case.command}: {case.thing}" for name in names)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(_row, wanted))


def _row(case: Case) -> SizeRow:
    figures: list[Figure | None] = []
    for count in SIZES:
        before = figures[-1] if figures else None
        is_long = bool(figures) and (before is None or before.refused or before.seconds > _LIKELY_SECONDS)
        figures.append(None if is_long else _figure(case, count))
    bare = _figure(case, _BARE)
    assert bare is not None
    row = SizeRow(case.command, case.thing, bare, figures)
    print(row.line(), file=sys.stderr, flush=True)
    return row


def _figure(case: Case, count: int) -> Figure | None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = case.make(folder, count)
        known = {**os.environ, "LC_ALL": "C.UTF-8"}
        known.pop("PYTHONDONTWRITEBYTECODE", None)
        run = [sys.executable, "-c", _PROBE, str(_MOST_SECONDS), *words]
        result = subprocess.run(run, cwd=folder, env=known, check=True, capture_output=True, text=True)
        status, seconds, peak = json.loads(result.stdout)
        if status in (-signal.SIGXCPU, -signal.SIGKILL):
            return None
        if status not in (0, 1):
            raise RuntimeError(f"{words} ended with {status}: {result.stderr[-2000:]}")
        kilo = 1000 if sys.platform != "darwin" else 1_000_000
        return Figure(seconds, peak / kilo, _BOUND in result.stderr)


_PROBE = """
import json, resource, subprocess, sys
most = int(sys.argv[1])
resource.setrlimit(resource.RLIMIT_CPU, (most, most))
done = subprocess.run(sys.argv[2:], stdout=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([done.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss]))
"""
"""A small process in between: what a command has at the most would else be no less than what this one has."""

_BOUND = "error[XAC60"
"""The beginning of a message about a limit."""


def _description(command: str, thing: str, text: Callable[[int], str], ending: str = "urdf") -> Case:
    def make(folder: Path, count: int) -> list[str]:
        path = folder / f"made.{ending}"
        path.write_text(text(count), encoding="utf-8")
        return [LINKWRIGHT, *command.replace("OUT", "out").split(), path.name]

    return Case(command, thing, make)


def _robot(count: int, *, chain: bool) -> str:
    links = "".join(_LINK.format(name=f"l{number}") for number in range(count + 1))
    parents = range(count) if chain else [0] * count
    joints = "".join(_JOINT.format(parent=f"l{parent}", child=f"l{n + 1}") for n, parent in enumerate(parents))
    return f'<robot name="made">\n{links}{joints}</robot>\n'


def _repeated(part: str, count: int, head: str = '<robot name="made">\n', tail: str = '<link name="l"/>') -> str:
    return head + "".join(part.replace("N", str(number)) for number in range(count)) + tail + "</robot>\n"


_PLAIN: dict[str, Callable[[int], str]] = {
    "materials": lambda count: _repeated('<material name="mN"><color rgba="1 0 0 1"/></material>\n', count),
    "attributes on one element": lambda count: _repeated(' aN="1"', count, '<robot name="made"><link name="l"', "/>"),
    "comments": lambda count: _repeated("<!-- remark N -->\n", count),
    "unknown elements": lambda count: _repeated("<thingN/>\n", count),
    "elements below <gazebo>": lambda count: _repeated(
        "<partN>1</partN>\n", count, '<robot name="made"><gazebo>', '</gazebo><link name="l"/>'
    ),
}

_MACROS: dict[str, Callable[[int], str]] = {
    "properties": lambda count: _repeated('<xacro:property name="pN" value="${N + 1}"/>\n', count, _XACRO),
    "expressions": lambda count: _repeated(
        '<material name="mN"><color rgba="${N / 1e6} 0 0 1"/></material>\n', count, _XACRO
    ),
    "calls of a macro": lambda count: _repeated(
        '<xacro:m name="mN"/>\n',
        count,
        _XACRO + '<xacro:macro name="m" params="name">'
        '<material name="${name}"><color rgba="1 0 0 1"/></material></xacro:macro>\n',
    ),
    "macros": lambda count: _repeated(
        '<xacro:macro name="mN" params="a"><link name="${a}"/></xacro:macro>\n', count, _XACRO
    ),
    "comments": lambda count: _repeated("<!-- remark N -->\n", count, _XACRO),
}


def _includes(folder: Path, count: int) -> list[str]:
    for number in range(count):
        (folder / f"part{number}.xacro").write_text(f'<robot><material name="m{number}"/></robot>\n', encoding="utf-8")
    text = _repeated('<xacro:include filename="partN.xacro"/>\n', count, _XACRO)
    (folder / "made.xacro").write_text(text, encoding="utf-8")
    return [LINKWRIGHT, "xacro", "made.xacro"]


def _launch(folder: Path, count: int, *, option: str) -> list[str]:
    action = "DeclareLaunchArgument(f'a{n}', default_value='1')" if "args" in option else "LogInfo(msg=f'{n}')"
    (folder / "made.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch.actions import DeclareLaunchArgument, LogInfo\n"
        f"def generate_launch_description():\n    return LaunchDescription([{action} for n in range({count})])\n",
        encoding="utf-8",
    )
    return [LINKWRIGHT, "launch", option, "made.launch.py"]


def _parameters(folder: Path, count: int) -> list[str]:
    lines = "".join(f"    p{number}: {number}\n" for number in range(count))
    (folder / "made.yaml").write_text(f"node:\n  ros__parameters:\n{lines}", encoding="utf-8")
    return _program("from linkwright.graph.parameters.files import read_parameter_file as read; read('made.yaml')")


def _recording(folder: Path, count: int) -> list[str]:
    with BagWriter(folder / "made") as bag:
        bag.add_topic("/chatter", "std_msgs/msg/String")
        for number in range(count):
            bag.write("/chatter", number + 1, b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00")
    return [LINKWRIGHT, "bag", "info", "made"]


def _configuration(folder: Path, count: int) -> list[str]:
    displays = "".join(
        f"    - Class: rviz_default_plugins/Axes\n      Name: Axes{number}\n      Enabled: true\n"
        for number in range(count)
    )
    (folder / "made.rviz").write_text(f"Visualization Manager:\n  Displays:\n{displays}", encoding="utf-8")
    return _program("from linkwright.viewer import RvizConfig; RvizConfig.load('made.rviz').text()")


def _view(folder: Path, count: int) -> list[str]:
    (folder / "made.urdf").write_text(_robot(count, chain=False), encoding="utf-8")
    return _program(
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


def _program(text: str) -> list[str]:
    return [sys.executable, "-c", text]


def main() -> None:
    """Measure and print; words choose rows."""
    show(rows(sys.argv[1:]))


if __name__ == "__main__":
    main()
