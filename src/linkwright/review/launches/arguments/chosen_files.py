"""Find the files of a package that an include can choose by the value of one argument."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.review.launches.programs.missing import find_packages
from linkwright.review.versions import Version

_FILE = re.compile(r"\$\(find (?P<package>[\w.-]+)\)/(?P<path>.+)")
_ARGUMENT = re.compile(r"\$\(arg ([\w./-]+)\)")
_ARGUMENT_AS_NAME = re.compile(r"\$\(arg [\w./-]+\)\.(?:launch|xml)|\$\(arg [\w./-]+\)\.launch\.xml")
"""The name of a file that only an argument gives. It may match every file of a folder."""


def find_chosen_files(version: Version, name: str) -> dict[str, str]:
    """Return the files that an include of ROS 1 can choose, by the word that sets its argument, such as ``robot:=arm``.

    The name of each file has to have another part that the include writes, or the value twice.

    Args:
        version: the version of the repository.
        name: the included file as written, such as ``$(find arm)/launch/$(arg robot)_robot.launch``.
    """
    match = _FILE.fullmatch(name)
    package = None if match is None else find_packages(version).get(match["package"])
    parts = [] if match is None else _ARGUMENT.split(match["path"])
    arguments = parts[1::2]
    if match is None or package is None or len(set(arguments)) != 1 or "$" in "".join(parts[::2]):
        return {}
    if len(arguments) == 1 and _ARGUMENT_AS_NAME.fullmatch(PurePosixPath(match["path"]).name):
        return {}
    texts = [re.escape(text) for text in parts[::2]]
    values = ["(?P<value>[^/]+)", *["(?P=value)"] * (len(arguments) - 1), ""]
    pattern = re.compile("".join(text + value for text, value in zip(texts, values, strict=True)))
    folder = PurePosixPath(package.folder)
    found: dict[str, str] = {}
    for path in version.paths((PurePosixPath(name).suffix,), package.folder):
        chosen = pattern.fullmatch(PurePosixPath(path).relative_to(folder).as_posix())
        if chosen is not None:
            found[f"{arguments[0]}:={chosen['value']}"] = path
    return found
