"""Checking one description: read it, run the rules, put everything in order."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity
from linkwright.lint.finding import Finding
from linkwright.lint.registry import all_rules
from linkwright.lint.rule import Scope
from linkwright.lint.settings import Settings
from linkwright.lint.subject import Subject
from linkwright.lint.suppression import Suppressions
from linkwright.urdf import Reading, Robot, read
from linkwright.urdf.library import Packages
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.workspace import PackageFinder
from linkwright.workspace.manifest import MANIFEST
from linkwright.xmltree import Document, Element
from linkwright.xmltree.reader import read_bytes


@dataclass(frozen=True, slots=True)
class Checked:
    """What came of checking a file.

    Attributes:
        path: the file.
        robot: the robot, or None when there is none.
        diagnostics: everything found, in the order of the text; those of rules are `Finding`.
        subject: what the rules looked at; None when the file could not be read or expanded.
    """

    path: Path
    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]
    subject: Subject | None


def check(
    path: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
    settings: Settings | None = None,
) -> list[Diagnostic]:
    """Everything there is to say about a URDF or xacro file, in the order of the text.

    Args:
        path: the file.
        arguments: values for the file's ``<xacro:arg>``.
        packages: where packages are: package name -> share folder, or a finder.
        settings: which rules run; by default those of the ``linkwright.toml`` or ``pyproject.toml`` found upwards from
            the file.
    """
    return list(examine(path, arguments=arguments, packages=packages, settings=settings).diagnostics)


def examine(
    path: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
    settings: Settings | None = None,
    text: str | None = None,
    scopes: Collection[Scope] = (Scope.DESCRIPTION, Scope.PACKAGE),
) -> Checked:
    """Check a URDF or xacro file; arguments as for `check`.

    Args:
        path: the file.
        arguments: see `check`.
        packages: see `check`.
        settings: see `check`.
        text: the text to take for that of the file.
        scopes: the rules to run.
    """
    path = Path(path)
    trouble: tuple[Diagnostic, ...] = ()
    if settings is None:
        from linkwright.lint.configuration import settings_for

        settings, trouble = settings_for(path)
    finder = _finder(path, packages)
    try:
        subject = _subject(path, arguments, finder, settings, text)
    except LinkwrightError as error:
        return Checked(path, None, (*trouble, *error.diagnostics), None)
    read_so_far = (*(subject.expansion.diagnostics if subject.expansion else ()), *subject.reading.diagnostics)
    by_rules = run_rules(subject, scopes)
    found = _without_replaced([*_adjusted(read_so_far, settings), *by_rules])
    kept = Suppressions(subject, settings).apply(found)
    return Checked(path, subject.robot, (*trouble, *in_order(kept, str(path))), subject)


def run_rules(subject: Subject, scopes: Collection[Scope]) -> list[Diagnostic]:
    """What the rules find that are in force for a subject; not yet in order, with suppressed ones among them."""
    settings = subject.settings
    found: list[Diagnostic] = []
    for rule in all_rules():
        if rule.scope not in scopes or not settings.runs(rule):
            continue
        for diagnostic in rule.check(subject):
            if diagnostic.code != rule.code:
                raise ValueError(f"{rule.code} reported a finding of {diagnostic.code}")
            found.append(_with_trail(diagnostic))
    return _adjusted(_without_repetitions(found), settings)


def in_order(diagnostics: Iterable[Diagnostic], first_file: str) -> list[Diagnostic]:
    """Diagnostics by place: the checked file first, others in the order in which they were met."""
    files = {first_file: 0}

    def place(diagnostic: Diagnostic) -> tuple[int, int, int]:
        span = diagnostic.span
        if span is None:
            return -1, 0, 0
        return files.setdefault(span.file, len(files)), span.line, span.column

    return sorted(diagnostics, key=place)


def _subject(
    path: Path, arguments: Mapping[str, str] | None, finder: PackageFinder, settings: Settings, text: str | None
) -> Subject:
    name = str(path)
    document = parse_as_urdfdom(read_bytes(path) if text is None else text, name)
    expansion = None
    if arguments or name.endswith(".xacro") or is_xacro(document.root):
        from linkwright.xacro import expand

        expansion = expand(name, arguments, packages=finder, text=text)
        document = expansion.document
    return Subject(path, document, read(document), expansion=expansion, finder=finder, settings=settings)


def is_xacro(root: Element) -> bool:
    """Whether a document is to be expanded: it declares the prefix of xacro."""
    return "xmlns:xacro" in root.attributes or root.tag.startswith("xacro:")


def examine_package(folder: Path, settings: Settings, finder: PackageFinder | None = None) -> Checked:
    """Check a package by itself; for its rules the file is the manifest and the description an empty one."""
    path = folder / MANIFEST
    document = Document(Element("robot", {"name": folder.name}))
    subject = Subject(
        path,
        document,
        Reading(None, ()),
        expansion=None,
        finder=finder or _finder(path, None),
        settings=settings,
    )
    kept = Suppressions(subject, settings).apply(run_rules(subject, (Scope.PACKAGE,)))
    return Checked(path, None, tuple(in_order(kept, str(path))), subject)


def _finder(path: Path, packages: Packages) -> PackageFinder:
    if isinstance(packages, PackageFinder):
        return packages
    return PackageFinder(start=[path.absolute().parent, Path.cwd()], extra=packages)


def _adjusted(diagnostics: Iterable[Diagnostic], settings: Settings) -> list[Diagnostic]:
    """Diagnostics with the severities of the settings, without those that the settings leave out.

    An error of the reader or of xacro stays: without it nothing would tell why there is no robot.
    """
    kept = []
    for diagnostic in diagnostics:
        is_finding = isinstance(diagnostic, Finding)
        if is_finding or diagnostic.severity is not Severity.ERROR:
            if not is_finding and not settings.selects(diagnostic.code):
                continue
            if diagnostic.span and settings.ignores(diagnostic.code, diagnostic.span.file):
                continue
            severity = settings.severity_of(diagnostic.code, diagnostic.severity)
            if severity is not diagnostic.severity:
                diagnostic = replace(diagnostic, severity=severity)
        kept.append(diagnostic)
    return kept


def _without_replaced(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics but those for which a rule found something better at the same place."""
    better: dict[str, set[str]] = {}
    for rule in all_rules():
        for code in rule.replaces:
            better.setdefault(code, set()).add(rule.code)
    places = {(each.code, each.span) for each in diagnostics}
    return [each for each in diagnostics if not any((code, each.span) in places for code in better.get(each.code, ()))]


