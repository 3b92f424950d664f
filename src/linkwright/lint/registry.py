"""All lint rules, found through the entry points ``linkwright.lint_rules``.

An entry point names a module, or a package whose modules are all searched. The rules are the classes with a code.
Rules of other packages are found in the same way, and their codes have a different prefix.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity, Span, foreign, phrase
from linkwright.lint.rule import Rule, Scope
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.extensions import EntryPoint, extensions
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import ModuleType

GROUP = "linkwright.lint_rules"
"""The group of the entry points."""

_OWN_PREFIX = "LW"
_PACKAGE_MODULE_PREFIXES = ("launch_", "package_")
"""The name prefixes of Linkwright's modules with rules about packages. The check of a file does not need them."""
_CODE = lazy_pattern("[A-Z]{2,10}[0-9]{3}")
_NAME = lazy_pattern("[a-z0-9]+(-[a-z0-9]+)*")


def all_rules() -> tuple[Rule, ...]:
    """Return an instance of each rule, in the order of the codes."""
    return _all_rules(include_packages=True)[0]


def rules_of(scopes: Collection[Scope]) -> tuple[Rule, ...]:
    """Return the rules of some scopes in the order of their codes.

    The modules of package rules are imported only if the scopes include packages.
    """
    return tuple(rule for rule in _all_rules(include_packages=Scope.PACKAGE in scopes)[0] if rule.scope in scopes)


def find_unusable_rules() -> tuple[Diagnostic, ...]:
    """Return a warning (LINT301) for each external entry point whose rules cannot be used."""
    return _all_rules(include_packages=False)[1]


def has_external_rules() -> bool:
    """Return whether another package adds rules.

    Findings must then not be cached, because external rules may depend on anything.
    """
    return any(is_external(rule) for rule in _all_rules(include_packages=False)[0])


def is_external(rule: Rule) -> bool:
    """Return whether a rule belongs to another package."""
    return not rule.code.startswith(_OWN_PREFIX)


def make_failed_rule_finding(rule: Rule, error: Exception) -> Diagnostic:
    """Return the error (LINT304) about a rule of another package that raised an exception."""
    reason = foreign(f"{type(error).__name__}: {error}")
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None and trace.tb_frame.f_globals["__name__"] != rule.__module__:
        trace = trace.tb_next
    message = phrase(
        "rule {code} of the module '{module}' failed: {reason}", code=rule.code, module=rule.__module__, reason=reason
    )
    if trace is None:
        return Diagnostic("LINT304", message)
    line = trace.tb_lineno
    return Diagnostic("LINT304", message, Span(trace.tb_frame.f_code.co_filename, line, 1, line, 2))


def find_rule(code_or_name: str) -> Rule | None:
    """Return the rule with a code or name, ignoring case, or None if there is none."""
    key = code_or_name.strip().casefold()
    rule = _index_rules(include_packages=False).get(key)
    if rule is None and (key.startswith(_OWN_PREFIX.casefold()) or not _CODE.fullmatch(key.upper())):
        return _index_rules(include_packages=True).get(key)
    return rule


@cache
def _index_rules(*, include_packages: bool) -> Mapping[str, Rule]:
    return {
        key: rule
        for rule in _all_rules(include_packages=include_packages)[0]
        for key in (rule.code.casefold(), rule.name)
    }


@cache
def _all_rules(*, include_packages: bool) -> tuple[tuple[Rule, ...], tuple[Diagnostic, ...]]:
    """Return the rules, sorted by code, and the findings about rules that cannot be used.

    Linkwright's rules about packages are left out unless `include_packages` is true, or another package adds rules. The
    names of the added rules must differ from those of Linkwright's rules.
    """
    rules: dict[str, Rule] = {}
    problems: list[Diagnostic] = []
    entries = extensions(GROUP).values()
    include_packages = include_packages or not all(map(_is_ours, entries))
    for entry in entries:
        entry_rules = _load_rules_of(
            entry, {*rules, *(rule.name for rule in rules.values())}, include_packages=include_packages
        )
        if isinstance(entry_rules, Diagnostic):
            problems.append(entry_rules)
        else:
            rules.update((rule.code, rule) for rule in entry_rules)
    return tuple(rules[code] for code in sorted(rules)), tuple(problems)


def _is_ours(entry: EntryPoint) -> bool:
    return entry.value.startswith("linkwright.")


def _load_rules_of(entry: EntryPoint, used_names: set[str], *, include_packages: bool) -> list[Rule] | Diagnostic:
    """Return the rules of an entry point, or a diagnostic if they cannot be used.

    An exception in Linkwright's own rules is not caught.
    """
    if _is_ours(entry):
        return _load_rules(entry, used_names, is_ours=True, include_packages=include_packages)
    try:
        return _load_rules(entry, used_names, is_ours=False, include_packages=True)
    except Exception as error:  # noqa: BLE001  # code of another package may raise any exception
        return _make_unusable_finding(entry, error)


def _load_rules(entry: EntryPoint, used_names: set[str], *, is_ours: bool, include_packages: bool) -> list[Rule]:
    """Return the rules of an entry point, and add their codes and names to `used_names`.

    Raises:
        ValueError: If a code or name is taken or malformed.
    """
    rules = [
        _make_instance(rule)
        for module in _import_modules(entry.load(), is_ours, include_packages)
        for rule in _list_rule_classes(module)
    ]
    for rule in rules:
        if (
            not _CODE.fullmatch(rule.code)
            or not _NAME.fullmatch(rule.name)
            or rule.code.startswith(_OWN_PREFIX) != is_ours
        ):
            raise ValueError(f"malformed code or name: {rule.code}, {rule.name}")
        if rule.code in used_names or rule.name in used_names:
            raise ValueError(f"'{rule.code}' or '{rule.name}' is taken")
        used_names |= {rule.code, rule.name}
    return rules


_INSTANCES: dict[object, Rule] = {}
"""The instance of each rule class."""


def _make_instance(kind: type[Rule]) -> Rule:
    return _INSTANCES.get(kind) or _INSTANCES.setdefault(kind, kind())


def _import_modules(module: ModuleType, is_ours: bool, include_packages: bool) -> Iterator[ModuleType]:
    yield module
    for folder in getattr(module, "__path__", ()):
        for name in sorted(_list_module_names(folder, is_ours=is_ours)):
            if include_packages or not name.startswith(_PACKAGE_MODULE_PREFIXES):
                yield import_module(f"{module.__name__}.{name}")


def _list_module_names(folder: str, *, is_ours: bool) -> Iterator[str]:
    if is_ours:  # our folder is in the file system and contains a file for each module
        yield from (file.stem for file in Path(folder).glob("*.py") if file.stem != "__init__")
        return
    from pkgutil import iter_modules  # imported here because the import is slow

    yield from (entry.name for entry in iter_modules([folder]))


def _list_rule_classes(module: ModuleType) -> Iterator[type[Rule]]:
    for value in vars(module).values():
        is_own = isinstance(value, type) and issubclass(value, Rule) and value.__module__ == module.__name__
        if is_own and not value.__name__.startswith("_") and "code" in vars(value):  # other classes are base classes
            yield value


def _make_unusable_finding(entry: EntryPoint, error: Exception) -> Diagnostic:
    message = phrase(
        "the rules of '{module}' cannot be used: {reason}",
        module=entry.value,
        reason=foreign(f"{type(error).__name__}: {error}"),
    )
    hint = phrase("fix or uninstall the package that provides them")
    return Diagnostic("LINT301", message, severity=Severity.WARNING, hint=hint)
