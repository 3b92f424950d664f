"""The ``linkwright`` command: finds the verb, runs it, turns errors into messages and exit statuses.

Exit statuses: 0 fine, 1 findings or an error in what the user gave, 2 wrong usage, 3 a bug of ours, 130 interrupted.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module

from linkwright._version import __version__
from linkwright.cli.endings import FINE, USAGE, status_of
from linkwright.cli.language import LANGUAGE_HELP, said_in_help, take_language
from linkwright.diagnostics import did_you_mean
from linkwright.diagnostics.translation import set_language
from linkwright.loading.lean_typing import TYPE_CHECKING, Protocol, cast
from linkwright.process.interruption import end_at_once, raise_interrupts

if TYPE_CHECKING:
    import argparse

    from linkwright.cli.nested import SubVerb

GROUPS = {
    "robot descriptions": {
        "view": "show a URDF or xacro file in the browser, with joint sliders",
        "check": "check URDF, xacro and SDF files and whole packages; for one file, print its link tree",
        "xacro": "expand a xacro file to URDF, list its arguments, or explain its elements",
        "diff": "compare two descriptions, or a description with a commit: links, joints, origins, masses",
        "explain": "explain a diagnostic code, or an element or attribute of URDF",
        "inertia": "compare masses and inertias with the links' shapes, compute them, or write them",
        "diagram": "draw links and joints as urdf_to_graphviz does (.gv and PDF or SVG)",
        "export": "write a robot as one HTML file for any browser, or as glTF (.glb)",
        "convert": "convert a robot or world to SDF, to URDF, or to MJCF for MuJoCo",
    },
    "packages and launch files": {
        "launch": "run a ROS 2 launch file; rviz2 opens as a page in the browser",
        "run": "run an executable of a package, built or from its sources",
        "test": "run the launch_testing tests of a file",
        "pkg": "create ROS packages, find them, and list their contents",
    },
    "simulation": {
        "drive": "drive a robot in a simulated world; missing masses, collisions and wheels are inferred",
        "sim": "simulate a world, with or without a robot, in the browser or headless",
        "world": "list worlds and models, create a world, or check one",
        "spawn": "add a robot or model to a running simulation",
        "sweep": "run a scenario over parameters and seeds in parallel, and tabulate the results",
    },
    "vision and voice": {
        "vision": "detect objects in images; train and evaluate detectors",
        "dataset": "render labelled images of a world in COCO and YOLO form, to train a detector",
        "voice": "try speech engines on recordings, and enrol words",
        "models": "download, verify and remove models for speech and vision",
    },
    "the running ROS graph": {
        "topic": "list, print, publish and measure topics",
        "node": "list and describe nodes",
        "param": "list, read and set parameters of nodes",
        "service": "list and call services",
        "action": "list actions and send goals",
        "interface": "list and show types of messages, services and actions",
        "lifecycle": "show and change the states of managed nodes",
        "component": "load, list and unload components in containers",
        "control": "show and change the controllers and hardware of ros2_control",
    },
    "bags": {
        "bag": "record topics, play recordings, and describe them",
    },
    "network and diagnosis": {
        "doctor": "explain what is wrong with the running nodes, topics and frames",
        "bridge": "carry topics and services between DDS and Zenoh",
        "multicast": "send or receive a datagram, to test multicast on the network",
        "daemon": "accepted for compatibility with ros2; Linkwright has no daemon",
    },
    "shell": {
        "shell": "open a shell with ros2, launch_test, xacro, check_urdf, urdf_to_graphviz, rviz2 and colcon",
        "completion": "print the completion script for bash, zsh or fish",
    },
}
"""The commands in the order in which the help lists them, with their help texts.

Each is a module or package of this package, which is loaded only when it is run.
"""

VERBS = {name: text for verbs in GROUPS.values() for name, text in verbs.items()}
"""The help text of each command."""

OTHER_NAMES = {"wtf": "doctor"}
"""Aliases of commands that ros2 has; the help does not list them."""

_IN_ORDER = frozenset({"pkg", "run", "shell"})
"""Commands whose arguments must be in order, besides those with subcommands: the rest belongs to another program. Other
commands accept options between arguments (`launch PACKAGE --no-open FILE`)."""

_GRAPH_GROUPS = ("the running ROS graph", "bags", "network and diagnosis")

_WITH_A_LOOP = frozenset({"view", "drive", "run", "sim", "spawn", "launch"}).union(
    *(GROUPS[title] for title in _GRAPH_GROUPS)
)
"""Commands that run an event loop or another program, which handle Ctrl-C themselves; before that there is nothing to
clean up."""

PROGRAM = "linkwright"

SUMMARY_HELP = (
    "A ROS 2 workbench for a robot: "
    "describe it, check it, see it, simulate it, drive it and test it, without installing ROS."
)
"""The description of Linkwright, the same in pyproject.toml, the READMEs and the documentation."""

MORE_HELP = "`linkwright COMMAND --help` describes a command. `linkwright --version` prints the version."

_OPTIONS = ("--help", "--lang", "--version")
"""The options that precede or replace a command."""

_COLLECT_AFTER = 50_000
"""The number of new objects that starts a garbage collection; Python's 700 would cost a short command a tenth of its
time."""

_COLLECT_FIRST_AFTER = 200_000
"""The number for the first collection: imports create more objects, and none of them is garbage."""


class Verb(Protocol):
    """The interface of a command's module."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Declare the command's arguments."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Run the command and return the exit status."""


