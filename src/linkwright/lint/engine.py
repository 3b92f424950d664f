"""The check of one description: reading, running the rules, and sorting the findings."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.descriptions import Description, Packages, examine_world, is_world
from linkwright.descriptions import examine as examine_description
from linkwright.descriptions.service import HOLDS_FOR_PARTS
from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, counted, phrase
from linkwright.diagnostics.diagnostic import TEXT_NAME, is_text
from linkwright.diagnostics.phrase import as_phrase
from linkwright.lint.finding import Finding
from linkwright.lint.missing_files import with_file_severity
from linkwright.lint.missing_packages import with_package_severity
from linkwright.lint.registry import (
    find_rule,
    find_unusable_rules,
    has_external_rules,
    is_external,
    make_failed_rule_finding,
    rules_of,
)
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.settings import Settings
from linkwright.lint.subject import Subject
from linkwright.lint.suppression import Suppressions
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import MANIFEST
from linkwright.urdf import Reading, Robot
from linkwright.xmltree import Document, Element, Overlay

if TYPE_CHECKING:
    from linkwright.lint.contexts import Contexts
    from linkwright.sdf.worlds import Sdf


_PREFIX_MISSING_CODE, _NO_LINKS_CODE = "LW720", "URDF106"
_NO_PACKAGE_CODE, _NO_MESH_PACKAGE_CODE = "PKG101", "LW423"
_SDF_TEXT = lazy_pattern(r"(?:\s|<\?.*?\?>|<!--.*?-->)*<sdf\b", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Checked:
    """The result of checking a file.

    Attributes:
        path: the file.
        robot: the robot, or None if the file does not describe one.
        diagnostics: all findings in source order; the findings of rules are instances of `Finding`.
        subject: the subject of the rules, or None if the file could not be read or expanded.
        sdf: the world or model of an SDF file with its includes; None for other files, and for a file that is not valid
            SDF.
    """

    path: Path
    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]
    subject: Subject | None
    sdf: Sdf | None = None


def check(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
    settings: Settings | None = None,
) -> list[Diagnostic]:
    """Return all findings about a URDF, xacro or SDF file or text, in source order.

    Args:
        path_or_text: the path of a file, or a text, which is recognized by its ``<``.
        arguments: values for the file's ``<xacro:arg>``.
        packages: the packages, as a mapping of names to share folders, or a finder.
        settings: the settings, which select the rules. The default is the nearest ``linkwright.toml`` or
            ``pyproject.toml`` above the file or, for a text, above the current folder.
    """
    return list(examine(path_or_text, arguments=arguments, packages=packages, settings=settings).diagnostics)


def examine(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
    settings: Settings | None = None,
    overlay: Overlay | None = None,
    scopes: Collection[Scope] = (Scope.DESCRIPTION, Scope.PACKAGE),
    xacro: bool | None = None,
    contexts: Contexts | None = None,
) -> Checked:
    """Check a URDF, xacro or SDF file or text.

    Args:
        path_or_text: see `check`.
        arguments: see `check`.
        packages: see `check`.
        settings: see `check`.
        overlay: texts that replace the contents of files, such as unsaved texts.
        scopes: the scopes of the rules to run.
        xacro: whether to expand the description; None to decide by the file.
        contexts: data that checks share during one run.
    """
    text = str(path_or_text) if is_text(path_or_text) else None
    path = Path(path_or_text) if text is None else Path(TEXT_NAME)
    settings_findings: tuple[Diagnostic, ...] = ()
    if settings is None:
        from linkwright.lint.configuration import find_settings

        settings, settings_findings = find_settings(path)
    settings_findings = (*find_unusable_rules(), *settings_findings)
    finder = _make_package_finder(path, packages)
    if text is not None:
        overlay = Overlay({path: text})
    if is_world(str(path)) or (text is not None and _SDF_TEXT.match(text)):
        return _examine_world(path, arguments, finder, settings, settings_findings, overlay)
    try:
        description = examine_description(
            path, arguments=arguments, packages=finder, overlay=overlay, xacro=xacro, partly=True
        )
    except LinkwrightError as error:
        return Checked(path, None, (*settings_findings, *with_configured_severity(error.diagnostics, settings)), None)
    subject = Subject(description, finder, settings, contexts)
    findings = _find_all(
        subject, scopes, _find_library_findings(description) if subject.is_library else description.diagnostics
    )
    return Checked(path, subject.robot, (*settings_findings, *findings), subject)


def _examine_world(
    path: Path,
    arguments: Mapping[str, str] | None,
    finder: PackageFinder,
    settings: Settings,
    settings_findings: tuple[Diagnostic, ...],
    overlay: Overlay | None,
) -> Checked:
    try:
        world = examine_world(path, arguments=arguments, packages=finder, overlay=overlay)
    except LinkwrightError as error:
        return Checked(path, None, (*settings_findings, *with_configured_severity(error.diagnostics, settings)), None)
    findings = list(world.diagnostics)
    if world.sdf is not None:
        from linkwright.lint.worlds import adapt_to_classic, check_sdf, merge_missing_resources
        from linkwright.sdf.resources import ResourceFinder

        findings = [*adapt_to_classic([*findings, *check_sdf(world.sdf, ResourceFinder(finder))], path)]
        findings = merge_missing_resources(findings)
    diagnostics = sort_by_location(with_configured_severity(findings, settings), str(path))
    return Checked(path, None, (*settings_findings, *diagnostics), None, world.sdf)


def _find_all(subject: Subject, scopes: Collection[Scope], earlier: Iterable[Diagnostic] = ()) -> list[Diagnostic]:
    """Return all findings in source order, filtered by settings and suppression comments.

    The result contains the `earlier` findings and the findings of the rules.
    """
    suppressions = Suppressions(subject, subject.settings)
    findings = _without_replaced([*earlier, *_find_with_rules(subject, scopes, suppressions)], scopes, subject.settings)
    selected_findings = _without_consequences(with_configured_severity(suppressions.apply(findings), subject.settings))
    return sort_by_location(selected_findings, str(subject.path))


def _find_with_rules(subject: Subject, scopes: Collection[Scope], suppressions: Suppressions) -> list[Diagnostic]:
    """Return the findings of the rules, one for each rule and location.

    Findings of unselected rules are included if they show whether a suppression comment is used.
    """
    cache = {} if has_external_rules() else subject.once(_make_findings_cache)
    key = frozenset(scopes)
    if key not in cache:
        cache[key] = _run_rules(subject, scopes, suppressions)
    return cache[key]


def _make_findings_cache(_: Subject) -> dict[frozenset[Scope], list[Diagnostic]]:
    """Return a new cache of findings by scopes, for all subjects with the same expansion."""
    return {}


def _run_rules(subject: Subject, scopes: Collection[Scope], suppressions: Suppressions) -> list[Diagnostic]:
    findings: list[Diagnostic] = []
    for rule in rules_of(scopes):
        if not (subject.settings.runs(rule) or suppressions.needs_findings_of(rule.code)):
            continue
        if not _may_run(rule, subject):
            continue
        findings += map(_add_trail, _run_rule(rule, subject))
    mesh_findings = subject.meshes.unread.diagnostics if subject.meshes.unread else ()
    return [
        *_without_repetitions(findings),
        *(diagnostic.with_changes(severity=Severity.INFO) for diagnostic in mesh_findings),
    ]


def _run_rule(rule: Rule, subject: Subject) -> Sequence[Diagnostic]:
    """Return the findings of a rule.

    If a rule of another package raises an exception, the only finding is about this failure.
    """
    try:
        findings = tuple(_check_with_cache(rule, subject))
        _check_codes(rule, findings)
    except Exception as error:
        if is_external(rule):
            return (make_failed_rule_finding(rule, error),)
        raise
    return findings


def _check_codes(rule: Rule, findings: Iterable[Diagnostic]) -> None:
    for diagnostic in findings:
        if diagnostic.code != rule.code:
            raise ValueError(f"{rule.code} reported a finding of {diagnostic.code}")


def _check_with_cache(rule: Rule, subject: Subject) -> Iterable[Diagnostic]:
    if not rule.of_sources or subject.expansion is None:
        return rule.check(subject)
    stored_findings = subject.xacro.stored_findings
    if rule.code not in stored_findings:
        stored_findings[rule.code] = tuple(rule.check(subject))
    return stored_findings[rule.code]


def _may_run(rule: Rule, subject: Subject) -> bool:
    """Return whether a rule applies to a subject.

    Rules about packages apply to a description in a package. Most other rules apply neither to a description with
    missing parts nor to a file that only has parts for other files.
    """
    if rule.scope is Scope.PACKAGE:
        return subject.package is not None
    if rule.holds_for_parts:
        return True
    return subject.is_whole and (rule.holds_for_libraries or not subject.is_library)


def _find_library_findings(description: Description) -> Iterator[Diagnostic]:
    """Yield the findings on a file that only has parts for other files to include.

    These are the findings that hold for single parts, and a note that the file is not a robot by itself.
    """
    yield from (*description.problems, *description.remarks)
    root = description.document.root
    root_span = root.span()
    yield from (
        diagnostic
        for diagnostic in description.reading.diagnostics
        if diagnostic.code in HOLDS_FOR_PARTS and diagnostic.span != root_span
    )
    hint = phrase("check the file that includes it")
    message = phrase("this file only defines parts for other files, and is not a robot by itself")
    yield Diagnostic("LINT302", message, root_span, Severity.INFO, hint=hint, source=root.source)


def sort_by_location(diagnostics: Iterable[Diagnostic], first_file: str) -> list[Diagnostic]:
    """Return diagnostics sorted by location.

    Diagnostics without a location come first, then `first_file`. The other files follow in the order of their
    first diagnostics.
    """
    files = {first_file: 0}

    def sort_key(diagnostic: Diagnostic) -> tuple[int, int, int]:
        span = diagnostic.span
        if span is None:
            return -1, 0, 0
        return files.setdefault(span.file, len(files)), span.line, span.column

    return sorted(diagnostics, key=sort_key)


def examine_package(
    folder: Path,
    settings: Settings,
    finder: PackageFinder | None = None,
    overlay: Overlay | None = None,
    contexts: Contexts | None = None,
) -> Checked:
    """Check a package without its descriptions.

    The rules receive the manifest as the file, and an empty description.

    Args:
        folder: the folder of the package.
        settings: the settings for the package.
        finder: the finder of packages.
        overlay: texts that replace the contents of files.
        contexts: data that checks share during one run.
    """
    path = folder / MANIFEST
    document = Document(Element("robot", {"name": folder.name}))
    description = Description(str(path), document, Reading(None, ()), overlay=overlay)
    subject = Subject(description, finder or _make_package_finder(path, None), settings, contexts)
    return Checked(path, None, tuple(_find_all(subject, (Scope.PACKAGE,))), subject)


def _make_package_finder(path: Path, packages: Packages) -> PackageFinder:
    if isinstance(packages, PackageFinder):
        return packages
    return PackageFinder(start=[path.absolute().parent, Path.cwd()], extra=packages)


def with_configured_severity(diagnostics: Iterable[Diagnostic], settings: Settings) -> Iterator[Diagnostic]:
    """Yield the diagnostics that the settings select, with the configured severities."""
    for diagnostic in with_file_severity(with_package_severity(diagnostics)):
        if _is_selected(diagnostic, settings):
            severity = settings.severity_of(diagnostic.code, diagnostic.severity)
            yield diagnostic if severity is diagnostic.severity else diagnostic.with_changes(severity=severity)


def _is_selected(diagnostic: Diagnostic, settings: Settings) -> bool:
    """Return whether the settings select a diagnostic.

    An error of the reader or of xacro is reported unless it is ignored, because it explains why there is no robot.
    """
    rule = find_rule(diagnostic.code)
    if rule is not None:
        selected = settings.runs(rule)
    elif diagnostic.severity is Severity.ERROR:
        selected = not settings.is_ignored(diagnostic.code)
    else:
        selected = settings.selects(diagnostic.code)
    return selected and not (diagnostic.span and settings.ignores(diagnostic.code, diagnostic.span.file))


def _without_replaced(diagnostics: list[Diagnostic], scopes: Collection[Scope], settings: Settings) -> list[Diagnostic]:
    """Return the diagnostics that no better diagnostic at the same location replaces."""
    replacing_codes: dict[str, set[str]] = {}
    for rule in rules_of(scopes):
        if rule.replaces and settings.runs(rule):
            for code in rule.replaces:
                replacing_codes.setdefault(code, set()).add(rule.code)
    locations = {(diagnostic.code, diagnostic.span) for diagnostic in diagnostics}
    return [
        diagnostic
        for diagnostic in diagnostics
        if not any((code, diagnostic.span) in locations for code in replacing_codes.get(diagnostic.code, ()))
    ]


def _without_consequences(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics that do not follow from another diagnostic.

    If tags lack the xacro prefix, the links that they should create are missing. If an include does not find a package,
    the meshes of this package are also missing.
    """
    findings = list(diagnostics)
    lacks_prefix = any(diagnostic.code == _PREFIX_MISSING_CODE for diagnostic in findings)
    missing_packages = {
        as_phrase(finding.message).arguments.get("name") for finding in findings if finding.code == _NO_PACKAGE_CODE
    }

    def is_consequence(finding: Diagnostic) -> bool:
        if finding.code == _NO_MESH_PACKAGE_CODE:
            return as_phrase(finding.message).arguments.get("package") in missing_packages
        return lacks_prefix and finding.code == _NO_LINKS_CODE

    return [finding for finding in findings if not is_consequence(finding)]