def _with_trail(diagnostic: Diagnostic) -> Diagnostic:
    """A finding with the macro calls and includes that produced its element."""
    if not isinstance(diagnostic, Finding) or diagnostic.element is None or diagnostic.element.origin is None:
        return diagnostic
    from linkwright.xacro.origin import origin_of

    trail = origin_of(diagnostic.element).trail
    return replace(diagnostic, notes=(*diagnostic.notes, *trail))


def _without_repetitions(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """One finding for each rule and place: a macro that is called four times is written once."""
    first: dict[tuple[str, object, str], int] = {}
    kept: list[Diagnostic] = []
    more: dict[int, int] = {}
    for diagnostic in diagnostics:
        # Without an element there are no calls that lead to it: another message is another finding.
        is_expanded = isinstance(diagnostic, Finding) and diagnostic.element is not None
        key = (diagnostic.code, diagnostic.span, "" if is_expanded else diagnostic.message)
        if diagnostic.span is None or key not in first:
            first[key] = len(kept)
            kept.append(diagnostic)
        else:
            more[first[key]] = more.get(first[key], 0) + 1
    for index, count in more.items():
        what = "once more" if count == 1 else f"{count} more times"
        note = Note(f"the same place is found wrong {what}, through other macro calls or includes")
        kept[index] = replace(kept[index], notes=(*kept[index].notes, note))
    return kept
