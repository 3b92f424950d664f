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
from linkwright.interruption import end_at_once, raise_interrupts
from linkwright.lean_typing import TYPE_CHECKING, Protocol, cast

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
        "inertia": "compare masses and inertias with the shapes, compute them, or write them",
        "diagram": "draw links and joints as urdf_to_graphviz does (.gv and PDF or SVG)",
        "export": "write a robot as one HTML file for any browser, or as glTF (.glb)",
        "convert": "convert a robot or world to SDF, to URDF, or to MJCF for MuJoCo",
    },
    "packages and launch files": {
        "launch": "run a ROS 2 launch file; rviz2 opens as a page in the browser",
        "run": "run an executable of a package, built or from its sources",
        "pkg": "create ROS packages, find them, and list their contents",
        "test": "run the launch_testing tests of a file",
        "shell": "open a shell with ros2, launch_test, xacro, check_urdf, urdf_to_graphviz, rviz2 and colcon",
    },
    "simulation": {
        "drive": "drive a robot in a simulated world; missing masses, collisions and wheels are inferred",
        "sim": "simulate a world, with or without a robot, in the browser or headless",
        "world": "list worlds and models, create a world, or check one",
        "spawn": "add a robot or model to a running simulation",
        "sweep": "run a scenario over parameters and seeds in parallel, and tabulate the results",
        "dataset": "render labelled images of a world in COCO and YOLO form, to train a detector",
    },
    "vision and voice": {
        "vision": "detect objects in images; train and evaluate detectors",
        "voice": "try speech engines on recordings, and enrol words",
        "models": "download, verify and remove models for speech and vision",
    },
    "the running graph, as in ros2": {
        "topic": "list, print, publish and measure topics",
        "node": "list and describe nodes",
        "param": "list, read and set parameters of nodes",
        "service": "list and call services",
        "action": "list actions and send goals",
        "interface": "list and show types of messages, services and actions",
        "lifecycle": "show and change the states of managed nodes",
        "component": "load, list and unload components in containers",
        "control": "show and change the controllers and hardware of ros2_control",
        "bag": "record topics, play recordings, and describe them",
        "bridge": "carry topics and services between DDS and Zenoh",
        "doctor": "explain what is wrong with the running nodes, topics and frames",
        "multicast": "send or receive a datagram, to test multicast on the network",
        "daemon": "accepted for compatibility with ros2; Linkwright has no daemon",
    },
    "this program": {
        "completion": "print the completion script for bash, zsh or fish",
    },
}
"""The verbs in the order in which the help lists them, with what it says of them.

Each is a module or package of this package, which is loaded only when it is asked for.
"""

VERBS = {name: text for verbs in GROUPS.values() for name, text in verbs.items()}
"""What the help says of each verb."""

OTHER_NAMES = {"wtf": "doctor"}
"""Second names of verbs, which ros2 has; the help does not list them."""

_IN_ORDER = frozenset({"pkg", "run", "shell"})
"""Verbs whose words are taken in order, beside those with verbs of their own: what follows is another command's.
Elsewhere options may stand between words (`launch PACKAGE --no-open FILE`)."""

_WITH_A_LOOP = frozenset({"view", "drive", "run", "sim", "spawn", "launch", *GROUPS["the running graph, as in ros2"]})
"""Verbs that run an event loop or another program, which care for Ctrl-C themselves; before they do there is nothing to
be cleaned up."""

PROGRAM = "linkwright"

SUMMARY_HELP = (
    "A ROS 2 workbench for a robot: "
    "describe it, check it, see it, simulate it, drive it and test it, without installing ROS."
)
"""What Linkwright is, in one sentence: the same in pyproject.toml, the READMEs and the documentation."""

MORE_HELP = "`linkwright COMMAND --help` describes a command. `linkwright --version` prints the version."

_OPTIONS = ("--help", "--lang", "--version")
"""Those that stand before a command, or for one."""

_COLLECT_AFTER = 50_000
"""After how many new objects Python looks for garbage; its own 700 would cost a short command a tenth of its time."""

_COLLECT_FIRST_AFTER = 200_000
"""The same for the first time: what a program imports before it begins is more, and nothing of it garbage."""


class Verb(Protocol):
    """The interface of a verb's module."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Declare the verb's arguments."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Do it; returns the exit status."""


def main(words: Sequence[str] | None = None, *, program: str = PROGRAM) -> int:
    """Run the command line and return its exit status; never raises.

    Args:
        words: the command line after the program's name; this process's when left out.
        program: the name that usage lines begin with, such as ``ros2``; empty where the verb is the program.
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
            gc.freeze()  # Python would look through everything once more before it ends


def _collect_seldom() -> None:
    def looked(phase: str, _: object) -> None:
        if phase == "stop":
            gc.set_threshold(_COLLECT_AFTER)

    gc.set_threshold(_COLLECT_FIRST_AFTER)
    gc.callbacks.append(looked)


def verb(name: str) -> Verb:
    """The module of a verb."""
    return cast("Verb", import_module(f"linkwright.cli.{name}"))


def parser_for(name: str, *, program: str = PROGRAM) -> argparse.ArgumentParser:
    """The argument parser of one verb, as the command reference and the verb itself use it."""
    from linkwright.cli.parsers import make_parser  # argparse takes as long as the expansion of a small file

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
    """The arguments that a command line without options gives, where the verb knows them without a parser."""
    known: Callable[[list[str]], argparse.Namespace | None] | None = getattr(module, "without_options", None)
    return None if known is None or any(word.startswith("-") for word in words) else known(words)


def _parsed(name: str, module: Verb, words: list[str], program: str) -> argparse.Namespace | int:
    """The arguments that a command line gives, or the exit status where it gives none."""
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
    """Say that a word is no command."""
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
