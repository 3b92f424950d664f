"""Find the cases to compare: both versions of a description with each argument set of their callers."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.descriptions import Description
from linkwright.descriptions.argument_sets import ArgumentSet
from linkwright.descriptions.pairs import Model, Pair
from linkwright.diagnostics import LinkwrightError, Severity, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.lint.argument_sets import UNDECLARED_CODE, UNUSED_CODE
from linkwright.review.changes import Change
from linkwright.review.file_pair import Fault, FilePair
from linkwright.review.parts.outline import PROPERTY, try_read_outline
from linkwright.review.robots.partial_robots import PartialPair, find_missing_names, read_partial_robot
from linkwright.review.robots.unpaired_robots import format_robot
from linkwright.review.texts.folders import without_folder
from linkwright.review.versions import Version

_MAX_CASES = 12
"""The maximum number of argument sets to compare. Launch files of vendors can combine hundreds."""


MAX_SWITCHES = 8
"""The maximum number of boolean arguments whose opposite value is tried."""
_PACKAGE_CODE = "PKG101"
_MISSING_CODES = (_PACKAGE_CODE, "XML101")
"""The codes of packages and files that are not found."""
OPPOSITES: Mapping[str, str] = {"true": "false", "false": "true", "True": "False", "False": "True"}
_NUMERIC_OPPOSITES: Mapping[str, str] = {"0": "1", "1": "0"}
"""The values of arguments that are boolean if a condition uses them, such as ``$(optenv ROBOT_LASER 0)``."""
_CONDITIONS = ("xacro:if", "xacro:unless")
_ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_WORD = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class Case:
    """A description in both versions with one set of argument values.

    Attributes:
        name: the values as ``name:=value`` words; empty for the defaults.
        old: the description in the old version.
        new: the description in the new version.
        models: both models.
        partial: both robots, if they lack packages or files that neither version has; else None.
    """

    name: str
    old: Description
    new: Description
    models: Pair
    partial: PartialPair | None = None


@dataclass
class _ArgumentValues:
    """An argument set with which one or both versions are called.

    Attributes:
        old: the values, with the paths of the old version.
        new: the values, with the paths of the new version.
        doubt: the number of reasons why the values may not occur together; 0 if they do.
        is_of_old: whether the old version is called with them.
        is_of_new: whether the new version is called with them.
    """

    old: Mapping[str, str]
    new: Mapping[str, str]
    doubt: int
    is_of_old: bool = False
    is_of_new: bool = False


@dataclass(frozen=True)
class _Failure:
    """An argument set that fails in a version, and the results for both versions."""

    name: str
    values: _ArgumentValues
    old: Description | LinkwrightError
    new: Description | LinkwrightError


def find_cases(pair: FilePair) -> Iterator[Case]:
    """Yield the description with each argument set that a caller of either version uses.

    A set that fails in both versions is reported as a problem; a set that fails in one version, as a change.
    """
    sets = _collect_argument_sets(pair)
    certain = sum(not values.doubt for values in sets.values())
    if certain > _MAX_CASES:
        text = phrase("only {count} of {total} sets of argument values were compared", count=_MAX_CASES, total=certain)
        pair.add_problem(text)
    failures: list[_Failure] = []
    for name, values in list(sets.items())[:_MAX_CASES]:
        result = _make_case(pair, name, values)
        if isinstance(result, Case):
            yield result
        else:
            failures.append(result)
    if not pair.cases and all(_needs_values(failure) for failure in failures):
        failures = yield from _try_values(pair, failures)
    _report_failures(pair, failures)


def find_switched_cases(pair: FilePair, compared: Sequence[Case]) -> Iterator[Case]:
    """Yield the description with each boolean argument inverted that both versions have.

    The cases of callers that keep the default lack the parts under a condition. The other values come from
    the case that reads most of the changed files.

    Args:
        pair: both versions of the description.
        compared: the cases that show no change.
    """
    changed = {file.new_path for file in pair.versions.changed_files if file.new_path}
    if not compared:
        return
    base_case = max(
        compared, key=lambda case: len(changed & {pair.versions.new.relative(file) for file in case.new.files})
    )
    if base_case.old.expansion is None or base_case.new.expansion is None:
        return
    arguments, old_arguments = base_case.new.expansion.arguments, base_case.old.expansion.arguments
    unused = {*list_unused_arguments(base_case.old), *list_unused_arguments(base_case.new)}
    known = {name: value for name, value in arguments.items() if name in old_arguments and name not in unused}
    opposites = find_opposites(pair.versions.new, base_case.new, known)
    for name, value in list(opposites.items())[:MAX_SWITCHES]:
        new = {**base_case.models.new.values, name: value}
        values = _ArgumentValues({**base_case.models.old.values, name: value}, new, 1)
        result = _make_case(pair, _format_values(new, pair.versions.new), values)
        if isinstance(result, Case):
            yield result


def find_opposites(version: Version, description: Description, values: Mapping[str, str]) -> dict[str, str]:
    """Return the opposite values of boolean arguments, by name.

    Args:
        version: the version with the description.
        description: the description.
        values: the values of some of its arguments.
    """
    numeric = {name for name, value in values.items() if value in _NUMERIC_OPPOSITES}
    conditional = numeric and numeric & _find_arguments_in_conditions(version, description)
    opposites = {name: OPPOSITES[value] for name, value in values.items() if value in OPPOSITES}
    return opposites | {name: _NUMERIC_OPPOSITES[values[name]] for name in values if name in conditional}


def _find_arguments_in_conditions(version: Version, description: Description) -> set[str]:
    """Return the arguments that conditions name, directly or by a property."""
    values: list[str] = []
    properties: dict[str, set[str]] = {}
    for file in description.files:
        outline = try_read_outline(Path(file), version.overlay)
        for element in () if outline is None else outline.root.walk():
            if element.tag in _CONDITIONS:
                values.append(element.attributes.get("value", ""))
            elif element.tag == PROPERTY and (names := _ARGUMENT.findall(element.attributes.get("value", ""))):
                properties.setdefault(element.attributes.get("name", ""), set()).update(names)
    words = {word for value in values for word in _WORD.findall(value)}
    direct = {name for value in values for name in _ARGUMENT.findall(value)}
    return direct.union(*(names for name, names in properties.items() if name in words))


def list_unused_arguments(description: Description) -> set[str]:
    """Return the arguments that a description gets but does not use."""
    remarks = (remark for remark in description.remarks if remark.code == UNUSED_CODE)
    return {str(as_phrase(remark.message).arguments.get("name")) for remark in remarks}


def _make_case(pair: FilePair, name: str, values: _ArgumentValues) -> Case | _Failure:
    versions = pair.versions
    models = Pair(versions.old.model(pair.old_path, values.old), versions.new.model(pair.new_path, values.new))
    old, new = try_read(models.old), try_read(models.new)
    if isinstance(old, Description) and isinstance(new, Description):
        return Case(name, old, new, models)
    partial = _read_partial_pair(models)
    if partial is None:
        return _Failure(name, values, old, _read_without_packages(models, old, new) or new)
    old_error, new_error = partial.old.error, partial.new.error
    if old_error is None and new_error is None:
        pair.missing.update(dict.fromkeys(find_missing_names(partial, models.old, models.new)))
        if partial.unevaluated_names:
            pair.add_unevaluated(partial.unevaluated_names)
        return Case(name, partial.old.description, partial.new.description, models, partial)
    if old_error is None and new_error is not None and partial.has_same_omissions():
        return _Failure(name, values, partial.old.description, LinkwrightError(new_error))
    return _Failure(name, values, old, new)


def _try_values(pair: FilePair, failures: list[_Failure]) -> Generator[Case, None, list[_Failure]]:
    """Yield the description with values for missing arguments; return the other failures.

    Arguments in conditions are false, and then each in turn is true. Other arguments are empty.
    """
    values: dict[str, str] = dict(failures[0].values.new)
    tried: list[str] = []
    result: Case | _Failure = failures[0]
    while isinstance(result, _Failure) and len(values) < _MAX_CASES:
        argument = _find_missing_argument(result.new) or _find_missing_argument(result.old)
        if argument is None or argument[0] in values:
            return failures
        name, is_condition = argument
        values[name] = "false" if is_condition else ""
        tried += [name] if is_condition else []
        result = _try_case(pair, values)
    if isinstance(result, _Failure):
        return failures
    yield result
    for name in tried:
        result = _try_case(pair, {**values, name: "true"})
        if isinstance(result, Case):
            yield result
    return []


def _try_case(pair: FilePair, values: Mapping[str, str]) -> Case | _Failure:
    return _make_case(pair, _format_values(values, pair.versions.new), _ArgumentValues(values, values, 1))


def _needs_values(failure: _Failure) -> bool:
    return bool(_find_missing_argument(failure.old) and _find_missing_argument(failure.new))


def _find_missing_argument(result: Description | LinkwrightError) -> tuple[str, bool] | None:
    """Return the name of an undeclared argument, and whether a condition uses it.

    The result is None unless an undeclared argument made the description unreadable.
    """
    if isinstance(result, Description) or result.diagnostics[0].code != UNDECLARED_CODE:
        return None
    first = result.diagnostics[0]
    source, span = first.source, first.span
    line = "" if source is None or span is None else source.text.splitlines()[span.line - 1]
    is_condition = "xacro:if" in line or "xacro:unless" in line
    return str(as_phrase(first.message).arguments.get("name", "")), is_condition


def _collect_argument_sets(pair: FilePair) -> dict[str, _ArgumentValues]:
    """Return the argument sets of both versions, by name.

    The most certain sets are first, and the new version is before the old one.
    """
    sets: dict[str, _ArgumentValues] = {}
    for version, path in ((pair.versions.new, pair.new_path), (pair.versions.old, pair.old_path)):
        for called in _find_called_sets(version, path):
            values = called.values
            translated = {name: pair.versions.translate_paths(value, version) for name, value in values.items()}
            old, new = (values, translated) if version.is_old else (translated, values)
            doubt = _count_doubts(called)
            known = sets.setdefault(_format_values(new, pair.versions.new), _ArgumentValues(old, new, doubt))
            known.doubt = min(known.doubt, doubt)
            if version.is_old:
                known.is_of_old = True
            else:
                known.is_of_new = True
    return dict(sorted(_join_renamed(sets).items(), key=lambda item: item[1].doubt))


def _join_renamed(sets: Mapping[str, _ArgumentValues]) -> dict[str, _ArgumentValues]:
    """Return argument sets, with an old and a new one as one if they only differ in arguments of one version each.

    The callers then pass the new arguments in place of the old ones. Each version would ignore those of the other.
    """
    old_sets = {name: values for name, values in sets.items() if values.is_of_old and not values.is_of_new}
    new_sets = {name: values for name, values in sets.items() if values.is_of_new and not values.is_of_old}
    common = {name for values in sets.values() if values.is_of_old for name in values.new}
    common &= {name for values in sets.values() if values.is_of_new for name in values.new}
    result = dict(sets)
    for name, values in new_sets.items():
        shared = {key: value for key, value in values.new.items() if key in common}
        candidates = (
            (old_name, old)
            for old_name, old in old_sets.items()
            if {key: value for key, value in old.new.items() if key in common} == shared
            if not common >= old.new.keys() and not common >= values.new.keys()
        )
        old_name, old = next(candidates, ("", None))
        if old is not None:
            del result[old_name], old_sets[old_name]
            result[name] = _ArgumentValues(old.old, values.new, max(old.doubt, values.doubt), True, True)
    return result


def _find_called_sets(version: Version, path: str) -> list[ArgumentSet]:
    """Return the argument sets of the callers of a description, or its defaults if it has none."""
    return version.checker().argument_sets(version.file(path), ()) or [ArgumentSet({})]


def _count_doubts(called: ArgumentSet) -> int:
    """Return the number of reasons why the values may not occur together."""
    is_guess = called.is_mixed or (called.is_offered and not called.is_certain)
    is_call = called.is_complete and not called.is_offered  # an offered value may not fit the other defaults
    return (0 if is_call else 1) + len(called.runtime_names) + (_MAX_CASES if is_guess else 0)


def _format_values(values: Mapping[str, str], version: Version) -> str:
    """Return values as they are written on the command line.

    The folder of the version is removed from them.
    """
    text = " ".join(f"{name}:={value}" for name, value in sorted(values.items()))
    return text.replace(str(version.root), ".")


def try_read(model: Model) -> Description | LinkwrightError:
    """Return a description with a set of argument values, or the error that makes it unreadable."""
    try:
        return model.read()
    except LinkwrightError as error:
        return error


def _read_partial_pair(models: Pair) -> PartialPair | None:
    """Return both robots without missing packages and files, or None if they remain unreadable."""
    old, new = read_partial_robot(models.old), read_partial_robot(models.new)
    if old is None or new is None:
        return None
    partial = PartialPair(old, new)
    return partial if find_missing_names(partial, models.old, models.new) else None


def _read_without_packages(
    models: Pair, old: Description | LinkwrightError, new: Description | LinkwrightError
) -> Description | None:
    """Return the new description without packages that neither version has, if the old one fails for other reasons."""
    if isinstance(old, Description) or isinstance(new, Description) or new.diagnostics[0].code != _PACKAGE_CODE:
        return None
    partial = read_partial_robot(models.new)
    if partial is None or partial.description.robot is None or partial.omissions.files:
        return None
    is_of_both = all(models.old.finder.find(package) is None for package in partial.omissions.packages)
    return partial.description if is_of_both and old.diagnostics[0].code != _PACKAGE_CODE else None


def _report_failures(pair: FilePair, failures: list[_Failure]) -> None:
    """Report the argument sets with which a version cannot be read.

    A failure does not count with a set that no caller passes to the version, or with values that may not occur in
    combination.
    """
    names: dict[tuple[Fault | None, Fault | None], list[str]] = {}
    is_replaced = _have_other_values(pair, failures)
    for failure in failures:
        if is_replaced and not failure.values.is_of_new:
            continue  # the new callers pass other values, which fail as well
        old = None if is_replaced else find_fault(failure.old, pair.versions.old)
        new = find_fault(failure.new, pair.versions.new)
        if new is not None and pair.versions.has_added_submodule and _needs_other_files(failure.new):
            new = new._replace(is_certain=False)  # the submodule may have them
        if old is not None and failure.values.doubt and (pair.cases or failure is not failures[0]):
            continue
        if old is not None and new is not None and pair.cases and not failure.values.new:
            continue  # callers pass the values without which the description cannot be read
        if old is None and new is not None and not failure.values.is_of_new:
            pair.add_unreadable(pair.versions.new, new)
        elif old is None or new is not None or failure.values.is_of_old:
            names.setdefault((old, new), []).append(failure.name)
        elif not pair.cases:
            pair.add_unreadable(pair.versions.old, old)
    for (old, new), cases_of_fault in names.items():
        is_told = bool(pair.cases) or is_replaced
        callers = _find_callers(pair.versions.new, pair.new_path, cases_of_fault) if new and is_told else ()
        pair.add_faults(old, new, tuple(cases_of_fault) if is_told or len(names) > 1 else (), callers)
        if new is None:
            _report_contents(pair, next(failure.new for failure in failures if failure.name == cases_of_fault[0]))
    changed = (names_of_fault for faults, names_of_fault in names.items() if None in faults)
    pair.cases += (name for names_of_fault in changed for name in names_of_fault)


def _have_other_values(pair: FilePair, failures: Sequence[_Failure]) -> bool:
    """Return whether the callers of the new version pass other values than before, with all of which it fails.

    The old version could be read with the values that its callers passed. A missing package is not a certain failure.
    """
    old = [failure for failure in failures if failure.values.is_of_old]
    new = [failure for failure in failures if failure.values.is_of_new]
    was_read = bool(old) and all(isinstance(failure.old, Description) for failure in old)
    is_certain = not pair.cases and not any(failure.values.is_of_old for failure in new)
    errors = [item.new for item in new if isinstance(item.new, LinkwrightError)]
    is_lost = len(errors) == len(new) > 0 and all(error.diagnostics[0].code != _PACKAGE_CODE for error in errors)
    return is_certain and was_read and is_lost


def _needs_other_files(result: Description | LinkwrightError) -> bool:
    return isinstance(result, LinkwrightError) and result.diagnostics[0].code in _MISSING_CODES


def _find_callers(version: Version, path: str, cases: Sequence[str]) -> list[str]:
    """Return the files that call a description with one of the sets of values."""
    spans = (
        called.span for called in _find_called_sets(version, path) if _format_values(called.values, version) in cases
    )
    callers = (version.relative(span.file) for span in spans if span is not None)
    return list(dict.fromkeys(caller for caller in callers if caller is not None))


def _report_contents(pair: FilePair, description: Description | LinkwrightError) -> None:
    """Report the parts of a robot whose description only the new version can read."""
    if isinstance(description, Description) and description.robot is not None:
        pair.changes.append(Change(format_robot(description.robot)))


def find_fault(result: Description | LinkwrightError, version: Version) -> Fault | None:
    """Return the fault that makes a version unreadable, or None if it can be read."""
    if isinstance(result, Description):
        return None
    errors = (item for item in result.diagnostics if item.severity is Severity.ERROR)
    first = next(errors, result.diagnostics[0])  # warnings about arguments may precede it
    reason = without_folder(first.message, version.root)
    if first.span is None:
        return Fault(reason)
    return Fault(reason, version.path_of_label(first.span.file), first.span.line, first.span.column)
