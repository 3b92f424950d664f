"""Compare what both versions of a changed source have beside its names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location, Problem
from linkwright.review.installed_paths import find_include_text, is_exported_header, read_package_facts
from linkwright.review.sources.changed_sources import ChangedSources
from linkwright.review.sources.cpp.node_options import find_executor_change, find_option_changes
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.enumerators import compare_enumerations
from linkwright.review.sources.headers.protected_members import compare_protected
from linkwright.review.sources.headers.swapped_arguments import (
    compare_argument_order,
    find_swapped_definitions,
    is_declared_without_order,
)
from linkwright.review.sources.headers.type_names import compare_type_names
from linkwright.review.sources.names import (
    CPP_SUFFIXES,
    HEADER_SUFFIXES,
    PYTHON_SUFFIX,
    NameKind,
    SourceNames,
)
from linkwright.review.sources.namespaces import compare_namespaces, has_namespace
from linkwright.review.sources.python.methods import is_defined_by_others
from linkwright.review.sources.python.package_imports import (
    find_failing_imports,
    is_certainly_uninstalled,
    is_in_python_package,
    is_installed_package,
)
from linkwright.review.sources.python.undefined_uses import find_undefined_uses
from linkwright.review.sources.python.unreachable_modules import is_unreachable
from linkwright.review.sources.rates import compare_loops, compare_rates, compare_timers
from linkwright.review.sources.reasons import find_removal_reason
from linkwright.review.sources.separate_programs import are_in_separate_programs, is_in_no_installed_program
from linkwright.review.sources.transform_senders import find_one_sided_sender
from linkwright.review.sources.unbuilt_sources import find_exported_class, is_unbuilt
from linkwright.review.sources.unread_parameters import is_only_declared
from linkwright.review.sources.unused_parameters import find_unused_parameters, is_read_without_use
from linkwright.review.sources.unused_publishers import find_silent_publishers
from linkwright.review.sources.used_packages import compare_usage
from linkwright.review.versions import Version

_GUARD = re.compile(
    r"^[ \t]*#[ \t]*(?:pragma[ \t]+once|ifndef[ \t]+(\w+)\s*#[ \t]*define[ \t]+\1[ \t]*|endif[ \t]*)$", re.MULTILINE
)
"""The lines that guard a header against repeated inclusion."""


@dataclass(frozen=True)
class WholeSourcePair:
    """Both versions of a changed source.

    Attributes:
        old: the names of the old version.
        new: the names of the new version.
        file: the paths of the source in both versions.
    """

    old: ChangedSources
    new: ChangedSources
    file: ChangedFile

    def find_problems(self) -> Iterator[Problem]:
        """Yield the reason why the names of a version are unknown."""
        lines = [
            self.old.get_names(self.file.old_path).error_line,
            self.new.get_names(self.file.new_path).error_line,
        ]
        if None in (self.file.old_path, self.file.new_path) or not any(lines):
            return
        if all(lines):
            reason = phrase("line {line} has a syntax error", line=lines[1])
            yield Problem(phrase("neither version can be read: {reason}", reason=reason), is_of_both=True)
        elif lines[0]:
            text = phrase("the old version has a syntax error in line {line}; its names are not known", line=lines[0])
            yield Problem(text, is_of_old=True)
        else:
            yield Problem(
                phrase("the new version has a syntax error in line {line}; its names are not known", line=lines[1])
            )

    def find_parse_failure(self) -> Iterator[Change]:
        """Yield a change if no version of Python can parse the new source."""
        names = self.new.get_names(self.file.new_path)
        could_be_parsed = not self.old.get_names(self.file.old_path).error_line
        if names.error_line and names.is_error_certain and could_be_parsed:
            text = phrase("can no longer be parsed")
            reason = phrase("programs that run or import the file fail")
            yield Change(text, Effect.BREAKING, reason, Location(self.file.path, names.error_line, 1))

    def is_interface(self, path: str) -> bool:
        """Return whether other packages can use the definitions of a file.

        That is, whether it is a module of a package or an installed header.
        """
        side = self.new if self.file.old_path is None else self.old
        package = side.find_package(path)
        if path.endswith(PYTHON_SUFFIX):
            is_module = package is not None and is_in_python_package(side.version, package, path)
            return is_module and not is_certainly_uninstalled(side.version, package or "", path)
        return package is not None and is_exported_header(side.version, package, path)

    def is_unread_parameter(self, name: str) -> bool:
        """Return whether the old source declares or reads a parameter without using it, so that it had no effect."""
        path = self.file.old_path or ""
        package = self.old.find_package(path) if path else None
        if package is None:
            return False
        version = self.old.version
        others = [
            version.text(other)
            for other in version.paths((*CPP_SUFFIXES, PYTHON_SUFFIX), package)
            if other != path and not are_in_separate_programs(version, package, path, [other])
        ]
        text, is_python = version.text(path), path.endswith(PYTHON_SUFFIX)
        if is_only_declared(text, others, name, is_python=is_python):
            return True
        return not is_python and is_read_without_use(text, others, name, is_header=path.endswith(HEADER_SUFFIXES))

    def can_be_linked(self, name: str, kind: NameKind = NameKind.FUNCTION) -> bool:
        """Return whether other packages can use a function, class or member of the old source.

        The code of a function that its header only declares is in no library if the package builds none. Then nothing
        makes objects of its class.
        """
        path = self.file.old_path or self.file.path
        declared = self.old.get_names(path).declared_only
        scope = f"{name if kind is NameKind.CLASS else name.rpartition('::')[0]}::"
        is_declared = name in declared or (
            kind is not NameKind.FUNCTION and any(other.startswith(scope) for other in declared)
        )
        if path.endswith(PYTHON_SUFFIX) or not is_declared:
            return True
        return self.has_library()

    def has_library(self) -> bool:
        """Return whether the package of the old source may build a library."""
        package = self.old.find_package(self.file.old_path or self.file.path)
        facts = None if package is None else read_package_facts(self.old.version, package)
        return facts is None or facts.has_library

    def compare_rates(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield the changed rates and periods, and the removed and added timers."""
        is_added, is_removed = self.file.old_path is None, self.file.new_path is None
        changes = list(compare_rates(old_names, new_names, is_added=is_added))
        if not is_added and not is_removed:
            others = [*self.old.list_timers(self.file.old_path), *self.new.list_timers(self.file.new_path)]
            changes += compare_timers(old_names, new_names, others)
            sides = self.old.list_others(self.file.old_path), self.new.list_others(self.file.new_path)
            changes += compare_loops(old_names, new_names, sides)
        for change in changes:
            yield self.make_change(change.text, change.span, self.old if change.is_old else self.new, None)

    def find_unused_parameters(self, names: SourceNames) -> Iterator[Change]:
        """Yield the parameters that the source still reads, but whose values nothing uses any more."""
        old_path, new_path = self.file.old_path, self.file.new_path
        if old_path is None or new_path is None or not new_path.endswith(CPP_SUFFIXES):
            return
        texts = self.old.version.text(old_path), self.new.version.text(new_path)
        list_others = (partial(_list_texts, self.old, old_path), partial(_list_texts, self.new, new_path))
        unused = set(find_unused_parameters(texts, list_others))
        for item in names.of_kind(NameKind.PARAMETER):
            if item.name.lstrip("~/") in unused:
                text = phrase("{kind} '{name}' is no longer used", kind=item.kind.title, name=item.name)
                yield self.make_change(text, item.span, self.new, find_removal_reason([item], names, names, new_path))

    def compare_imports(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield new absolute imports of modules of the same package.

        They fail once the package is installed.
        """
        path = self.file.new_path or ""
        package = self.new.find_package(path)
        if package is None or not is_installed_package(self.new.version, package, path):
            return
        before = {name for name, _ in old_names.absolute_imports}
        for index in find_failing_imports(self.new.version, package, path, new_names):
            name, span = new_names.absolute_imports[index]
            if name not in before:
                text = phrase("absolute import of '{name}', a module of the same package", name=name)
                yield self.make_change(
                    text, span, self.new, phrase("the package cannot be imported once it is installed")
                )

    def find_undefined(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield the names and attributes that the source uses although nothing defines or imports them."""
        path = self.file.new_path or ""
        is_defined = partial(is_defined_by_others, self.new.version, path)
        for use in find_undefined_uses(old_names, new_names, is_defined, is_added=self.file.old_path is None):
            yield self.make_change(use.text, use.span, self.new, use.reason)

    def find_added_header(self) -> Iterator[Change]:
        """Yield a line with the text by which other packages include an added header."""
        path = PurePosixPath(self.file.path)
        if self.file.old_path is None and path.suffix in HEADER_SUFFIXES and self.is_interface(self.file.path):
            package = self.new.find_package(self.file.path) or ""
            include = find_include_text(self.new.version, package, self.file.path)
            if _has_code(self.new.version, self.file.path):
                text = phrase("header added: other packages can include '{path}'", path=include)
            else:
                text = phrase("header without code added: '{path}'", path=include)
            yield Change(text, location=Location(self.file.path, 1, 1))

    def find_emptied(self) -> Iterator[Change]:
        """Yield a line if only comments are left of a source in C++."""
        old_path, path = self.file.old_path, self.file.new_path
        if old_path is None or path is None or not path.endswith(CPP_SUFFIXES):
            return
        if _has_code(self.old.version, old_path) and not _has_code(self.new.version, path):
            yield Change(phrase("the file has no code any more"), location=Location(path, 1, 1))

    def find_unbuilt(self) -> Iterator[Change]:
        """Yield a line if no target builds an added source."""
        path = self.file.new_path
        package = None if path is None or self.file.old_path is not None else self.new.find_package(path)
        if path is not None and package is not None and is_unbuilt(self.new.version, package, path):
            name = find_exported_class(self.new.version, package, path)
            reason = None if name is None else phrase("programs that use '{name}' do not link", name=name)
            effect = Effect.CHANGED if reason is None else Effect.BREAKING
            yield Change(phrase("no target builds the source"), effect, reason, Location(path, 1, 1))

    def find_changed_options(self, reported: Sequence[Change]) -> Iterator[Change]:
        """Yield the changed options of nodes in C++, unless other lines do, and the executor of a generated program."""
        old_path, new_path = self.file.old_path, self.file.new_path
        if old_path is None or new_path is None or not new_path.endswith(CPP_SUFFIXES):
            return
        old, new = (blank_comments(text) for text in (self.old.version.text(old_path), self.new.version.text(new_path)))
        package = self.new.find_package(self.file.path)
        build_text = self.new.version.text((PurePosixPath(package or "") / "CMakeLists.txt").as_posix())
        sentences = [str(change.sentence) for change in reported]
        for change in (*find_option_changes(old, new, sentences), *find_executor_change(old, new, build_text)):
            line = (old if change.is_old else new)[: change.offset].count("\n") + 1
            path = old_path if change.is_old else new_path
            yield Change(change.text, location=Location(path, line, 1, change.is_old))

    def is_not_started(self) -> bool:
        """Return whether nothing starts or imports the source in any version, or no installed program had it."""
        sides = ((self.old, self.file.old_path), (self.new, self.file.new_path))
        if all(is_unreachable(side.version, side.find_package(path), path) for side, path in sides if path):
            return True
        path = self.file.old_path
        return path is not None and is_in_no_installed_program(self.old.version, self.old.find_package(path), path)

    def find_changed_senders(self, reported: Sequence[Change]) -> Iterator[Change]:
        """Yield the publishers that newly publish nothing, and whether the source starts or stops to send transforms.

        Transforms count unless a line names their frames.
        """
        names = self.new.get_names(self.file.new_path)
        for item in find_silent_publishers(self.old.version, self.new.version, self.file, names):
            is_harmless = self.new.has_in_unchanged(item, self.file.path) or self.is_not_started()
            reason = phrase("programs that subscribe to '{name}' get no messages", name=item.name)
            text = phrase("nothing is published with the publisher '{name}' any more", name=item.name)
            yield self.make_change(text, item.span, self.new, None if is_harmless else reason)
        frames = (NameKind.FRAME.title, NameKind.FRAME.plural)
        if not any(change.core.arguments.get("kind") in frames for change in reported):
            span = find_one_sided_sender(self.old, self.new, self.file, is_old=True)
            if span is not None:
                reason = phrase("programs that need these transforms do not find them")
                yield self.make_change(phrase("no longer publishes transforms"), span, self.old, reason)
            span = find_one_sided_sender(self.new, self.old, self.file, is_old=False)
            if span is not None:
                yield self.make_change(phrase("publishes transforms now"), span, self.new, None)

    def compare_packages(self, *, are_headers_told: bool) -> Iterator[Change]:
        """Yield the packages, or else the headers, that the source is the first or was the last to use."""
        old_path = self.file.old_path or self.file.path
        old, new = self.old.get_used_packages(old_path), self.new.get_used_packages(self.file.path)
        for change in compare_usage(old, new, self.file, are_headers_told=are_headers_told):
            yield self.make_change(change.text, change.span, self.old if change.is_old else self.new, None)

    def compare_header(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield the changes to namespaces, types, arguments, protected members and enumerators of a header."""
        if None in (self.file.old_path, self.file.new_path) or not self.is_interface(self.file.old_path or ""):
            return
        for change in (
            *compare_namespaces(old_names, new_names, partial(has_namespace, self.new.version, self.file.path)),
            *compare_protected(old_names, new_names),
            *compare_enumerations(old_names.enumerations, new_names.enumerations),
        ):
            yield self.make_change(change.text, change.span, self.old if change.is_old else self.new, change.reason)
        texts = self.old.version.text(self.file.old_path or ""), self.new.version.text(self.file.path)
        for item in compare_type_names(*texts) if self.file.path.endswith(HEADER_SUFFIXES) else ():
            effect = Effect.CHANGED if item.reason is None else Effect.BREAKING
            yield Change(item.text, effect, item.reason, Location(self.file.path, item.line, 1))
        for change in compare_argument_order(old_names, new_names):
            reason = change.reason if self.can_be_linked(str(change.text.arguments["name"])) else None
            yield self.make_change(change.text, change.span, self.new, reason)

    def compare_definitions(self) -> Iterator[Change]:
        """Yield the parameters that change places in definitions whose declaration does not name them."""
        path = self.file.new_path or ""
        old, new = self.old.codes.get(self.file.old_path or ""), self.new.codes.get(path)
        package = self.new.find_package(path)
        if old is None or new is None or package is None or path.endswith((*HEADER_SUFFIXES, PYTHON_SUFFIX)):
            return
        for item in find_swapped_definitions(old, new):
            if is_declared_without_order(self.new.version, package, item.name):
                facts = read_package_facts(self.new.version, package)
                is_linked = facts is None or facts.has_library
                effect = Effect.BREAKING if is_linked else Effect.CHANGED
                yield Change(item.text, effect, item.reason if is_linked else None, Location(path, item.line, 1))

    @staticmethod
    def make_change(text: Phrase, span: Span, side: ChangedSources, reason: Phrase | None) -> Change:
        """Return a change at a place in one version, which is breaking if it has a reason."""
        path = side.version.relative(span.file)
        location = None if path is None else Location(path, span.line, span.column, side.version.is_old)
        return Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)


def _list_texts(side: ChangedSources, path: str) -> list[str]:
    """Return the texts of the other C++ sources and headers in the package of a source."""
    package = side.find_package(path)
    paths = side.version.paths(CPP_SUFFIXES, package) if package is not None else ()
    return [side.version.text(other) for other in paths if other != path]


def _has_code(version: Version, path: str) -> bool:
    """Return whether a source in C++ has more than comments and a guard against repeated inclusion."""
    return bool(_GUARD.sub("", blank_comments(version.text(path))).strip())
