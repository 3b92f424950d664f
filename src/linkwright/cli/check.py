"""``linkwright check``: check robots and worlds, and print their contents and the findings."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import SimpleNamespace

from linkwright.cli.endings import print_message
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Severity,
    Span,
    counted,
    has_errors,
    phrase,
    print_diagnostics,
)
from linkwright.diagnostics.alike import group_similar
from linkwright.diagnostics.formats import FORMATS, format_diagnostics
from linkwright.diagnostics.translation import localized
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import TYPE_CHECKING, Any, TypeAlias
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    import argparse

    from linkwright.descriptions.argument_sets import ArgumentSet, ArgumentSets
    from linkwright.lint.apply import FixResult
    from linkwright.lint.contexts import Contexts
    from linkwright.lint.engine import Checked
    from linkwright.lint.settings import Settings
    from linkwright.lint.targets import Targets
    from linkwright.packages import PackageFinder


_USAGE = 2
_DEFAULTS: dict[str, Any] = {
    "all": False,
    "config": None,
    "diff": False,
    "fix": False,
    "format": "text",
    "ignore": None,
    "package": False,
    "select": None,
    "statistics": False,
    "strict": False,
    "unsafe_fixes": False,
}
"""The values of options that are not given."""
_Found: TypeAlias = "dict[tuple[str, Span | None, str], Diagnostic]"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "words",
        metavar="FILE|FOLDER|NAME:=VALUE",
        nargs="+",
        help="URDF, xacro and SDF files, folders to search for descriptions, worlds and packages, and values "
        "for the files' <xacro:arg>",
    )
    parser.add_argument(
        "--package",
        action="store_true",
        help="also check the packages that contain the files, as for folders",
    )
    parser.add_argument("--all", action="store_true", help="print every finding, not only the first of similar ones")
    parser.add_argument("--format", choices=FORMATS, help="the output format (default: text)")
    parser.add_argument("--strict", action="store_true", help="exit with status 1 for warnings too")
    parser.add_argument(
        "--select", metavar="RULES", action="append", help="report only these rules, such as LW2,axis-zero"
    )
    parser.add_argument("--ignore", metavar="RULES", action="append", help="do not report these rules")
    parser.add_argument(
        "--config", metavar="FILE", help="the settings file to use instead of the nearest linkwright.toml"
    )
    parser.add_argument("--statistics", action="store_true", help="print the number of findings for each code")
    parser.add_argument("--fix", action="store_true", help="apply safe fixes to the files")
    parser.add_argument("--unsafe-fixes", action="store_true", help="also apply fixes that may change the meaning")
    parser.add_argument("--diff", action="store_true", help="print the changes of the fixes without writing them")
    parser.set_defaults(**_DEFAULTS)


def without_options(words: list[str]) -> SimpleNamespace | None:
    """Return the arguments of a command line that has only files, folders and values.

    The result is None if it has none of them.
    """
    return SimpleNamespace(words=words, **_DEFAULTS) if words else None


def run(arguments: argparse.Namespace | SimpleNamespace) -> int:
    """Check the files.

    The tree and machine-readable findings are written to standard output, text to standard error.
    """
    paths = [Path(word) for word in arguments.words if ":=" not in word]
    if not paths:
        return _usage("name a file or folder to check")
    words = _Words(
        parse_assignments(word for word in arguments.words if ":=" in word),
        None if arguments.select is None else _listed(arguments.select),
        _listed(arguments.ignore or ()),
        None if arguments.config is None else Path(arguments.config),
        arguments.package,
        tuple(path.absolute() for path in paths if path.is_dir()),
    )
    unknown = words.unknown_selector()
    if unknown:
        return _usage(unknown)
    if arguments.config is not None and not Path(arguments.config).is_file():
        return _usage(phrase("no such file: '{config}'", config=arguments.config))
    if arguments.diff:
        return _print_diff(paths, words, unsafe=arguments.unsafe_fixes)
    fixed: list[FixResult] = []
    if arguments.fix or arguments.unsafe_fixes:
        fixed = _fix(paths, words, unsafe=arguments.unsafe_fixes, write=True)
    found, checked = _check(paths, words)
    _print(found, arguments.format, everything=arguments.all)
    if arguments.format == "text":
        if checked is not None:
            sys.stdout.write(_contents(checked))
        _summarise(found, fixed)
    if arguments.statistics:
        _print_statistics(found)
    failed = has_errors(found) or (
        arguments.strict and any(diagnostic.severity is Severity.WARNING for diagnostic in found)
    )
    return 1 if failed else 0


@dataclass(frozen=True, slots=True)
class _Words:
    """The settings from the command line, which apply to every file.

    `folders` are the folders to check.
    """

    values: dict[str, str]
    select: tuple[str, ...] | None
    ignore: tuple[str, ...]
    config: Path | None
    package: bool
    folders: tuple[Path, ...]
    finders: dict[Path, PackageFinder] = field(default_factory=dict)
    callers: list[ArgumentSets] = field(default_factory=list)

    def finder(self, file: Path) -> PackageFinder:
        """Return the package finder for a file.

        There is one finder per folder, and all of them share a single search of each source tree.
        """
        from linkwright.packages import PackageFinder

        folder = file.absolute().parent
        if folder not in self.finders:
            start = [folder, *self.folders, Path.cwd()]
            first = next(iter(self.finders.values()), None)
            self.finders[folder] = first.starting_at(start) if first else PackageFinder(start=start, sources_first=True)
        return self.finders[folder]

    def sets(self, file: Path, packages: Sequence[Path]) -> tuple[ArgumentSet, ...]:
        """Return the values that callers give to a file's arguments.

        The callers are read only once for all files.
        """
        from linkwright.descriptions.argument_sets import ArgumentSets

        if not self.callers:
            self.callers.append(ArgumentSets(packages))
        return self.callers[0].of(file, self.finder(file))

    def unknown_selector(self) -> str | None:
        """Return the finding about a selector that selects nothing, or None."""
        from linkwright.lint.selector_words import is_selector, selector_hint

        for word in (*(self.select or ()), *self.ignore):
            if not is_selector(word):
                return f"there is no rule '{word}'; {selector_hint(word)}"
        return None

    def settings(self, path: Path) -> tuple[Settings, tuple[Diagnostic, ...]]:
        """Return the settings for a file or folder, with the findings about their text."""
        from linkwright.lint.configuration import read_settings, settings_for
        from linkwright.lint.selector_words import canonical

        settings, trouble = settings_for(path) if self.config is None else read_settings(self.config)
        select = None if self.select is None else tuple(map(canonical, self.select))
        return settings.with_words(select, tuple(map(canonical, self.ignore))), trouble


def _contents(checked: Checked) -> str:
    """Return a summary of a file: the tree of a robot's links, or the models in a world."""
    if checked.robot is not None:
        from linkwright.urdf import tree_text

        return tree_text(checked.robot)
    if checked.sdf is not None:
        from linkwright.sdf.listing import sdf_text

        return sdf_text(checked.sdf)
    return ""


