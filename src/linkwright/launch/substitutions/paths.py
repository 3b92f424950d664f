"""Substitutions that give paths and what is in files."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path

from linkwright.diagnostics import did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

IN_PROCESS_PROGRAMS = frozenset({"xacro"})
"""Programs that `Command` runs inside this process, so that they need not be installed."""


class PathJoinSubstitution(Substitution):
    """Parts of a path, joined with the separator of the system.

    Also written with the ``/`` operator: ``PathJoinSubstitution(["a"]) / "b"``.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        if isinstance(substitutions, (str, Substitution)):
            substitutions = [substitutions]
        self._parts = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts."""
        return self._parts

    def describe(self) -> str:
        """The parts."""
        return f"PathJoin({', '.join(describe(part) for part in self._parts)})"

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self._parts, other])

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return os.path.join(*(perform_substitutions(context, part) for part in self._parts))  # noqa: PTH118


class FindExecutable(Substitution):
    """The path of a program on ``PATH``.

    A program that `Command` runs inside this process is found even where it is not installed: then its bare
    name is given.
    """

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def describe(self) -> str:
        """The name."""
        return f"FindExec({describe(self._name)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            LinkwrightError: LAUNCH124, if there is no such program.
        """
        name = perform_substitutions(context, self._name)
        path = shutil.which(name, path=context.environment.get("PATH"))
        if path is not None:
            return path
        if name in IN_PROCESS_PROGRAMS:
            return name
        hint = did_you_mean(name, IN_PROCESS_PROGRAMS) or "install it, or add its folder to PATH"
        raise error_at(self.place, "LAUNCH124", f"executable '{name}' is not on PATH", hint)


class FileContent(Substitution):
    """What is in a text file."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self._path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The path, as substitutions."""
        return self._path

    def describe(self) -> str:
        """The path."""
        return f"FileContent({describe(self._path)})"

    def perform(self, context: LaunchContext) -> str:
        """The text.

        Raises:
            LinkwrightError: LAUNCH125, if the file cannot be read.
        """
        path = perform_substitutions(context, self._path)
        try:
            return Path(path).read_text(encoding="utf-8")
        except FileNotFoundError as error:
            raise error_at(self.place, "LAUNCH125", f"file '{path}' does not exist") from error
        except (OSError, UnicodeDecodeError) as error:
            raise error_at(self.place, "LAUNCH125", f"file '{path}' cannot be read: {error}") from error
