"""Find the definition of an interface by its name.

The search order is: interfaces that come with Linkwright, interfaces of the workspace, and definitions in recordings.
"""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import (
    Diagnostic,
    Note,
    Phrase,
    SourceText,
    Span,
    did_you_mean,
    display_path,
    foreign,
    joined,
    phrase,
    quoted,
    term,
)
from linkwright.messages import catalog
from linkwright.messages.definitions.interfaces import (
    KINDS,
    Action,
    Definition,
    InterfaceName,
    Service,
    Structure,
    derive_definitions,
    list_structures,
    split_name,
)
from linkwright.messages.definitions.parser import KnownMessages, parse_interface
from linkwright.messages.errors import DefinitionError, InterfaceNotFoundError
from linkwright.packages import PackageFinder
from linkwright.packages.active import active_finder
from linkwright.packages.interface_files import find_interface_file, find_interface_files

_FINDER_LIFETIME_S = 1.0
"""The time in seconds for which a finder that has read the workspace is used again."""

KIND_NAMES = {"msg": "message", "srv": "service", "action": "action"}


class Library:
    """All available interfaces, read on demand.

    The methods are thread-safe. Interfaces that come with Linkwright take precedence over interfaces of the workspace
    with the same name. Interfaces of the workspace are read, without a build, from the interface files of the packages
    that the current finder finds. For any other name, a definition that was registered with `add_text` is used.
    """

    def __init__(self) -> None:
        self._definitions: dict[str, Definition] = {}
        self._sources: dict[str, SourceText] = {}
        self._embedded_sources: dict[str, SourceText] = {}
        self._checked: set[str] = set()
        self._own_finder: PackageFinder | None = None
        self._own_folder = ""
        self._own_until = 0.0
        self._lock = threading.RLock()

    def definition(self, name: str, *kinds: str) -> Definition:
        """Return the definition of a message, service or action, or of one of its parts.

        An example of a part is ``std_srvs/srv/SetBool_Request``.

        Args:
            name: ``package/kind/Name``, or ``package/Name``.
            kinds: the accepted kinds, of ``msg``, ``srv`` and ``action``; any kind if omitted.

        Raises:
            InterfaceNotFoundError: MSG101 with the nearest names, MSG102 for a text that is not a name.
            DefinitionError: the file has mistakes.
        """
        definition = self._definitions.get(name)
        if definition is not None and (not kinds or name.split("/")[1] in kinds):
            return definition
        with self._lock:
            return self._look_up(name, kinds or KINDS)

    def structure(self, type_name: str) -> Structure:
        """Return the definition of the structure with a full type name."""
        definition = self.definition(type_name)
        assert isinstance(definition, Structure)
        return definition

    def source(self, name: str) -> SourceText:
        """Return the text of the interface file that contains a definition.

        The comments in files that come with Linkwright differ from ROS's.

        Raises:
            InterfaceNotFoundError: as in `definition`.
        """
        type_name = self.definition(name).type_name
        package, kind, part = type_name.split("/")
        return self._sources[f"{package}/{kind}/{part.partition('_')[0]}"]

    def add_text(self, type_name: str, source: SourceText) -> None:
        """Register a message definition that a recording contains.

        Later texts for the same type are ignored.

        Args:
            type_name: the type of the message.
            source: the definition, which is IDL if its name ends with ``.idl``.
        """
        with self._lock:
            self._embedded_sources.setdefault(type_name, source)

    def names(self, kind: str, package: str | None = None) -> list[str]:
        """Return the sorted type names of all interfaces of one kind, including the workspace's.

        Args:
            kind: ``msg``, ``srv`` or ``action``.
            package: the package; None for all packages.
        """
        type_names = {
            f"{owner}/{name}"
            for owner in catalog.list_packages()
            if package is None or owner == package
            for name in catalog.read_texts(owner)
            if name.startswith(kind + "/")
        }
        for owner, share in self._find_workspace_packages(package):
            type_names.update(f"{owner}/{kind}/{name}" for name in find_interface_files(share, kind))
        if kind == "msg":
            type_names.update(
                name for name in tuple(self._embedded_sources) if package in (None, name.partition("/")[0])
            )
        return sorted(type_names)

    # --- looking up -----------------------------------------------------------------------------------------

    def _look_up(self, text: str, kinds: tuple[str, ...]) -> Definition:
        name = split_name(text)
        if name is None:
            raise InterfaceNotFoundError(_make_invalid_name_diagnostic(text))
        for kind in (name.kind,) if name.kind else kinds:
            if kind in kinds:
                type_name = f"{name.package}/{kind}/{name.name}"
                definition = self._definitions.get(type_name) or self._load(type_name)
                if definition is not None:
                    return definition
        raise InterfaceNotFoundError(self._make_not_found_diagnostic(name, kinds))

    def _load(self, type_name: str) -> Definition | None:
        """Read the file of an interface, and register all definitions that rosidl derives from it.

        Returns the definition, or None if the interface has no file.
        """
        package, kind, name = type_name.split("/")
        base = f"{package}/{kind}/{name.partition('_')[0]}"
        if base in self._sources:
            return self._definitions.get(type_name)
        source = (
            self._find_shipped_source(base) or self._find_workspace_source(base) or self._embedded_sources.get(base)
        )
        if source is None:
            return None
        is_shipped = source.name[:1] == "<"
        definition = parse_source(source, base, TrustedMessages() if is_shipped else self)
        self._sources[base] = source
        parts = derive_definitions(definition)
        self._definitions.update(parts)
        if not is_shipped:
            try:
                self._check(definition, source, ())
            except DefinitionError:
                for part in parts:
                    del self._definitions[part]
                del self._sources[base]
                raise
        return self._definitions.get(type_name)

    def _find_shipped_source(self, base: str) -> SourceText | None:
        package, _, rest = base.partition("/")
        text = catalog.read_texts(package).get(rest)
        return None if text is None else SourceText(f"<{base}>", text)

    def _find_workspace_source(self, base: str) -> SourceText | None:
        package, kind, name = base.split("/")
        share = self._finder().find(package)
        path = find_interface_file(share, kind, name) if share is not None else None
        return None if path is None else read_source(path)

    def has_message(self, type_name: str) -> bool:
        """Return whether a message with a full name exists, even if its file has errors."""
        package, _, rest = type_name.partition("/")
        if rest in catalog.read_texts(package) or type_name in self._embedded_sources:
            return True
        share = self._finder().find(package)
        return share is not None and find_interface_file(share, *rest.split("/")) is not None

    def find_hint(self, type_name: str) -> Phrase | None:
        """Return a hint with names that resemble a missing message's name, or None."""
        name = split_name(type_name)
        return None if name is None else self._make_not_found_diagnostic(name, ("msg",)).hint

    def _check(self, definition: Definition, source: SourceText, enclosing_types: tuple[str, ...]) -> None:
        """Check that no structure contains itself, and that nested structures are valid."""
        if definition.type_name in self._checked:
            return
        for structure in list_structures(definition):
            type_chain = (*enclosing_types, structure.type_name)
            for reference in dict.fromkeys(structure.references):
                if reference in type_chain:
                    raise DefinitionError(
                        _make_recursion_diagnostic(source, (*type_chain[type_chain.index(reference) :], reference))
                    )
                nested_definition = self.definition(reference)
                inner_source = self._sources[reference]
                if inner_source.name[:1] != "<":
                    self._check(nested_definition, inner_source, type_chain)
        self._checked.add(definition.type_name)

    # --- the workspace --------------------------------------------------------------------------------------

    def _finder(self) -> PackageFinder:
        """Return the active package finder.

        If there is none, return a new finder, which is cached for a second because it has read the workspace.
        """
        finder = active_finder()
        if finder is None:
            now, folder = time.monotonic(), os.getcwd()  # noqa: PTH109 - a Path takes longer
            if self._own_finder is None or folder != self._own_folder or now > self._own_until:
                self._own_finder, self._own_folder = PackageFinder(), folder
                self._own_until = now + _FINDER_LIFETIME_S
            finder = self._own_finder
        return finder

    def _find_workspace_packages(self, package: str | None) -> Iterator[tuple[str, Path]]:
        finder = self._finder()
        if package is None:
            yield from finder.packages().items()
        else:
            share = finder.find(package)
            if share is not None:
                yield package, share

    def _make_not_found_diagnostic(self, name: InterfaceName, kinds: tuple[str, ...]) -> Diagnostic:
        requested_kinds = (name.kind,) if name.kind in kinds else kinds
        kind_text = joined([term(KIND_NAMES[kind]) for kind in requested_kinds if kind], " or ")
        same_package = [other for kind in requested_kinds if kind for other in self.names(kind, name.package)]
        notes: list[Note] = []
        if same_package:
            interface_names = [other.rpartition("/")[2] for other in same_package]
            hint = did_you_mean(name.name, interface_names) or self._find_same_name_elsewhere(name, requested_kinds)
            if hint is None:
                hint = phrase("'{package}' defines {names}", package=name.package, names=joined(interface_names[:8]))
                if len(interface_names) > 8:
                    hint = phrase("{list}, ...", list=hint)
        else:
            packages = {*catalog.list_packages(), *self._finder().packages()}
            if name.package in packages:
                notes.append(
                    Note(phrase("the package '{package}' has no {kind}", package=name.package, kind=kind_text))
                )
                hint = None
            else:
                notes.append(Note(phrase("there is no package '{package}'", package=name.package)))
                hint = did_you_mean(name.package, packages)
            hint = hint or self._find_same_name_elsewhere(name, requested_kinds)
        if hint is None:
            other_type_names = [
                other for kind in KINDS if kind not in requested_kinds for other in self.names(kind, name.package)
            ]
            hint = next(
                (
                    phrase("did you mean '{name}'?", name=other)
                    for other in other_type_names
                    if other.endswith("/" + name.name)
                ),
                None,
            )
        return Diagnostic(
            "MSG101", phrase("there is no {kind} '{name}'", kind=kind_text, name=name), notes=tuple(notes), hint=hint
        )

    def _find_same_name_elsewhere(self, name: InterfaceName, kinds: tuple[str | None, ...]) -> Phrase | None:
        for kind in kinds:
            for other in self.names(kind) if kind else ():
                if other.rpartition("/")[2] == name.name:
                    return phrase("did you mean {names}?", names=quoted(other))
        return None


