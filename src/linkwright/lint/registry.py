"""All rules there are: every module of `linkwright.lint.rules` is looked at."""

from __future__ import annotations

import re
from functools import cache
from importlib import import_module
from inspect import isclass
from pkgutil import iter_modules

from linkwright.lint import rules
from linkwright.lint.rule import Rule

_CODE = re.compile("LW[0-9]{3}").fullmatch
_NAME = re.compile("[a-z0-9]+(-[a-z0-9]+)*").fullmatch


@cache
def all_rules() -> tuple[Rule, ...]:
    """One of each rule, in the order of their codes.

    Raises:
        ValueError: two rules share a code or name, or one is malformed; a mistake of the program.
    """
    found: dict[str, Rule] = {}
    names: set[str] = set()
    for module in sorted(entry.name for entry in iter_modules(rules.__path__)):
        full_name = f"{rules.__name__}.{module}"
        for thing in vars(import_module(full_name)).values():
            if not (isclass(thing) and issubclass(thing, Rule) and thing.__module__ == full_name):
                continue
            if thing.__name__.startswith("_") or "code" not in vars(thing):
                continue  # a base of rules
            rule = thing()
            if not _CODE(rule.code) or not _NAME(rule.name):
                raise ValueError(f"malformed code or name: {thing.__qualname__}")
            if rule.code in found or rule.name in names:
                raise ValueError(f"'{rule.code}' or '{rule.name}' is taken: {thing.__qualname__}")
            found[rule.code] = rule
            names.add(rule.name)
    return tuple(found[code] for code in sorted(found))


def find_rule(code_or_name: str) -> Rule | None:
    """The rule of a code or name, in any case; None where there is none."""
    return _index().get(code_or_name.strip().casefold())


@cache
def _index() -> dict[str, Rule]:
    return {key: rule for rule in all_rules() for key in (rule.code.casefold(), rule.name)}
