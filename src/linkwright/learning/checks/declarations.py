"""Declare the checks of a lesson, and load them from its file."""

from __future__ import annotations

import importlib.util
import linecache
import sys
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from linkwright.diagnostics import foreign, phrase
from linkwright.learning.errors import file_error, unreadable_file_error
from linkwright.learning.local_text import LocalText

if TYPE_CHECKING:
    from types import ModuleType

    from linkwright.learning.checks.work import Work

F = TypeVar("F", bound="Callable[[Work], object]")

_ATTRIBUTE = "__linkwright_checks__"


@dataclass(frozen=True)
class Check:
    """A check of a step.

    Attributes:
        step: the name of the step.
        title: what the check expects, one sentence in each language.
        function: called with the learner's `Work`; raises `NotYet` if the check is not satisfied.
    """

    step: str
    title: LocalText
    function: Callable[[Work], object]


def check(step: str, **title: str) -> Callable[[F], F]:
    """Declare a function as a check of a step.

    The checks of a step run in the order of the file. One that fails does not keep the others from running.

    Example::

        @check("first-link", en="The robot has the link base_link.", zh="机器人有名为 base_link 的 link。")
        def has_base_link(work):
            work.package("my_robot_description").robot("urdf/mbot_base.urdf").link("base_link")

    Args:
        step: the name of the step, as in ``## The first link {#first-link}``.
        title: what the check expects, one sentence by language.

    Raises:
        ValueError: there is no title, or its language is unknown.
    """
    declared = LocalText(title)

    def declare(function: F) -> F:
        checks = [*getattr(function, _ATTRIBUTE, ()), Check(step, declared, function)]
        setattr(function, _ATTRIBUTE, checks)
        return function

    return declare


def load_checks(path: Path) -> Mapping[str, tuple[Check, ...]]:
    """Load the checks of a lesson by running its file as a module.

    The module can import other modules from its folder.

    Returns:
        The checks by step, in the order of the file.

    Raises:
        LinkwrightError: LEARN102, the file cannot be read; LEARN107, it cannot be run.
    """
    checks: dict[str, list[Check]] = {}
    for value in vars(load_module(path)).values():
        for declared in getattr(value, _ATTRIBUTE, ()) if callable(value) else ():
            checks.setdefault(declared.step, []).append(declared)
    return {step: tuple(found) for step, found in checks.items()}


def load_module(path: Path) -> ModuleType:
    """Run a Python file of a lesson as a module.

    Raises:
        LinkwrightError: LEARN102, the file cannot be read; LEARN107, it cannot be run.
    """
    try:
        source = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable_file_error(path, error) from None
    spec = importlib.util.spec_from_loader(f"linkwright_lesson_{path.stem}", None, origin=str(path))
    assert spec is not None, "a specification needs no loader"
    module = importlib.util.module_from_spec(spec)
    module.__file__ = str(path)
    linecache.cache.pop(str(path), None)
    sys.path.insert(0, str(path.parent))
    try:
        exec(compile(source, str(path), "exec"), module.__dict__)  # noqa: S102 - the lesson's own file
    except Exception as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        line = error.lineno if isinstance(error, SyntaxError) else (lines or [1])[-1]
        message = phrase("the file cannot be run: {error}", error=foreign(f"{type(error).__name__}: {error}"))
        raise file_error("LEARN107", path, message, line=line or 1) from error
    finally:
        sys.path.remove(str(path.parent))
    return module