def _check(paths: Sequence[Path], words: _Words) -> tuple[list[Diagnostic], Checked | None]:
    """Return all findings without duplicates, and the result of the file if only one was named."""
    from linkwright.lint.contexts import Contexts
    from linkwright.lint.engine import examine_package
    from linkwright.lint.folders import Examined, reported, reported_of_package
    from linkwright.lint.targets import find_targets
    from linkwright.packages.manifest import MANIFEST

    targets = find_targets(paths, around=words.package)
    if not targets.files and not targets.packages:
        named = ", ".join(f"'{path}'" for path in paths)
        hint = phrase(
            "descriptions are .urdf, .sdf and .world files, and .xacro files with <robot name=...> that no other file"
            " includes"
        )
        raise LinkwrightError(
            Diagnostic("CLI302", phrase("there is nothing to check in {named}", named=named), hint=hint)
        )
    found: _Found = {}
    checked = None
    examined: list[Examined] = []
    of_settings: list[tuple[Diagnostic, ...]] = []
    contexts = Contexts()
    for file in targets.files:
        checked, trouble = _examine(file, words, targets, contexts=contexts)
        examined.append(Examined.of(checked, file))
        of_settings.append(trouble)
    for result, trouble in zip(examined, of_settings, strict=True):
        _add(found, (*trouble, *reported(result, examined, targets, paths)))
    for folder in targets.packages:
        settings, trouble = words.settings(folder)
        diagnostics = examine_package(folder, settings, words.finder(folder / MANIFEST), contexts=contexts).diagnostics
        _add(found, (*trouble, *reported_of_package(diagnostics, paths)))
    return list(found.values()), checked if len(paths) == 1 and not paths[0].is_dir() else None


def _add(found: _Found, more: Iterable[Diagnostic]) -> None:
    """Add the findings that are new; a file that two robots include has the same findings twice."""
    from linkwright.lint.finding import without_element

    for diagnostic in more:
        key = (diagnostic.code, _place(diagnostic), diagnostic.message)
        if key not in found:
            found[key] = without_element(diagnostic)


