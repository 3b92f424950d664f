"""Checks of a description with every set of argument values, without duplicate findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.descriptions import examine as examine_description
from linkwright.descriptions.argument_sets import ArgumentSet, compared_values, empty_defaults, usable_defaults
from linkwright.descriptions.service import HOLDS_FOR_PARTS
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
from linkwright.lint.engine import Checked, sort_by_location, with_configured_severity
from linkwright.lint.registry import find_rule
from linkwright.lint.rules.inertia_doubtful import SKIPPED_FOR_PLACEHOLDERS, find_placeholder_links
from linkwright.lint.settings import Settings
from linkwright.loading.lean_dataclasses import dataclass, field, replace
from linkwright.packages import PackageFinder
from linkwright.xmltree import Document

UNDECLARED_CODE = "XAC211"
UNUSED_CODE = "XAC215"
_NEEDS_ARGUMENTS_CODE = "LINT303"
_FILE_CODES = frozenset({"XML101", "XAC506"})
_MAX_TRIED_VALUES = 12
"""The maximum number of values to try, among those that a description compares its arguments with."""
_ANY_VALUE = "value"
"""A substitute for an unknown value, to see which errors depend on it."""
_OWNER = "owner"
"""The argument of a message that names the link or joint which has the error."""
_MAX_SHOWN_ARGUMENTS = 4
"""The maximum number of arguments that a message names."""
_NO_VALUES = ArgumentSet({})

Key = tuple[str, Span | None, object]


@dataclass(frozen=True, slots=True, eq=False)
class _Run:
    """The check of a description with one set of arguments.

    Attributes:
        argument_set: the values of the arguments.
        result: the result of the check.
        errors: the keys of the errors of the expansion and of the reader.
        hanging: the subset of `errors` that may be due to arguments whose values are known only at run time.
    """

    argument_set: ArgumentSet
    result: Checked
    errors: frozenset[Key]
    hanging: frozenset[Key] = frozenset()

    @property
    def error_messages(self) -> frozenset[tuple[Key, str]]:
        """The key and the message of each error."""
        keyed_messages = (
            (_finding_key(diagnostic), _strip_owner(diagnostic)) for diagnostic in self.result.diagnostics
        )
        return frozenset(pair for pair in keyed_messages if pair[0] in self.errors)

    def is_fine(self, common: frozenset[Key]) -> bool:
        """Return whether all errors are in `common` and none may be due to an unknown value."""
        return self.errors <= common and not self.hanging


@dataclass(eq=False)
class SetCheck:
    """The check of one description with several sets of arguments.

    Args:
        path: the file.
        finder: the finder of packages.
        examine: the function that checks the file with given values. Its second argument is whether to expand the file;
            None decides by the file.
        settings: the settings for the file.
        is_named: whether the user named the file. Then, a failure to expand it without arguments is reported.
    """

    path: Path
    finder: PackageFinder
    settings: Settings
    examine: Callable[[Mapping[str, str], bool | None], Checked]
    is_named: bool
    _should_expand: bool | None = field(default=None, init=False)
    _is_expanded: bool = field(default=False, init=False)

    def with_configured(self, sets: Sequence[Mapping[str, str]]) -> Checked:
        """Return the merged result for configured argument sets, without argument sets of callers."""
        return self._merge_runs([self._run(ArgumentSet(values)) for values in sets], ())

    def with_callers(self, find_sets: Callable[[], Sequence[ArgumentSet]]) -> Checked:
        """Return the merged result for the defaults and for the argument sets of callers.

        `find_sets` returns the callers' sets and is called only if they are needed.
        """
        default = self._run(_NO_VALUES)
        if _has_expressions(default.result):
            default = self._run_expanded(find_sets()) or default
        if (self.is_named and not default.errors) or not _uses_arguments(default.result):
            return default.result
        sets = find_sets()
        if self.is_named and not any(argument_set.values or argument_set.runtime_names for argument_set in sets):
            return default.result
        complete_runs = [
            self._run(argument_set) for argument_set in sets if argument_set.is_complete and argument_set.values
        ]
        uses_defaults = any(argument_set.is_complete and not argument_set.values for argument_set in sets)
        is_unknown = bool(default.errors) and not (complete_runs or uses_defaults or self.is_named)
        common = frozenset.intersection(*(run.errors for run in (default, *complete_runs)))
        other_runs: list[_Run] = []
        if not complete_runs or not all(run.is_fine(common) for run in complete_runs):
            compared_sets = compared_values(_sources(default.result))[:_MAX_TRIED_VALUES] if is_unknown else ()
            other_runs = [
                self._run(argument_set)
                for argument_set in (*sets, *compared_sets)
                if not argument_set.is_complete and argument_set.values
            ]
            common = frozenset.intersection(common, *(run.errors for run in other_runs))
        all_runs = [*complete_runs, *other_runs]
        usable_runs = [run for run in complete_runs if not _is_excused(run, all_runs, common)]
        if default.is_fine(common) or uses_defaults:
            usable_runs.insert(0, default)
        usable_runs = usable_runs or [run for run in other_runs if run.is_fine(common)]
        if not usable_runs and any(argument_set.runtime_names for argument_set in sets):
            return self._result_for_unknown_values(default, [default, *all_runs], common, sets)
        if is_unknown and usable_runs in ([], [default]):
            return self._result_without_values(default, sets)
        if not usable_runs or default in usable_runs:
            return self._merge_runs(usable_runs or [default], ())
        return self._merge_runs(usable_runs, self._needs_arguments_finding(usable_runs[0], default, common, sets))

    def _run_expanded(self, sets: Sequence[ArgumentSet]) -> _Run | None:
        """Check the file again with expansion, and return the run with default values.

        The file needs expansion because launch files pass it to xacro. The result is None if there are no argument
        sets, or if the defaults and all sets cause errors.
        """
        if not sets:
            return None
        self._should_expand = True
        default = self._run(_NO_VALUES)
        if default.errors and all(self._run(argument_set).errors for argument_set in sets if argument_set.values):
            self._should_expand = None
            return None
        return default

    def _run(self, argument_set: ArgumentSet) -> _Run:
        # Once a file was expanded with some arguments, do not test again whether it is xacro.
        result = self.examine(
            argument_set.values, True if argument_set.values and self._is_expanded else self._should_expand
        )
        self._is_expanded = result.subject is not None and result.subject.expansion is not None
        if argument_set.values:  # a caller may set arguments that only other descriptions declare
            diagnostics = tuple(diagnostic for diagnostic in result.diagnostics if diagnostic.code != UNUSED_CODE)
            result = replace(result, diagnostics=diagnostics)
        errors = frozenset(
            _finding_key(diagnostic)
            for diagnostic in result.diagnostics
            if diagnostic.severity is Severity.ERROR and find_rule(diagnostic.code) is None
        )
        run = _Run(argument_set, result, errors)
        if not (errors and argument_set.runtime_names):
            return run
        assumed_values = dict.fromkeys(filter(None, argument_set.runtime_names), _ANY_VALUE)
        changed_errors = self._find_changed_errors(run, assumed_values) if assumed_values else frozenset()
        return replace(run, hanging=changed_errors | {key for key in errors if _may_depend_on_argument(key[0])})

    # --- findings ---------------------------------------------------------------------------------------------

    def _merge_runs(self, runs: Sequence[_Run], extra: Iterable[Diagnostic]) -> Checked:
        """Merge the findings of several runs without duplicates.

        The merged result contains the robot of the first run that has a robot.
        """
        occurrences: dict[Key, tuple[Diagnostic, list[_Run]]] = {}
        for run in runs:
            for key, finding in _number_keys(run.result.diagnostics):
                occurrences.setdefault(key, (finding, []))[1].append(run)
        diagnostics: list[Diagnostic] = [*with_configured_severity(extra, self.settings)]
        placeholder_names = {
            name for run in runs if run.result.subject for name in run.result.subject.once(find_placeholder_links)
        }
        for diagnostic, affected_runs in occurrences.values():
            if (
                diagnostic.code in SKIPPED_FOR_PLACEHOLDERS
                and as_phrase(diagnostic.message).arguments["name"] in placeholder_names
            ):
                continue  # the placeholder rule reports these findings, in a run with other values
            if len(affected_runs) == len(runs):
                diagnostics.append(diagnostic)
            elif not _holds_for_all_sets(diagnostic):
                diagnostics.append(_add_condition(diagnostic, affected_runs, runs))
        best_result = next((run.result for run in runs if run.result.robot is not None), runs[0].result)
        return replace(best_result, diagnostics=tuple(sort_by_location(diagnostics, str(self.path))))

    def _needs_arguments_finding(
        self, working_run: _Run, default: _Run, common: frozenset[Key], sets: Sequence[ArgumentSet]
    ) -> Iterator[Diagnostic]:
        """Yield the finding that the defaults alone do not produce a robot."""
        names = self._find_required_arguments(working_run.argument_set.values, common)
        shown_values = " ".join(
            f"{name}:={working_run.argument_set.values[name]}" for name in names[:_MAX_SHOWN_ARGUMENTS]
        )
        message = (
            phrase("for instance, a caller passes {values} here", values=shown_values)
            if working_run.argument_set in sets
            else phrase("for instance, {values} expands the file", values=shown_values)
        )
        notes = [Note(message, working_run.argument_set.span)]
        if len(sets) > 1 and working_run.argument_set in sets:
            notes.append(Note(phrase("the file is checked with {count} sets of values", count=len(sets))))
        failure = None
        if usable_defaults(_sources(default.result)).issuperset(names):
            failure = _find_failure_of_defaults(default, common)
        yield _make_missing_arguments_finding(default.result, names, tuple(notes), failure=failure)

    def _find_required_arguments(self, values: Mapping[str, str], common: frozenset[Key]) -> list[str]:
        """Return the names of the arguments without which the expansion fails.

        The arguments are found by leaving out each argument in turn.
        """
        needed_values = dict(values)
        known_errors = common | self._find_errors(values)  # such as a missing package, whose parts are left out
        for name in values:
            fewer_values = {other_name: value for other_name, value in needed_values.items() if other_name != name}
            if self._find_errors(fewer_values) <= known_errors:
                needed_values = fewer_values
        return list(needed_values)

    def _find_errors(self, values: Mapping[str, str]) -> frozenset[Key]:
        """Return the keys of the errors with which a description is expanded and read."""
        try:
            diagnostics = examine_description(
                self.path, arguments=values, packages=self.finder, xacro=self._should_expand, partly=True
            ).diagnostics
        except LinkwrightError as error:
            diagnostics = error.diagnostics
        return frozenset(
            _finding_key(diagnostic) for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR
        )

    def _result_for_unknown_values(
        self, default: _Run, runs: Sequence[_Run], common: frozenset[Key], sets: Sequence[ArgumentSet]
    ) -> Checked:
        """Return the result of the default run for callers whose values are known only at runtime.

        Errors that may be due to such values are left out.
        """
        names = _find_runtime_arguments(sets)
        if not names:
            return self._result_without_values(default, sets)
        certain_errors = common.difference(*(run.hanging for run in runs))
        return self._without_uncertain_errors(
            default, lambda error: _finding_key(error) in certain_errors, names, _make_runtime_value_note(sets)
        )

    def _result_without_values(self, default: _Run, sets: Sequence[ArgumentSet]) -> Checked:
        """Return the result of the default run for callers without known values.

        Such callers are assumed to set the arguments that lack a declaration or a value. Errors that depend on these
        arguments are left out.
        """
        undeclared_names = [
            name for diagnostic in default.result.diagnostics if (name := find_undeclared_argument(diagnostic))
        ]
        if undeclared_names:
            uncertain_errors = self._find_changed_errors(default, dict.fromkeys(undeclared_names, _ANY_VALUE))
            return self._without_uncertain_errors(
                default,
                lambda error: find_undeclared_argument(error) is None and _finding_key(error) not in uncertain_errors,
                list(dict.fromkeys(undeclared_names)),
                _make_runtime_value_note(sets),
            )
        names = dict.fromkeys((*_find_runtime_arguments(sets), *empty_defaults(_sources(default.result))))
        changed_errors = {
            name: errors
            for name in list(names)[:_MAX_TRIED_VALUES]
            if (errors := self._find_changed_errors(default, {name: _ANY_VALUE}))
        }
        if not changed_errors:
            return default.result
        uncertain_errors = frozenset[Key]().union(*changed_errors.values())
        return self._without_uncertain_errors(
            default,
            lambda error: _finding_key(error) not in uncertain_errors,
            list(changed_errors),
            _make_runtime_value_note(sets),
        )

    def _find_changed_errors(self, run: _Run, values: Mapping[str, str]) -> frozenset[Key]:
        """Return the keys of the errors that change or disappear with other values."""
        other_messages = self._run(ArgumentSet({**run.argument_set.values, **values})).error_messages
        return frozenset(key for key, message in run.error_messages if (key, message) not in other_messages)

    def _without_uncertain_errors(
        self, default: _Run, is_certain: Callable[[Diagnostic], bool], names: Sequence[str], notes: tuple[Note, ...]
    ) -> Checked:
        diagnostics = [
            diagnostic
            for diagnostic in default.result.diagnostics
            if _finding_key(diagnostic) not in default.errors or is_certain(diagnostic)
        ]
        hint = phrase(
            'give values in linkwright.toml: [arguments] "{file}" = {{ {name} = "..." }}',
            file=self.path.name,
            name=names[0],
        )
        diagnostics += with_configured_severity(
            [_make_missing_arguments_finding(default.result, names, notes, hint)], self.settings
        )
        return replace(default.result, diagnostics=tuple(sort_by_location(diagnostics, str(self.path))))


def _sources(result: Checked) -> Sequence[Document]:
    return () if result.subject is None else tuple(result.subject.sources.values())


def _has_expressions(result: Checked) -> bool:
    """Return whether a file was read without expansion although its text has xacro expressions."""
    if result.subject is None or result.subject.expansion is not None:
        return False
    texts = [document.source.text for document in _sources(result) if document.source is not None]
    return any("${" in text or "$(" in text for text in texts)


def _uses_arguments(result: Checked) -> bool:
    """Return whether arguments might change a description, because its sources contain ``arg``.

    A file without a subject takes arguments if its suffix is ``.xacro``.
    """
    if result.subject is None:
        return result.path.suffix == ".xacro"
    sources = result.subject.sources.values()
    return any("arg" in source.source.text for source in sources if source.source is not None)


def _finding_key(diagnostic: Diagnostic) -> Key:
    return diagnostic.code, diagnostic.span, "" if diagnostic.span else diagnostic.message


def _strip_owner(diagnostic: Diagnostic) -> str:
    """Return the message of a finding without the link or joint that has it, whose name may have a prefix."""
    message = as_phrase(diagnostic.message)
    return str(message.with_arguments(**{_OWNER: ""}) if _OWNER in message.arguments else message)


def _number_keys(diagnostics: Iterable[Diagnostic]) -> Iterator[tuple[Key, Diagnostic]]:
    """Yield each diagnostic with a key: code, span, and index among the findings at this span.

    The key leaves the message out, since numbers and names in messages differ between sets.
    """
    counts: dict[Key, int] = {}
    for diagnostic in diagnostics:
        key = _finding_key(diagnostic)
        counts[key] = counts.get(key, 0) + 1
        yield (*key[:2], (key[2], counts[key])), diagnostic


def _is_excused(run: _Run, runs: Sequence[_Run], common: frozenset[Key]) -> bool:
    """Return whether a set fails only because its values do not fit together.

    This is the case if the set is mixed (see `ArgumentSet.is_mixed`), or if the values that vary succeed in another
    run.
    """
    if run.is_fine(common) or not run.argument_set.varied:
        return False
    if run.argument_set.is_mixed:
        return True
    varied_values = {name: run.argument_set.values[name] for name in run.argument_set.varied}
    return any(other.is_fine(common) and varied_values.items() <= other.argument_set.values.items() for other in runs)


def _holds_for_all_sets(diagnostic: Diagnostic) -> bool:
    rule = find_rule(diagnostic.code)
    return rule is not None and rule.needs_all_sets


def _add_condition(diagnostic: Diagnostic, affected_runs: Sequence[_Run], runs: Sequence[_Run]) -> Diagnostic:
    """Return a finding with a note on the values under which it occurs.

    An error becomes a warning if all runs that have it use values that a launch argument merely offers. Such a value
    may require a matching value of another argument, such as the number of joints for the kind of arm.
    """
    notes = (*diagnostic.notes, _make_condition_note(affected_runs[0], runs))
    is_offered = diagnostic.severity is Severity.ERROR and all(run.argument_set.is_offered for run in affected_runs)
    return diagnostic.with_changes(notes=notes, severity=Severity.WARNING if is_offered else diagnostic.severity)


def _make_condition_note(run: _Run, runs: Sequence[_Run]) -> Note:
    """Return a note with the values that differ between a run and the other runs."""
    values = run.argument_set.values
    differing_names = [
        name for name in values if any(other.argument_set.values.get(name) != values[name] for other in runs)
    ]
    if not differing_names:
        return Note(phrase("this happens without arguments"))
    shown_names = [name for name in differing_names if name in run.argument_set.varied] or differing_names
    shown_values = " ".join(f"{name}:={values[name]}" for name in shown_names[:_MAX_SHOWN_ARGUMENTS])
    return Note(phrase("this happens with {values}", values=shown_values), run.argument_set.span)


def find_undeclared_argument(diagnostic: Diagnostic) -> str | None:
    """Return the name of the argument that a finding reports as undeclared, or None.

    The result is also None if the name may be misspelled.
    """
    if diagnostic.code != UNDECLARED_CODE or as_phrase(diagnostic.hint or "").template.startswith("did you mean"):
        return None
    return str(as_phrase(diagnostic.message).arguments.get("name", ""))


def _find_runtime_arguments(sets: Sequence[ArgumentSet]) -> list[str]:
    """Return the names of the arguments whose values are known only when their callers run."""
    return list(dict.fromkeys(name for argument_set in sets for name in argument_set.runtime_names if name))


def _make_runtime_value_note(sets: Sequence[ArgumentSet]) -> tuple[Note, ...]:
    """Return a note on the first caller with values known only at runtime, or an empty tuple."""
    call_spans = [argument_set.span for argument_set in sets if argument_set.runtime_names]
    return (
        (Note(phrase("the values of these arguments are only known at run time"), call_spans[0]),) if call_spans else ()
    )


def _may_depend_on_argument(code: str) -> bool:
    """Return whether an error may depend on the value of an argument.

    Such errors concern a name, a file, or the connections between the robot's links.
    """
    if code.startswith("URDF"):
        return code not in HOLDS_FOR_PARTS
    return code in (UNDECLARED_CODE, *_FILE_CODES)


def _find_failure_of_defaults(default: _Run, common: frozenset[Key]) -> Phrase | str | None:
    """Return the first error that only the default values cause, or None if they are not declared where they are used.

    Args:
        default: the check with the default values.
        common: the errors of all checks.
    """
    own_errors = default.errors - common
    if any(code == UNDECLARED_CODE for code, _, _ in own_errors):
        return None
    return next((error.message for error in default.result.diagnostics if _finding_key(error) in own_errors), None)


def _make_missing_arguments_finding(
    result: Checked,
    names: Sequence[str],
    notes: tuple[Note, ...],
    hint: Phrase | None = None,
    failure: Phrase | str | None = None,
) -> Diagnostic:
    """Return the finding that a file needs arguments, or that it fails with the defaults that it gives them."""
    shown_names = list(names[:_MAX_SHOWN_ARGUMENTS])
    names_text = (
        quoted_names(shown_names, " and ")
        if len(names) == len(shown_names)
        else joined([quoted_names(shown_names), "..."])
    )
    message = counted(
        "'{file}' needs the argument {names}",
        "'{file}' needs the arguments {names}",
        len(names),
        file=result.path.name,
        names=names_text,
    )
    if failure is not None:
        message = counted(
            "'{file}' cannot be expanded with the default of the argument {names}: {reason}",
            "'{file}' cannot be expanded with the defaults of the arguments {names}: {reason}",
            len(names), file=result.path.name, names=names_text, reason=failure,
        )  # fmt: skip
    root = next(iter(result.subject.sources.values())).root if result.subject is not None else None
    span = root.span() if root is not None else None
    source = root.source if root is not None else None
    return Diagnostic(_NEEDS_ARGUMENTS_CODE, message, span, Severity.INFO, notes, hint, source)
