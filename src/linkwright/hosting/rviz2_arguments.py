"""The part of the command line of ``rviz2`` that the replacing viewer supports."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase

if TYPE_CHECKING:
    from linkwright.rviz import RvizConfig

_CONFIG = ("-d", "--display-config")
_FIXED_FRAME = ("-f", "--fixed-frame")
_WITHOUT_MEANING_HERE = {
    "-s": 1,
    "--splash-screen": 1,
    "-l": 0,
    "--ogre-log": 0,
    "--stereo": 0,
    "--fullscreen": 0,
    "--force-x11": 0,
}

USAGE = """\
usage: rviz2 [-d FILE] [-f FRAME] [--ros-args ...]

Shows what RViz would show, in the browser.

  -h, --help                   show this help and exit
  -d, --display-config FILE    the .rviz file to open
  -f, --fixed-frame FRAME      the Fixed Frame, instead of the file's
  --ros-args ...               names, remappings and parameters of the node

RViz's -s, -l, --stereo, --fullscreen and --force-x11 are accepted and ignored.
"""


def asks_for_help(arguments: Sequence[str]) -> bool:
    """Return whether the command line requests `USAGE`."""
    own = list(arguments)
    if "--ros-args" in own:
        own = own[: own.index("--ros-args")]
    return "-h" in own or "--help" in own


def read_viewer_config(arguments: Sequence[str]) -> tuple[RvizConfig, list[Diagnostic]]:
    """Return the configuration that the arguments select, and findings about them.

    As in RViz, a file that cannot be read is reported, and the default configuration is used instead.
    """
    from linkwright.rviz import RvizConfig

    path, fixed_frame, findings = _read(arguments)
    config: RvizConfig | None = None
    if path:
        try:
            config = RvizConfig.load(path)
        except LinkwrightError as error:
            findings += error.diagnostics
    if config is None:
        config = RvizConfig.default()
    if fixed_frame:
        config.options.set(("Fixed Frame",), fixed_frame)
    return config, findings


def _read(arguments: Sequence[str]) -> tuple[str | None, str | None, list[Diagnostic]]:
    path: str | None = None
    fixed_frame: str | None = None
    findings: list[Diagnostic] = []
    waiting = iter(arguments)
    for argument in waiting:
        if argument == "--ros-args":
            for option in waiting:  # ROS arguments do not affect the configuration
                if option == "--":
                    break
        elif argument in _CONFIG or argument in _FIXED_FRAME:
            value = next(waiting, None)
            if value is None:
                findings.append(
                    _argument_warning(phrase("argument '{argument}' of rviz2 needs a value", argument=argument))
                )
            elif argument in _CONFIG:
                path = value
            else:
                fixed_frame = value
        elif argument in _WITHOUT_MEANING_HERE:
            for _ in range(_WITHOUT_MEANING_HERE[argument]):
                next(waiting, None)
        elif argument:
            known = (*_CONFIG, *_FIXED_FRAME, *_WITHOUT_MEANING_HERE)
            findings.append(
                _argument_warning(
                    phrase("argument '{argument}' of rviz2 is unknown", argument=argument),
                    did_you_mean(argument, known),
                )
            )
    return path, fixed_frame, findings


def _argument_warning(message: Phrase, hint: Phrase | None = None) -> Diagnostic:
    return Diagnostic("LAUNCH144", message, hint=hint).with_changes(severity=Severity.WARNING)
