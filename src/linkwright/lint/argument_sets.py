"""Check a description with every set of values that its arguments receive, and report each finding once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.descriptions import examine as examine_description
from linkwright.descriptions.argument_sets import ArgumentSet, compared_values, empty_defaults
from linkwright.descriptions.service import TRUE_OF_PARTS
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    Severity,
    Span,
    counted,
    joined,
    phrase,
    quoted_names,
)
from linkwright.diagnostics.phrase import as_phrase
from linkwright.lint.engine import Checked, sorted_by_place, with_configured_severity
from linkwright.lint.registry import find_rule
from linkwright.lint.rules.inertia_doubtful import LEFT_TO_PLACEHOLDERS, placeholders
from linkwright.lint.settings import Settings
from linkwright.loading.lean_dataclasses import dataclass, field, replace
from linkwright.packages import PackageFinder
from linkwright.xmltree import Document

UNDECLARED = "XAC211"
UNUSED = "XAC215"
_NEEDED = "LINT303"
_FILE_CODES = frozenset({"XML101", "XAC506"})
_MOST_TRIED = 12
"""The most values to try of those that a description compares its arguments with."""
_ANY_VALUE = "value"
"""A substitute for an unknown value, to see which errors depend on it."""
_FEW = 4
"""The number of arguments that messages name."""
_NO_VALUES = ArgumentSet({})

Key = tuple[str, Span | None, object]


@dataclass(frozen=True, slots=True, eq=False)
class _Run:
    """The check of a description with one set of arguments.

    Attributes:
        given: the values of the arguments.
        checked: the result.
        errors: the keys of the errors of the expansion and of the reader.
        hanging: the subset of `errors` that may be due to arguments whose values only the caller knows.
    """

    given: ArgumentSet
    checked: Checked
    errors: frozenset[Key]
    hanging: frozenset[Key] = frozenset()

    @property
    def messages_of_errors(self) -> frozenset[tuple[Key, str]]:
        """The key and the message of each error."""
        places = ((_place(diagnostic), str(diagnostic.message)) for diagnostic in self.checked.diagnostics)
        return frozenset(place for place in places if place[0] in self.errors)

    def is_fine(self, common: frozenset[Key]) -> bool:
        """Return whether all errors are common ones and none may be due to an unknown value."""
        return self.errors <= common and not self.hanging


@dataclass(eq=False)
class SetCheck:
    """The check of one description with several sets of arguments.

    Args:
        path: the file.
        finder: the finder of packages.
        examine: the function that checks the file with given values. Its flag says whether to expand the file; None
            decides by the file.
        settings: the settings for the file.
        is_named: whether the user named the file. Then, a failure to expand it without arguments is reported.
    """

    path: Path
    finder: PackageFinder
    settings: Settings
    examine: Callable[[Mapping[str, str], bool | None], Checked]
    is_named: bool
    _xacro: bool | None = field(default=None, init=False)
    _is_expanded: bool = field(default=False, init=False)

    def with_configured(self, sets: Sequence[Mapping[str, str]]) -> Checked:
        """Return the merged result for configured argument sets; those of callers are ignored."""
        return self._merged([self._run(ArgumentSet(values)) for values in sets], ())

    def with_callers(self, find_sets: Callable[[], Sequence[ArgumentSet]]) -> Checked:
        """Return the merged result for the defaults and for the argument sets of callers.

        `find_sets` returns the callers' sets and is called only if they are needed.
        """
        default = self._run(_NO_VALUES)
        if _has_expressions(default.checked):
            default = self._expanded(find_sets()) or default
        if (self.is_named and not default.errors) or not _takes_arguments(default.checked):
            return default.checked
        sets = find_sets()
        if self.is_named and not any(argument_set.values or argument_set.open for argument_set in sets):
            return default.checked
        known = [self._run(argument_set) for argument_set in sets if argument_set.is_complete and argument_set.values]
        uses_defaults = any(argument_set.is_complete and not argument_set.values for argument_set in sets)
        is_unknown = bool(default.errors) and not (known or uses_defaults or self.is_named)
        common = frozenset.intersection(*(run.errors for run in (default, *known)))
        others: list[_Run] = []
        if not known or not all(run.is_fine(common) for run in known):
            more = compared_values(_sources(default.checked))[:_MOST_TRIED] if is_unknown else ()
            others = [
                self._run(argument_set)
                for argument_set in (*sets, *more)
                if not argument_set.is_complete and argument_set.values
            ]
            common = frozenset.intersection(common, *(run.errors for run in others))
        tried = [*known, *others]
        kept = [run for run in known if not _is_excused(run, tried, common)]
        if default.is_fine(common) or uses_defaults:
            kept.insert(0, default)
        kept = kept or [run for run in others if run.is_fine(common)]
        if not kept and any(argument_set.open for argument_set in sets):
            return self._result_for_unknown_values(default, [default, *tried], common, sets)
        if is_unknown and kept in ([], [default]):
            return self._without_values(default, sets)
        if not kept or default in kept:
            return self._merged(kept or [default], ())
        return self._merged(kept, self._needs_arguments_finding(kept[0], default, common, sets))

    def _expanded(self, sets: Sequence[ArgumentSet]) -> _Run | None:
        """Return the default run of a file that launch files pass to xacro, now with expansion.

        Return None if there are no argument sets, or if the defaults and all sets cause errors.
        """
        if not sets:
            return None
        self._xacro = True
        default = self._run(_NO_VALUES)
        if default.errors and all(self._run(argument_set).errors for argument_set in sets if argument_set.values):
            self._xacro = None
            return None
        return default

    def _run(self, given: ArgumentSet) -> _Run:
        # Once a file was expanded with some arguments, do not test again whether it is xacro.
        checked = self.examine(given.values, True if given.values and self._is_expanded else self._xacro)
        self._is_expanded = checked.subject is not None and checked.subject.expansion is not None
        if given.values:  # a caller may set arguments that only other descriptions declare
            found = tuple(diagnostic for diagnostic in checked.diagnostics if diagnostic.code != UNUSED)
            checked = replace(checked, diagnostics=found)
        errors = frozenset(
            _place(diagnostic)
            for diagnostic in checked.diagnostics
            if diagnostic.severity is Severity.ERROR and find_rule(diagnostic.code) is None
        )
        run = _Run(given, checked, errors)
        if not (errors and given.open):
            return run
        opened = dict.fromkeys(filter(None, given.open), _ANY_VALUE)
        changed = self._changed(run, opened) if opened else frozenset()
        return replace(run, hanging=changed | {place for place in errors if _may_depend_on_argument(place[0])})

    # --- findings ---------------------------------------------------------------------------------------------

    def _merged(self, runs: Sequence[_Run], more: Iterable[Diagnostic]) -> Checked:
        """Merge the findings of several runs without duplicates.

        The robot is that of the first run that has one.
        """
        collected: dict[Key, tuple[Diagnostic, list[_Run]]] = {}
        for run in runs:
            for key, each in _numbered(run.checked.diagnostics):
                collected.setdefault(key, (each, []))[1].append(run)
        found: list[Diagnostic] = [*with_configured_severity(more, self.settings)]
        copied = {name for run in runs if run.checked.subject for name in run.checked.subject.once(placeholders)}
        for diagnostic, having in collected.values():
            if diagnostic.code in LEFT_TO_PLACEHOLDERS and as_phrase(diagnostic.message).arguments["name"] in copied:
                continue  # the placeholder rule reports these findings, in a run with other values
            if len(having) == len(runs):
                found.append(diagnostic)
            elif not _holds_for_all_sets(diagnostic):
                found.append(_add_condition(diagnostic, having, runs))
        best = next((run.checked for run in runs if run.checked.robot is not None), runs[0].checked)
        return replace(best, diagnostics=tuple(sorted_by_place(found, str(self.path))))

    def _needs_arguments_finding(
        self, working: _Run, default: _Run, common: frozenset[Key], sets: Sequence[ArgumentSet]
    ) -> Iterator[Diagnostic]:
        """Yield the finding that the defaults alone do not produce a robot."""
        names = self._required_arguments(working.given.values, common)
        shown = " ".join(f"{name}:={working.given.values[name]}" for name in names[:_FEW])
        message = (
            phrase("for instance, it gets {values} here", values=shown)
            if working.given in sets
            else phrase("for instance, it can be expanded with {values}", values=shown)
        )
        notes = [Note(message, working.given.span)]
        if len(sets) > 1 and working.given in sets:
            notes.append(Note(phrase("it is checked with the {count} given sets of values", count=len(sets))))
        yield _needs_arguments(default.checked, names, tuple(notes))

    def _required_arguments(self, values: Mapping[str, str], common: frozenset[Key]) -> list[str]:
        """Return the names of the arguments without which the expansion fails.

        They are found by leaving out each argument in turn.
        """
        kept = dict(values)
        for name in values:
            fewer = {each: value for each, value in kept.items() if each != name}
            if self._expands(fewer, common):
                kept = fewer
        return list(kept)

    def _expands(self, values: Mapping[str, str], common: frozenset[Key]) -> bool:
        try:
            found = examine_description(
                self.path, arguments=values, packages=self.finder, xacro=self._xacro, partly=True
            ).diagnostics
        except LinkwrightError as error:
            found = error.diagnostics
        return all(diagnostic.severity is not Severity.ERROR or _place(diagnostic) in common for diagnostic in found)

    def _result_for_unknown_values(
        self, default: _Run, runs: Sequence[_Run], common: frozenset[Key], sets: Sequence[ArgumentSet]
    ) -> Checked:
        """Return the result of the default run for callers whose values are known only at runtime.

        Errors that may be due to such values are left out.
        """
        names = _runtime_arguments(sets)
        if not names:
            return self._without_values(default, sets)
        certain = common.difference(*(run.hanging for run in runs))
        return self._only(default, lambda error: _place(error) in certain, names, _runtime_value_note(sets))

    def _without_values(self, default: _Run, sets: Sequence[ArgumentSet]) -> Checked:
        """Return the result of the default run for callers without known values.

        Such callers are assumed to set the arguments that lack a declaration or a value. Errors that depend on these
        arguments are left out.
        """
        asked = [name for diagnostic in default.checked.diagnostics if (name := undeclared_argument(diagnostic))]
        if asked:
            hanging = self._changed(default, dict.fromkeys(asked, _ANY_VALUE))
            return self._only(
                default,
                lambda error: undeclared_argument(error) is None and _place(error) not in hanging,
                list(dict.fromkeys(asked)),
                _runtime_value_note(sets),
            )
        names = dict.fromkeys((*_runtime_arguments(sets), *empty_defaults(_sources(default.checked))))
        changed = {
            name: found for name in list(names)[:_MOST_TRIED] if (found := self._changed(default, {name: _ANY_VALUE}))
        }
        if not changed:
            return default.checked
        hanging = frozenset[Key]().union(*changed.values())
        return self._only(default, lambda error: _place(error) not in hanging, list(changed), _runtime_value_note(sets))

    def _changed(self, run: _Run, values: Mapping[str, str]) -> frozenset[Key]:
        """Return the keys of the errors that change or disappear with other values."""
        other = self._run(ArgumentSet({**run.given.values, **values})).messages_of_errors
        return frozenset(place for place, message in run.messages_of_errors if (place, message) not in other)

    def _only(
        self, default: _Run, is_certain: Callable[[Diagnostic], bool], names: Sequence[str], notes: tuple[Note, ...]
    ) -> Checked:
        found = [
            diagnostic
            for diagnostic in default.checked.diagnostics
            if _place(diagnostic) not in default.errors or is_certain(diagnostic)
        ]
        hint = phrase(
            'give values in linkwright.toml: [arguments] "{file}" = {{ {name} = "..." }}',
            file=self.path.name,
            name=names[0],
        )
        found += with_configured_severity([_needs_arguments(default.checked, names, notes, hint)], self.settings)
        return replace(default.checked, diagnostics=tuple(sorted_by_place(found, str(self.path))))


def _sources(checked: Checked) -> Sequence[Document]:
    return () if checked.subject is None else tuple(checked.subject.sources.values())


def _has_expressions(checked: Checked) -> bool:
    """Return whether a file was read without expansion although its text has xacro expressions."""
    if checked.subject is None or checked.subject.expansion is not None:
        return False
    texts = [document.source.text for document in _sources(checked) if document.source is not None]
    return any("${" in text or "$(" in text for text in texts)


def _takes_arguments(checked: Checked) -> bool:
    """Return whether arguments might change a description, because its sources contain ``arg``.

    A file without a subject takes arguments if its suffix is ``.xacro``.
    """
    if checked.subject is None:
        return checked.path.suffix == ".xacro"
    sources = checked.subject.sources.values()
    return any("arg" in source.source.text for source in sources if source.source is not None)


def _place(diagnostic: Diagnostic) -> Key:
    return diagnostic.code, diagnostic.span, "" if diagnostic.span else diagnostic.message


def _numbered(diagnostics: Iterable[Diagnostic]) -> Iterator[tuple[Key, Diagnostic]]:
    """Yield each diagnostic with a key: code, span, and index among the findings at this span.

    The key leaves the message out, since numbers and names in messages differ between sets.
    """
    count: dict[Key, int] = {}
    for diagnostic in diagnostics:
        place = _place(diagnostic)
        count[place] = count.get(place, 0) + 1
        yield (*place[:2], (place[2], count[place])), diagnostic


def _is_excused(run: _Run, tried: Sequence[_Run], common: frozenset[Key]) -> bool:
    """Return whether a set fails only because its values do not fit together.

    This is so if the set is mixed from several sources, or if the values that vary succeed in another run.
    """
    if run.is_fine(common) or not run.given.varied:
        return False
    if run.given.is_mixed:
        return True
    apart = {name: run.given.values[name] for name in run.given.varied}
    return any(other.is_fine(common) and apart.items() <= other.given.values.items() for other in tried)


def _holds_for_all_sets(diagnostic: Diagnostic) -> bool:
    rule = find_rule(diagnostic.code)
    return rule is not None and rule.needs_all_sets


def _add_condition(diagnostic: Diagnostic, having: Sequence[_Run], runs: Sequence[_Run]) -> Diagnostic:
    """Return a finding with a note on the values under which it occurs.

    An error becomes a warning if all runs that have it use values that a launch argument merely offers. Such a value
    may require a matching value of another argument, such as the number of joints for the kind of arm.
    """
    notes = (*diagnostic.notes, _condition(having[0], runs))
    is_offered = diagnostic.severity is Severity.ERROR and all(run.given.is_offered for run in having)
    return diagnostic.with_changes(notes=notes, severity=Severity.WARNING if is_offered else diagnostic.severity)


def _condition(run: _Run, runs: Sequence[_Run]) -> Note:
    """Return a note with the values of a run that differ from those of other runs."""
    values = run.given.values
    own = [name for name in values if any(other.given.values.get(name) != values[name] for other in runs)]
    if not own:
        return Note(phrase("this happens without arguments"))
    first = [name for name in own if name in run.given.varied] or own
    shown = " ".join(f"{name}:={values[name]}" for name in first[:_FEW])
    return Note(phrase("this happens with {values}", values=shown), run.given.span)


def undeclared_argument(diagnostic: Diagnostic) -> str | None:
    """Return the name of the argument that a finding reports as undeclared, or None.

    The result is also None if the name may be misspelt.
    """
    if diagnostic.code != UNDECLARED or as_phrase(diagnostic.hint or "").template.startswith("did you mean"):
        return None
    return str(as_phrase(diagnostic.message).arguments.get("name", ""))


def _runtime_arguments(sets: Sequence[ArgumentSet]) -> list[str]:
    """Return the names of the arguments whose values are known only when their callers run."""
    return list(dict.fromkeys(name for argument_set in sets for name in argument_set.open if name))


def _runtime_value_note(sets: Sequence[ArgumentSet]) -> tuple[Note, ...]:
    """Return a note on the first caller with values known only at runtime, or an empty tuple."""
    calls = [argument_set.span for argument_set in sets if argument_set.open]
    return (Note(phrase("their values are only known when this runs"), calls[0]),) if calls else ()


def _may_depend_on_argument(code: str) -> bool:
    """Return whether an error may depend on the value of an argument.

    Such errors concern a name, a file, or how the robot is connected.
    """
    if code.startswith("URDF"):
        return code not in TRUE_OF_PARTS
    return code in (UNDECLARED, *_FILE_CODES)


def _needs_arguments(
    checked: Checked, names: Sequence[str], notes: tuple[Note, ...], hint: Phrase | None = None
) -> Diagnostic:
    shown = list(names[:_FEW])
    what = quoted_names(shown, " and ") if len(names) == len(shown) else joined([quoted_names(shown), "..."])
    message = counted(
        "'{file}' needs the argument {names}",
        "'{file}' needs the arguments {names}",
        len(names),
        file=checked.path.name,
        names=what,
    )
    root = next(iter(checked.subject.sources.values())).root if checked.subject is not None else None
    span = root.span() if root is not None else None
    source = root.source if root is not None else None
    return Diagnostic(_NEEDED, message, span, Severity.INFO, notes, hint, source)
