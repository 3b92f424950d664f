"""All rules there are, found through the entry points ``linkwright.lint_rules``.

An entry point names a module, or a package whose modules are all looked at; their classes with a code are the rules.
Those of other packages come the same way as ours; their codes have a prefix of their own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Severity, foreign, phrase
from linkwright.extensions import EntryPoint, extensions
from linkwright.lint.rule import Rule

if TYPE_CHECKING:
    from types import ModuleType

GROUP = "linkwright.lint_rules"
"""Of the entry points."""

_OURS = "LW"
_CODE = re.compile("[A-Z]{2,10}[0-9]{3}").fullmatch
_NAME = re.compile("[a-z0-9]+(-[a-z0-9]+)*").fullmatch


def all_rules() -> tuple[Rule, ...]:
    """One of each rule, in the order of their codes."""
    return _found()[0]


def unusable_rules() -> tuple[Diagnostic, ...]:
    """A warning (LINT301) for each entry point of another package whose rules cannot be used."""
    return _found()[1]


def find_rule(code_or_name: str) -> Rule | None:
    """The rule of a code or name, in any case; None where there is none."""
    return _index().get(code_or_name.strip().casefold())


@cache
def _index() -> Mapping[str, Rule]:
    return {key: rule for rule in all_rules() for key in (rule.code.casefold(), rule.name)}


@cache
def _found() -> tuple[tuple[Rule, ...], tuple[Diagnostic, ...]]:
    rules: dict[str, Rule] = {}
    problems: list[Diagnostic] = []
    for entry in extensions(GROUP).values():
        found = _rules_of(entry, {*rules, *(rule.name for rule in rules.values())})
        if isinstance(found, Diagnostic):
            problems.append(found)
        else:
            rules.update((rule.code, rule) for rule in found)
    return tuple(rules[code] for code in sorted(rules)), tuple(problems)


def _rules_of(entry: EntryPoint, taken: set[str]) -> list[Rule] | Diagnostic:
    """The rules that an entry point brings, or why those of another package cannot be used."""
    if entry.value.startswith("linkwright."):
        return _load(entry, taken, is_ours=True)
    try:
        return _load(entry, taken, is_ours=False)
    except Exception as error:  # noqa: BLE001  # of a package that is not ours anything may be wrong
        return _unusable(entry, error)


def _load(entry: EntryPoint, taken: set[str], *, is_ours: bool) -> list[Rule]:
    """The rules that an entry point brings.

    Raises:
        ValueError: a code or name is taken or malformed.
    """
    found = [rule() for module in _modules(entry.load()) for rule in _classes(module)]
    for rule in found:
        if not _CODE(rule.code) or not _NAME(rule.name) or rule.code.startswith(_OURS) != is_ours:
            raise ValueError(f"malformed code or name: {rule.code}, {rule.name}")
        if rule.code in taken or rule.name in taken:
            raise ValueError(f"'{rule.code}' or '{rule.name}' is taken")
        taken |= {rule.code, rule.name}
    return found


def _modules(module: ModuleType) -> Iterator[ModuleType]:
    yield module
    for folder in getattr(module, "__path__", ()):
        for name in sorted(_module_names(folder, is_ours=module.__name__.startswith("linkwright."))):
            yield import_module(f"{module.__name__}.{name}")


def _module_names(folder: str, *, is_ours: bool) -> Iterator[str]:
    if is_ours:  # a folder of the file system, whose modules are all files
        yield from (file.stem for file in Path(folder).glob("*.py") if file.stem != "__init__")
        return
    from pkgutil import iter_modules  # here: its import takes as long as that of all our rules about joints

    yield from (entry.name for entry in iter_modules([folder]))


def _classes(module: ModuleType) -> Iterator[type[Rule]]:
    for thing in vars(module).values():
        is_own = isinstance(thing, type) and issubclass(thing, Rule) and thing.__module__ == module.__name__
        if is_own and not thing.__name__.startswith("_") and "code" in vars(thing):  # others are bases of rules
            yield thing


def _unusable(entry: EntryPoint, error: Exception) -> Diagnostic:
    message = phrase(
        "the rules of '{module}' cannot be used: {reason}",
        module=entry.value,
        reason=foreign(f"{type(error).__name__}: {error}"),
    )
    hint = phrase("mend or uninstall the package that brings them")
    return Diagnostic("LINT301", message, severity=Severity.WARNING, hint=hint)
