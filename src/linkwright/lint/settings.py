"""The settings of rules: the selection of rules, the severity of findings, and options."""

from __future__ import annotations

from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path

from linkwright.diagnostics import Severity
from linkwright.lint.option import OptionValue
from linkwright.lint.selectors import specificity
from linkwright.loading.lean_dataclasses import dataclass, field, replace
from linkwright.loading.lean_typing import Protocol
from linkwright.xmltree.style import Style


class SwitchableRule(Protocol):
    """The properties of a rule that decide, together with the settings, whether the rule runs."""

    @property
    def code(self) -> str:
        """The code of the rule's findings."""
        ...

    @property
    def default(self) -> bool:
        """Whether the rule is on by default."""
        ...


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a check.

    Selectors are codes, beginnings of codes, or ``ALL``. If several selectors match a code, the most specific one
    decides. Among equally specific selectors, an ignoring one takes precedence.

    Attributes:
        select: the selectors of findings to report; None means all rules that are on by default and all warnings of the
            reader.
        extend_select: the selectors of additional findings to report.
        ignore: the selectors of findings to ignore.
        severity: the severity of matching findings, by selector.
        per_file_ignores: pairs of a path pattern and the selectors to ignore in matching files.
        options: the values of options, by rule name and option name.
        arguments: pairs of a path pattern and the argument sets with which matching descriptions are checked.
        style: the style in which `linkwright format` writes files.
        folder: the base of path patterns, or None if there is no configuration file.
    """

    select: tuple[str, ...] | None = None
    extend_select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    severity: Mapping[str, Severity] = field(default_factory=dict)
    per_file_ignores: tuple[tuple[str, tuple[str, ...]], ...] = ()
    options: Mapping[str, Mapping[str, OptionValue]] = field(default_factory=dict)
    folder: Path | None = None
    arguments: tuple[tuple[str, tuple[Mapping[str, str], ...]], ...] = ()
    style: Style = Style()

    def runs(self, rule: SwitchableRule) -> bool:
        """Return whether the settings select a rule, so that it must run."""
        return self.selects(rule.code, default=rule.default)

    def selects(self, code: str, *, default: bool = True) -> bool:
        """Return whether findings with a code are reported.

        Args:
            code: the code of a finding.
            default: whether such findings are reported by default.
        """
        if self.select is None and not self.extend_select and not self.ignore:
            return default  # the usual case, which must be fast because every rule is tested
        selection_specificity = specificity(self.extend_select, code)
        if self.select is not None:
            selection_specificity = max(selection_specificity, specificity(self.select, code))
        elif default and not selection_specificity:
            selection_specificity = 1
        return selection_specificity > specificity(self.ignore, code)

    def is_ignored(self, code: str) -> bool:
        """Return whether a code is ignored.

        The selector that ignores the code must be at least as specific as the selector that selects the code.
        """
        selection_specificity = specificity((*(self.select or ()), *self.extend_select), code)
        return specificity(self.ignore, code) > 0 and specificity(self.ignore, code) >= selection_specificity

    def ignores(self, code: str, file: str) -> bool:
        """Return whether findings with a code are ignored in a file by ``per-file-ignores``."""
        if not self.per_file_ignores:
            return False
        return any(
            specificity(selectors, code)
            for pattern, selectors in self.per_file_ignores
            if self._matches_pattern(Path(file), pattern)
        )

    def arguments_of(self, file: Path) -> tuple[Mapping[str, str], ...]:
        """Return the configured argument sets of a description, or an empty tuple."""
        return tuple(
            values for pattern, sets in self.arguments if self._matches_pattern(file, pattern) for values in sets
        )

    def _matches_pattern(self, file: Path, pattern: str) -> bool:
        path = file.absolute()
        if self.folder is not None and path.is_relative_to(self.folder):
            path = path.relative_to(self.folder)
        return fnmatchcase(path.as_posix(), pattern) or fnmatchcase(path.name, pattern)

    def severity_of(self, code: str, default: Severity) -> Severity:
        """Return the configured severity of findings with a code, or `default` if there is none."""
        best_specificity, severity = 0, default
        for selector, configured_severity in self.severity.items():
            match_specificity = specificity([selector], code)
            if match_specificity > best_specificity:
                best_specificity, severity = match_specificity, configured_severity
        return severity

    def with_command_line(self, select: tuple[str, ...] | None, ignore: tuple[str, ...]) -> Settings:
        """Return the settings combined with the selectors of the command line.

        `select` replaces the selection and the ignored codes of the settings; `ignore` is added.
        """
        settings = replace(self, ignore=(*self.ignore, *ignore))
        if select is not None:
            settings = replace(settings, select=select, extend_select=(), ignore=ignore)
        return settings
