"""The command ``ros2``, which runs Linkwright's commands as its subcommands."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from linkwright.cli.command import collect_help_texts
from linkwright.cli.command import main as linkwright
from linkwright.cli.exit_status import FINE, USAGE
from linkwright.cli.workbench import OTHER_NAMES
from linkwright.diagnostics import did_you_mean

COMMANDS = (
    "action",
    "bag",
    "component",
    "control",
    "daemon",
    "doctor",
    "interface",
    "launch",
    "lifecycle",
    "multicast",
    "node",
    "param",
    "pkg",
    "run",
    "service",
    "test",
    "topic",
    "wtf",
)
"""The supported commands of ``ros2``, in its order."""

_UNSUPPORTED = {
    "extension_points": "it lists plugins of ros2cli",
    "extensions": "it lists plugins of ros2cli",
    "security": "it generates the keys of SROS 2",
}


def ros2(words: Sequence[str]) -> int:
    """Run a subcommand of ``ros2``, and return its exit status."""
    arguments = [word for word in words if word != "--use-python-default-buffering"]
    if not arguments or arguments[0] in ("-h", "--help"):
        print(_format_overview())
        return FINE
    name = arguments[0]
    if name in COMMANDS:
        return linkwright([name, *arguments[1:]], program="ros2")
    if name in _UNSUPPORTED:
        problem = f"'{name}' needs a real ROS 2: {_UNSUPPORTED[name]}"
    else:
        hint = did_you_mean(name, COMMANDS) or "`ros2 --help` lists the commands"
        problem = f"there is no command '{name}'; {hint}"
    print(f"ros2: {problem}", file=sys.stderr)
    return USAGE


def _format_overview() -> str:
    width = max(map(len, COMMANDS))
    lines = [
        "usage: ros2 [-h] COMMAND ...",
        "",
        "The commands of ROS 2, by Linkwright: no ROS 2 is installed here.",
        "",
        "Commands:",
    ]
    for name in COMMANDS:
        alias_target = OTHER_NAMES.get(name)
        lines.append(
            f"  {name:{width}}  {f'the same as {alias_target}' if alias_target else collect_help_texts()[name]}"
        )
    lines += ["", "`ros2 COMMAND -h` describes a command."]
    return "\n".join(lines)