def main(words: Sequence[str] | None = None, *, program: str = PROGRAM) -> int:
    """Run the command line and return its exit status; never raises.

    Args:
        words: the command line after the program's name; this process's if omitted.
        program: the program's name in usage lines, such as ``ros2``; empty if the command is the program.
    """
    whole_process = words is None
    if whole_process:
        _collect_seldom()
    try:
        return status_of(lambda: _dispatch(take_language(sys.argv[1:] if words is None else words), program))
    finally:
        set_language(None)
        if whole_process:
            end_at_once()
            gc.freeze()  # Python would collect garbage once more before it exits


def _collect_seldom() -> None:
    def looked(phase: str, _: object) -> None:
        if phase == "stop":
            gc.set_threshold(_COLLECT_AFTER)

    gc.set_threshold(_COLLECT_FIRST_AFTER)
    gc.callbacks.append(looked)


def verb(name: str) -> Verb:
    """Return the module of a command."""
    return cast("Verb", import_module(f"linkwright.cli.{name}"))


def parser_for(name: str, *, program: str = PROGRAM) -> argparse.ArgumentParser:
    """Return the argument parser of a command, for the command itself and the command reference."""
    from linkwright.cli.parsers import make_parser  # importing argparse takes as long as expanding a small file

    module = verb(name)
    prog = f"{program} {name}".strip()
    parser = make_parser(prog, VERBS[name], module.configure)
    if parser.usage is not None:
        parser.usage = parser.usage.replace(f"{PROGRAM} {name}", prog, 1)
    return parser


def _dispatch(words: list[str], program: str) -> int:
    if not words or words[0] in ("-h", "--help", "help"):
        print(_overview())
        return FINE if words else USAGE
    name = OTHER_NAMES.get(words[0], words[0])
    if name in ("-V", "--version"):
        print(f"linkwright {__version__}")
        return FINE
    if name not in VERBS:
        return _unknown(name, _OPTIONS if name.startswith("-") else VERBS, program or PROGRAM)
    module = verb(name)
    arguments = _without_options(module, words[1:]) or _parsed(name, module, words, program)
    if isinstance(arguments, int):
        return arguments
    if name not in _WITH_A_LOOP:
        raise_interrupts()
    return module.run(arguments)


def _without_options(module: Verb, words: list[str]) -> argparse.Namespace | None:
    """Return the arguments of a command line without options, if the command can read them without a parser."""
    known: Callable[[list[str]], argparse.Namespace | None] | None = getattr(module, "without_options", None)
    return None if known is None or any(word.startswith("-") for word in words) else known(words)


def _parsed(name: str, module: Verb, words: list[str], program: str) -> argparse.Namespace | int:
    """Return the parsed arguments of a command line, or the exit status for an unknown subcommand."""
    parser = parser_for(name, program=program)
    below: Mapping[str, SubVerb] = getattr(module, "VERBS", {})
    if below:
        asked = next(iter(words[1:]), "-")
        if not asked.startswith("-") and asked not in below:
            return _unknown(asked, below, parser.prog)
    mixed = not below and name not in _IN_ORDER and any(word.startswith("-") for word in words)
    parse = parser.parse_intermixed_args if mixed else parser.parse_args
    return parse(words[1:])


def _unknown(name: str, known: Iterable[str], prog: str) -> int:
    """Report an unknown command or option."""
    hint = did_you_mean(name, known) or f"`{prog} --help` lists the commands"
    what = "option" if name.startswith("-") else "command"
    print(f"{prog}: there is no {what} '{name}'; {hint}", file=sys.stderr)
    return USAGE


def _overview() -> str:
    width = max(map(len, VERBS))
    lines = ["usage: linkwright COMMAND ...", "", said_in_help(SUMMARY_HELP)]
    for title, verbs in GROUPS.items():
        lines += ["", f"{said_in_help(title)}:"]
        lines += [f"  {name:{width}}  {said_in_help(text)}" for name, text in verbs.items()]
    lines += ["", f"{said_in_help('options of all commands')}:", f"  --lang LANGUAGE  {said_in_help(LANGUAGE_HELP)}"]
    lines += ["", said_in_help(MORE_HELP)]
    return "\n".join(lines)
