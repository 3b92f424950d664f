"""Questions about a description that its expansion alone does not answer: its arguments, and the story of its parts.

What answers them is imported when somebody asks.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.xacro.engine import Inputs
from linkwright.xacro.limits import Limits
from linkwright.xacro.session import PackageSource

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.xacro.arguments import Argument
    from linkwright.xacro.story import Story


def arguments_of(
    path: str | Path,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: PackageSource = None,
    text: str | None = None,
    limits: Limits | None = None,
    root_dir: str | Path | None = None,
) -> tuple[Argument, ...]:
    """The arguments that a file and those that it includes take, in the order in which they are met.

    The file need not be one that can be expanded without arguments.

    Args:
        path: the file; for this and the rest see `linkwright.xacro.expand`.
        arguments: name -> value of arguments that may decide which files are included.
        packages: where ``$(find name)`` looks.
        text: the text to take for that of the file.
        limits: bounds for the expansion.
        root_dir: the folder that relative paths are in.

    Raises:
        LinkwrightError: the file cannot be read or is not XML.
    """
    from linkwright.xacro.arguments import examine_arguments

    inputs = Inputs(str(path), arguments or {}, packages, text, limits or Limits(), str(root_dir or ""))
    return examine_arguments(inputs).arguments


def explain(
    path: str | Path,
    name: str,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: PackageSource = None,
    text: str | None = None,
    limits: Limits | None = None,
    root_dir: str | Path | None = None,
) -> tuple[Story, ...]:
    """The stories of the elements of an expansion that have a name: links, joints, or any other.

    Args:
        path: the file; for this and the rest see `linkwright.xacro.expand`.
        name: the value of the attribute ``name``.
        arguments: name -> value of the arguments.
        packages: where ``$(find name)`` looks.
        text: the text to take for that of the file.
        limits: bounds for the expansion.
        root_dir: the folder that relative paths are in.

    Returns:
        At least one story: those of elements directly inside the root or, when there are none, of those deeper down.

    Raises:
        LinkwrightError: what is wrong with the file, or XAC801 when no element has the name.
    """
    from linkwright.xacro.story import stories

    return stories(Inputs(str(path), arguments or {}, packages, text, limits or Limits(), str(root_dir or "")), name)