class TrustedMessages:
    """A `KnownMessages` that accepts every message name.

    It is used for the files that come with Linkwright; a test has checked the names in them.
    """

    def has_message(self, type_name: str) -> bool:
        """Return True for any name."""
        return True

    def find_hint(self, type_name: str) -> Phrase | None:
        """Return None, because no message is missing."""
        return None


def parse_source(source: SourceText, base: str, known_messages: KnownMessages, *, is_ros1: bool = False) -> Definition:
    """Parse an interface file, as IDL if its suffix is ``.idl``.

    Args:
        source: the content of the file.
        base: the name of the interface, such as ``my_msgs/srv/Count``.
        known_messages: determines which messages exist, to check references.
        is_ros1: whether to read the file as ROS 1 does; see `parse_interface`.

    Raises:
        DefinitionError: the file has mistakes.
    """
    if source.name.endswith(".idl"):
        from linkwright.messages.definitions.idl import parse_idl

        return parse_idl(source, base, known_messages)
    return parse_interface(source, base, known_messages, is_ros1=is_ros1)


def make_wrong_kind_diagnostic(definition: Definition, kind: str) -> Diagnostic:
    """Return a finding for an interface that exists but is not of the requested kind."""
    name = definition.type_name
    actual_kind = {Structure: phrase("a message"), Service: phrase("a service"), Action: phrase("an action")}[
        type(definition)
    ]
    return Diagnostic(
        "MSG101",
        phrase("there is no {kind} '{name}'", kind=KIND_NAMES[kind], name=name),
        hint=phrase("'{name}' is {kind}", name=name, kind=actual_kind),
    )


