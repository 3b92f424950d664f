"""Parser for the arguments of ``rviz2`` that Linkwright's viewer supports."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase

if TYPE_CHECKING:
    from linkwright.rviz import RvizConfig

_CONFIG_OPTIONS = ("-d", "--display-config")
_FIXED_FRAME_OPTIONS = ("-f", "--fixed-frame")
_IGNORED_OPTIONS = {
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
    """Return whether the command line asks for the help text `USAGE`."""
    own_arguments = list(arguments)
    if "--ros-args" in own_arguments:
        own_arguments = own_arguments[: own_arguments.index("--ros-args")]
    return "-h" in own_arguments or "--help" in own_arguments


def read_viewer_config(arguments: Sequence[str]) -> tuple[RvizConfig, list[Diagnostic]]:
    """Return the configuration that command-line arguments select, and findings about them.

    As in RViz, an unreadable file is reported, and the default configuration is used.
    """
    from linkwright.rviz import RvizConfig

    path, fixed_frame, findings = _parse_arguments(arguments)
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


def _parse_arguments(arguments: Sequence[str]) -> tuple[str | None, str | None, list[Diagnostic]]:
    path: str | None = None
    fixed_frame: str | None = None
    findings: list[Diagnostic] = []
    remaining_arguments = iter(_split_values(arguments))
    for argument in remaining_arguments:
        if argument == "--ros-args":
            for option in remaining_arguments:  # ROS arguments have no effect on the configuration
                if option == "--":
                    break
        elif argument in _CONFIG_OPTIONS or argument in _FIXED_FRAME_OPTIONS:
            value = next(remaining_arguments, None)
            if value is None:
                findings.append(
                    _argument_warning(phrase("argument '{argument}' of rviz2 needs a value", argument=argument))
                )
            elif argument in _CONFIG_OPTIONS:
                path = value
            else:
                fixed_frame = value
        elif argument in _IGNORED_OPTIONS:
            for _ in range(_IGNORED_OPTIONS[argument]):
                next(remaining_arguments, None)
        elif argument:
            known_options = (*_CONFIG_OPTIONS, *_FIXED_FRAME_OPTIONS, *_IGNORED_OPTIONS)
            findings.append(
                _argument_warning(
                    phrase("rviz2 has no argument '{argument}'", argument=argument),
                    did_you_mean(argument, known_options),
                )
            )
    return path, fixed_frame, findings


def _split_values(arguments: Sequence[str]) -> Iterator[str]:
    """Yield the arguments, with ``-dVALUE`` and ``--display-config=VALUE`` split as Qt does."""
    for argument in arguments:
        for option in (*_CONFIG_OPTIONS, *_FIXED_FRAME_OPTIONS):
            prefix = f"{option}=" if option.startswith("--") else option
            if argument.startswith(prefix) and len(argument) > len(prefix):
                yield option
                yield argument[len(prefix) :]
                break
        else:
            yield argument


def _argument_warning(message: Phrase, hint: Phrase | None = None) -> Diagnostic:
    return Diagnostic("LAUNCH144", message, hint=hint).with_changes(severity=Severity.WARNING)