def _add_trail(diagnostic: Diagnostic) -> Diagnostic:
    """Return a finding with notes on the macro calls and includes that produced its element.

    A diagnostic without an element is returned unchanged.
    """
    if not isinstance(diagnostic, Finding) or diagnostic.element is None or diagnostic.element.origin is None:
        return diagnostic
    from linkwright.xacro.faults import origin_of

    trail = origin_of(diagnostic.element).trail
    return diagnostic.with_changes(notes=(*diagnostic.notes, *trail))


def _without_repetitions(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return one finding for each rule and location.

    A macro is written once, but may be called several times. The first finding at a location gets a note with the
    number of the others.
    """
    first_indexes: dict[tuple[str, object, str], int] = {}
    findings: list[Diagnostic] = []
    repetitions: dict[int, int] = {}
    for diagnostic in diagnostics:
        # Findings without an element have no trail of calls, so different messages are different findings.
        is_expanded = isinstance(diagnostic, Finding) and diagnostic.element is not None
        key = (diagnostic.code, diagnostic.span, "" if is_expanded else diagnostic.message)
        if diagnostic.span is None or key not in first_indexes:
            first_indexes[key] = len(findings)
            findings.append(diagnostic)
        else:
            repetitions[first_indexes[key]] = repetitions.get(first_indexes[key], 0) + 1
    for index, count in repetitions.items():
        note = Note(
            counted(
                "this finding occurs here once more, through other macro calls or includes",
                "this finding occurs here {count} more times, through other macro calls or includes",
                count,
            )
        )
        findings[index] = findings[index].with_changes(notes=(*findings[index].notes, note))
    return findings