def read_source(path: Path) -> SourceText:
    """Return the text of an interface file.

    Raises:
        DefinitionError: MSG121, the file cannot be read or is not text in UTF-8.
    """
    name = display_path(path)
    try:
        return SourceText(name, path.read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError as error:
        raise DefinitionError(
            Diagnostic(
                "MSG121",
                phrase("'{name}' is not text in UTF-8", name=name),
                hint=phrase("the byte at {start} does not begin a character", start=error.start),
            )
        ) from None
    except OSError as error:
        raise DefinitionError(
            Diagnostic("MSG121", phrase("cannot read '{path}': {reason}", path=name, reason=foreign(error.strerror)))
        ) from None


def _make_invalid_name_diagnostic(text: str) -> Diagnostic:
    hint = phrase("write it as 'package/kind/Name', such as 'sensor_msgs/msg/JointState'")
    guess = re.sub(r"\.|::", "/", text)
    if guess != text and split_name(guess):
        hint = phrase("did you mean {names}?", names=quoted(guess))
    return Diagnostic(
        "MSG102", phrase("'{text}' is not the name of a message, service or action", text=text), hint=hint
    )


def _find_span(source: SourceText, reference: str, owner: str) -> Span:
    package, _, name = reference.split("/")
    spellings = [rf"{package}/(?:msg/)?{name}", rf"{package}::msg::{name}"]
    if owner.startswith(package + "/"):
        spellings.append(name)
    match = re.search(rf"^[ \t]*(?:sequence<)?({'|'.join(spellings)})\b", source.text, re.MULTILINE)
    return source.span(*match.span(1)) if match else source.span(0)


def _make_recursion_diagnostic(source: SourceText, type_chain: tuple[str, ...]) -> Diagnostic:
    span = _find_span(source, type_chain[-1], type_chain[-2])
    enclosing_types = (
        type_chain[0] if len(type_chain) == 2 else f"{type_chain[0]} by way of " + ", ".join(type_chain[1:-1])
    )
    return Diagnostic(
        "MSG116",
        phrase(
            "'{type_name}' would contain itself: it is part of {enclosing_types}",
            type_name=type_chain[-1],
            enclosing_types=enclosing_types,
        ),
        span,
        source=source,
    )


LIBRARY = Library()
"""The interfaces of this process.

A class is created from an interface only once, so a message has the same class everywhere.
"""
