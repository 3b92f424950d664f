"""Parser for the arguments of xacro in launch files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase, quoted_names
from linkwright.hosting.xacro_calls import XacroCall

_OPTIONS_WITHOUT_EFFECT = frozenset({"--inorder", "-i", "-q"})
_OPTIONS_WITH_VALUE = frozenset({"-v", "--verbosity"})


def parse_xacro_arguments(words: Sequence[str], text: str, folder: Path) -> tuple[XacroCall, Phrase | None]:
    """Parse the arguments of ``xacro``.

    Args:
        words: the arguments of ``xacro``.
        text: the arguments as one text, before they were split.
        folder: the folder for relative paths.

    Returns:
        The model file with its arguments, and a warning for the user or None.

    Raises:
        LinkwrightError: LAUNCH128, the arguments do not name exactly one model file, or an option is not supported.
    """
    files: list[str] = []
    arguments: dict[str, str] = {}
    remaining_arguments = iter(words)
    for argument in remaining_arguments:
        name, separator, value = argument.partition(":=")
        if separator:
            if file_without_space := _FILE_WITHOUT_SPACE.match(name):
                raise _usage_error(
                    phrase(
                        "a space is missing between the file and the argument '{name}' of xacro",
                        name=file_without_space[2],
                    ),
                    phrase("write a space before '{name}:='", name=file_without_space[2]),
                )
            if value and not name.startswith("_"):
                arguments[name] = value
        elif argument in _OPTIONS_WITH_VALUE:
            next(remaining_arguments, None)
        elif argument.startswith("-") and len(argument) > 1:
            if argument not in _OPTIONS_WITHOUT_EFFECT and not argument.startswith(("-v", "--verbosity=")):
                raise _usage_error(
                    phrase("option '{option}' of xacro is not supported in a launch file", option=argument),
                    phrase("remove the option"),
                )
        else:
            files.append(argument)
    warning = None
    if len(files) > 1:
        joined_path = text.split(":=", 1)[0].rsplit(None, 1)[0] if ":=" in text else text
        if not (folder / joined_path.strip()).is_file():
            raise _usage_error(
                phrase(
                    "xacro expects exactly one model file, but was given {count}: {files}",
                    count=len(files),
                    files=quoted_names(files),
                ),
                _SUBSTITUTION_HINT
                if text.lstrip().startswith("<launch.")
                else phrase("put quotes around a path with spaces: Command(['xacro \"', path, '\"'])"),
            )
        files = [joined_path.strip()]
        warning = phrase(
            "the path '{files}' contains spaces but is not quoted, so xacro itself would read it as several files",
            files=files[0],
        )
    if not files:
        raise _usage_error(phrase("the xacro command has no model file"), phrase("write Command(['xacro ', path])"))
    return XacroCall(folder / files[0], tuple(arguments.items())), warning


_FILE_WITHOUT_SPACE = re.compile(r"(.*\.(?:xacro|urdf))(\w+)$")
_SUBSTITUTION_HINT = phrase(
    "the text of a substitution is known only when the launch runs; pass it as it is, without str() or an f-string: "
    "Command(['xacro ', model])"
)


def _usage_error(message: Phrase, hint: Phrase) -> LinkwrightError:
    return LinkwrightError(Diagnostic("LAUNCH128", message, hint=hint))