def _place(diagnostic: Diagnostic) -> Span | None:
    """Return the location of a finding, whether its file was named or included."""
    from linkwright.lint.folders import MISSING_PACKAGE

    span = diagnostic.span
    if span is None or diagnostic.code == MISSING_PACKAGE:
        return None  # one fix is enough, however many files name it
    return span._replace(file=str(Path(span.file).resolve()))


def _examine(
    file: Path, words: _Words, targets: Targets, text: str | None = None, contexts: Contexts | None = None
) -> tuple[Checked, tuple[Diagnostic, ...]]:
    """Check a file with the arguments of the command line, or else with the arguments of its callers."""
    from linkwright.lint.argument_sets import SetCheck
    from linkwright.lint.engine import examine
    from linkwright.lint.rule import Scope
    from linkwright.xmltree import Overlay

    settings, trouble = words.settings(file)
    finder = words.finder(file)

    def with_values(values: Mapping[str, str], xacro: bool | None = None) -> Checked:
        return examine(
            file,
            arguments=values,
            packages=finder,
            settings=settings,
            overlay=None if text is None else Overlay({file: text}),
            scopes=(Scope.DESCRIPTION,),
            xacro=xacro,
            contexts=contexts,
        )

    if words.values:
        return with_values(words.values), trouble
    check = SetCheck(file, finder, settings, with_values, is_named=file in targets.named)
    configured = settings.arguments_of(file)
    if configured:
        return check.with_configured(configured), trouble
    return check.with_callers(lambda: words.sets(file, targets.packages)), trouble


def _fix(paths: Sequence[Path], words: _Words, *, unsafe: bool, write: bool) -> list[FixResult]:
    from linkwright.lint.apply import fix_file
    from linkwright.lint.engine import examine_package
    from linkwright.lint.targets import find_targets
    from linkwright.packages.manifest import MANIFEST
    from linkwright.xmltree import Overlay

    def file_again(file: Path, text: str | None) -> Iterable[Diagnostic]:
        return _examine(file, words, targets, text)[0].diagnostics

    def package_again(folder: Path, text: str | None) -> Iterable[Diagnostic]:
        overlay = None if text is None else Overlay({folder / MANIFEST: text})
        finder = words.finder(folder / MANIFEST)
        return examine_package(folder, words.settings(folder)[0], finder, overlay).diagnostics

    targets = find_targets(paths, around=words.package)
    checks = [(file, partial(file_again, file)) for file in targets.files]
    checks += [(folder / MANIFEST, partial(package_again, folder)) for folder in targets.packages]
    return [fix_file(path, check, unsafe=unsafe, write=write) for path, check in checks]


def _print_diff(paths: Sequence[Path], words: _Words, *, unsafe: bool) -> int:
    fixed = _fix(paths, words, unsafe=unsafe, write=False)
    seen: set[str] = set()
    for fixes in fixed:
        fixes.texts = {file: text for file, text in fixes.texts.items() if file not in seen}
        seen.update(fixes.texts)
        sys.stdout.write(fixes.diff())
    return 1 if seen else 0


def _print(found: Sequence[Diagnostic], form: str, *, everything: bool) -> None:
    if form == "text":
        with suppress(OSError):  # as in `print_message`
            print_diagnostics(found if everything else group_similar(found), sys.stderr)
    else:
        sys.stdout.write(format_diagnostics(found, form))


def _summarise(found: Sequence[Diagnostic], fixed: Sequence[FixResult]) -> None:
    if fixed:
        count = sum(sum(fix_result.counts.values()) for fix_result in fixed)
        files = len({file for fix_result in fixed for file in fix_result.texts})
        line = phrase(
            "fixed {findings} in {files}",
            findings=counted("{count} finding", "{count} findings", count),
            files=counted("{count} file", "{count} files", files),
        )
        print_message(localized(line))
    errors = sum(diagnostic.severity is Severity.ERROR for diagnostic in found)
    warnings = sum(diagnostic.severity is Severity.WARNING for diagnostic in found)
    line = phrase(
        "{errors}, {warnings}",
        errors=counted("{count} error", "{count} errors", errors),
        warnings=counted("{count} warning", "{count} warnings", warnings),
    )
    print_message(localized(line))


def _print_statistics(found: Iterable[Diagnostic]) -> None:
    from linkwright.lint.explain import find_page

    for code, count in sorted(
        Counter(diagnostic.code for diagnostic in found).items(), key=lambda item: (-item[1], item[0])
    ):
        page = find_page(code)
        print(f"{count:6}  {code:<9} {page.name or localized(page.title) if page else ''}".rstrip(), file=sys.stderr)


def _listed(words: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for word in words for name in word.replace(",", " ").split())


def _usage(message: str) -> int:
    print(f"linkwright check: {message}", file=sys.stderr)
    return _USAGE
