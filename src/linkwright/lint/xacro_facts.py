"""The definitions and uses in the unexpanded xacro files of a description.

Expressions are not evaluated. Therefore, the facts include branches that are not taken and macros that are not called.
Names are matched without regard to scopes, because xacro's scopes are dynamic and a rule about unused names must not
report a used name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Span
from linkwright.lint.xacro_names import Mentions, identifiers, mentions
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import TYPE_CHECKING, TypeVar
from linkwright.xacro.cache import BoundedCache
from linkwright.xacro.expressions.builtin_names import MATHEMATICS
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Parameter, parse_parameters
from linkwright.xmltree import Comment, Document, Element, Text
from linkwright.xmltree.positions import attribute_value_range

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext

XACRO_TAGS = frozenset(
    f"xacro:{name}"
    for name in ("arg", "attribute", "call", "element", "if", "include", "insert_block", "macro", "property", "unless")
)
_BARE_TAGS = frozenset({"include", "insert_block", "macro"})
_DIRECTIVE_IN_COMMENT = "xacro:eval-comments"
_MAX_FOLDER_FILES = 200
_MAX_CACHED_CHARACTERS = 2_000_000
"""The maximum number of characters of the documents with cached facts."""
_MAX_DEPTH = 1_000
"""The maximum nesting depth of the elements that are examined, the same as in an expansion."""


@dataclass(frozen=True)
class Definition:
    """A definition of a property, argument or macro, or an include.

    Attributes:
        name: the defined name or, for an include, the file name as written.
        element: the defining element.
        parents: the enclosing elements, outermost first.
        order: the index of the element among all elements of the file.
    """

    name: str
    element: Element
    parents: tuple[Element, ...]
    order: int

    @property
    def macro(self) -> Element | None:
        """The innermost macro definition that contains the element, or None."""
        return next((parent for parent in reversed(self.parents) if parent.tag == "xacro:macro"), None)

    @property
    def is_conditional(self) -> bool:
        """Whether the element is inside ``xacro:if`` or ``xacro:unless``."""
        return any(parent.tag in ("xacro:if", "xacro:unless") for parent in self.parents)


@dataclass(frozen=True)
class Use:
    """A text that mentions names.

    The text is an attribute of an element or, if `attribute` is None, the character data of the element.
    """

    element: Element
    attribute: str | None
    mentions: Mentions
    parents: tuple[Element, ...]
    order: int


_Inside = TypeVar("_Inside", Definition, Use)


def _group_by_macro(items: Iterable[_Inside]) -> Mapping[int, Sequence[_Inside]]:
    items_by_macro: dict[int, list[_Inside]] = {}
    for item in items:
        for parent in item.parents:
            if parent.tag == "xacro:macro":
                items_by_macro.setdefault(id(parent), []).append(item)
    return items_by_macro


@dataclass
class FileFacts:
    """The definitions and uses in one file.

    Attributes:
        names: all names that the expressions or substituted values of the file mention.
        called_macros: the names of the macros that the file calls, without prefix and namespace.
        has_open_calls: whether the file calls a macro whose name is computed.
    """

    document: Document
    properties: list[Definition] = field(default_factory=list)
    macros: list[Definition] = field(default_factory=list)
    arguments: list[Definition] = field(default_factory=list)
    includes: list[Definition] = field(default_factory=list)
    calls: list[Definition] = field(default_factory=list)
    uses: list[Use] = field(default_factory=list)
    names: set[str] = field(default_factory=set)
    used_arguments: set[str] = field(default_factory=set)
    pasted: set[str] = field(default_factory=set)
    called_macros: set[str] = field(default_factory=set)
    blocks: set[str] = field(default_factory=set)
    is_open: bool = False
    has_open_arguments: bool = False
    has_open_calls: bool = False
    has_content: bool = False

    @cached_property
    def has_bare_tags(self) -> bool:
        """Whether there are xacro tags without the prefix, which xacro does not process (LW720)."""
        return any(element.tag in _BARE_TAGS for element in self.document.root.walk())

    @cached_property
    def calls_by_macro(self) -> Mapping[int, Sequence[Definition]]:
        """The macro calls inside each macro, by the `id` of the macro's element."""
        return _group_by_macro(self.calls)

    @cached_property
    def uses_by_macro(self) -> Mapping[int, Sequence[Use]]:
        """The texts inside each macro that mention names, by the `id` of the macro's element."""
        return _group_by_macro(self.uses)

    @cached_property
    def parameter_uses(self) -> Mapping[int, Sequence[Use]]:
        """The parameter lists of macros that mention names, by the `id` of the macro's element."""
        uses: dict[int, list[Use]] = {}
        for use in self.uses:
            if use.attribute == "params":
                uses.setdefault(id(use.element), []).append(use)
        return uses

    @cached_property
    def macros_by_name(self) -> Mapping[str, Sequence[Definition]]:
        """The definitions of macros, by name."""
        macros: dict[str, list[Definition]] = {}
        for macro in self.macros:
            macros.setdefault(macro.name, []).append(macro)
        return macros

    @classmethod
    def of(cls, document: Document) -> FileFacts:
        """Return the facts about a parsed file, computed once for all argument sets."""
        facts = _CACHE.values.get(id(document))
        if facts is None:
            facts = cls(document)
            facts._walk()
            _CACHE.store(id(document), facts)
        return facts

    def parameters(self, macro: Element) -> tuple[Parameter, ...]:
        """Return the parameters of a macro of this file, or an empty tuple if they are malformed."""
        try:
            return parse_parameters(macro.attributes.get("params", ""))
        except Fault:
            return ()

    def _walk(self) -> None:
        stack: list[tuple[Element, tuple[Element, ...]]] = [(self.document.root, ())]
        order = 0
        while stack:
            element, parents = stack.pop()
            order += 1
            self._collect(element, parents, order)
            if len(parents) > _MAX_DEPTH:
                continue
            child_parents = (*parents, element)
            children: list[tuple[Element, tuple[Element, ...]]] = []
            evaluates_comments = False
            for child in element.children:
                if isinstance(child, Element):
                    children.append((child, child_parents))
                elif isinstance(child, Text):
                    if not child.cdata:
                        self._collect_mentions(child.data, element, None, parents, order)
                elif isinstance(child, Comment):
                    evaluates_comments = evaluates_comments or _DIRECTIVE_IN_COMMENT in child.data
                    if evaluates_comments:
                        self._collect_mentions(child.data, element, None, parents, order)
            stack.extend(reversed(children))

    def _collect(self, element: Element, parents: tuple[Element, ...], order: int) -> None:
        for attribute, value in element.attributes.items():
            if attribute != "params":
                self._collect_mentions(value, element, attribute, parents, order)
        tag = element.tag
        if not tag.startswith("xacro:"):
            if parents and not self.has_content and not any(parent.tag == "xacro:macro" for parent in parents):
                self.has_content = not _in_block_property(parents)
            return
        definition = Definition(element.attributes.get("name", ""), element, parents, order)
        if tag == "xacro:property":
            self.properties.append(definition)
        elif tag == "xacro:macro":
            self._collect_macro(definition)
        elif tag == "xacro:arg":
            self.arguments.append(definition)
        elif tag == "xacro:include":
            filename = element.attributes.get("filename", "")
            self.includes.append(Definition(filename, element, parents, order))
        elif tag == "xacro:insert_block":
            self.blocks.add(definition.name)
        else:
            self._collect_call(element, parents, order)

    def _collect_macro(self, definition: Definition) -> None:
        name = definition.name.removeprefix("xacro:")
        self.macros.append(Definition(name, definition.element, definition.parents, definition.order))
        for parameter in self.parameters(definition.element):
            if parameter.forward:
                self.names.add(parameter.name)
            if parameter.default is not None:
                self._collect_mentions(
                    parameter.default, definition.element, "params", definition.parents, definition.order
                )

    def _collect_call(self, element: Element, parents: tuple[Element, ...], order: int) -> None:
        tag, attributes = element.tag, element.attributes
        name = tag.removeprefix("xacro:")
        if tag in ("xacro:call", "xacro:element"):
            name = attributes.get("macro" if tag == "xacro:call" else "xacro:name", "").removeprefix("xacro:")
            if "$" in name:
                self.has_open_calls = True
                return
        if tag in XACRO_TAGS and tag != "xacro:call":
            return
        self.called_macros.add(name.rpartition(".")[2])
        self.calls.append(Definition(name, element, parents, order))

    def _collect_mentions(
        self, text: str, element: Element, attribute: str | None, parents: tuple[Element, ...], order: int
    ) -> None:
        if "$" not in text:
            return
        text_mentions = mentions(text)
        self.uses.append(Use(element, attribute, text_mentions, parents, order))
        self.names |= text_mentions.names
        self.used_arguments |= text_mentions.arguments
        self.pasted |= text_mentions.pasted_arguments
        self.is_open = self.is_open or text_mentions.is_open
        self.has_open_arguments = self.has_open_arguments or text_mentions.has_open_arguments


def _count_characters(_: int, facts: FileFacts) -> int:
    source = facts.document.source
    return 1 if source is None else len(source.text) + 1


_CACHE: BoundedCache[int, FileFacts] = BoundedCache(_MAX_CACHED_CHARACTERS, _count_characters)
"""The facts about documents by `id`. An ID stays unique because the facts keep the documents alive."""


class XacroFacts:
    """The definitions and uses in all files of a description.

    Attributes:
        path: the checked file.
        arguments: the final value of every argument that was passed or declared, by name.
        package: the package of the file, or None.
        is_library: whether the file does not describe a robot, but is intended for inclusion by others.
        files: the facts about each file, by path, starting with the checked file.
        stored_findings: the findings, by code, of the rules that depend only on these facts (`Rule.of_sources`) and
            have run.
    """

    def __init__(
        self,
        path: Path,
        sources: Mapping[Path, Document],
        arguments: Mapping[str, str],
        package: PackageContext | None,
        *,
        is_library: bool,
    ) -> None:
        self.path = path
        self.arguments = arguments
        self.package = package
        self.is_library = is_library
        self.files: dict[Path, FileFacts] = {path: FileFacts.of(document) for path, document in sources.items()}
        self.stored_findings: dict[str, tuple[Diagnostic, ...]] = {}

    @property
    def main(self) -> FileFacts:
        """The facts about the checked file."""
        return next(iter(self.files.values()))

    @cached_property
    def package_files(self) -> Mapping[Path, FileFacts]:
        """The facts about the files in the same package, or else in the same folder, by path."""
        package = self.package
        folder = (package.folder if package else self.path.parent).absolute()
        main = next(iter(self.files))
        return {path: facts for path, facts in self.files.items() if path == main or _is_in_folder(path, folder)}

    @cached_property
    def neighbors(self) -> Mapping[Path, FileFacts]:
        """The facts about other description files of the package or folder, by path.

        Such a file may use definitions of this description.
        """
        package = self.package
        documents = _neighboring_descriptions(self.path) if package is None else package.descriptions
        known_paths = {path.absolute() for path in self.files}
        return {
            path: FileFacts.of(document) for path, document in documents.items() if path.absolute() not in known_paths
        }

    @cached_property
    def substitutes_arguments(self) -> bool:
        """Whether arguments are substituted into expressions, so that values may become names."""
        return any(facts.pasted for facts in self._all_facts())

    @cached_property
    def names(self) -> frozenset[str]:
        """All names that a file or a neighbor uses, or could substitute, in an expression."""
        mentioned_names: set[str] = set()
        for facts in self._all_facts():
            mentioned_names |= facts.names | facts.blocks
        if self.substitutes_arguments:
            for value in self.arguments.values():
                mentioned_names |= identifiers(value)
        return frozenset(mentioned_names)

    @cached_property
    def used_arguments(self) -> frozenset[str]:
        """The names of all arguments that a file or a neighbor uses."""
        return frozenset(name for facts in self._all_facts() for name in facts.used_arguments)

    @cached_property
    def called_macros(self) -> frozenset[str]:
        """The names of all macros that a file or a neighbor calls, without namespaces."""
        return frozenset(name for facts in self._all_facts() for name in facts.called_macros)

    @cached_property
    def is_open(self) -> bool:
        """Whether a property may be used through a computed name, or in a file that was not read."""
        return any(facts.is_open for facts in self._all_facts()) or self._misses_files

    @cached_property
    def has_open_arguments(self) -> bool:
        """Whether an argument may be used through a computed name, or in a file that was not read."""
        return any(facts.has_open_arguments for facts in self._all_facts()) or self._misses_files

    @cached_property
    def has_open_calls(self) -> bool:
        """Whether a macro may be called through a computed name, or in a file that was not read."""
        return any(facts.has_open_calls for facts in self._all_facts()) or self._misses_files

    @cached_property
    def _misses_files(self) -> bool:
        """Whether a branch that is not taken includes an unread file."""
        known_names = {path.name for path in self.files} | {path.name for path in self.neighbors}
        for facts in self.files.values():
            for include in facts.includes:
                name = include.name.replace("\\", "/").rpartition("/")[2]
                if "$" in name or "}" in name or ")" in name:
                    if include.is_conditional or include.macro is not None:
                        return True
                elif not any(_matches(name, known_name) for known_name in known_names):
                    return True
        return False

    def _all_facts(self) -> Iterator[FileFacts]:
        yield from self.files.values()
        yield from self.neighbors.values()


def is_global(name: str) -> bool:
    """Return whether xacro provides a name, such as ``pi``, that a property could hide."""
    return name in MATHEMATICS


def parameter_span(macro: Element, parameter: Parameter) -> Span | None:
    """Return the location of a parameter's name in a macro's definition, or None."""
    source = macro.source
    if source is None:
        return None
    value_range = attribute_value_range(source.text, macro.offset, "params")
    if value_range is None or source.text[slice(*value_range)].replace("\n", " ") != macro.attributes.get("params", ""):
        return None
    start = value_range[0] + parameter.start
    return source.span(start, start + len(parameter.name))


def _in_block_property(parents: tuple[Element, ...]) -> bool:
    return any(parent.tag == "xacro:property" for parent in parents)


def _is_in_folder(path: Path, folder: Path) -> bool:
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except OSError:
        return False


def _matches(pattern: str, name: str) -> bool:
    if not re.search(r"[*?\[]", pattern):
        return pattern == name
    from fnmatch import fnmatchcase

    return fnmatchcase(name, pattern)


def _neighboring_descriptions(path: Path) -> dict[Path, Document]:
    from linkwright.xacro.cache import read_document

    documents: dict[Path, Document] = {}
    try:
        candidates = sorted(path.absolute().parent.iterdir())[:_MAX_FOLDER_FILES]
    except OSError:
        return documents
    for candidate in candidates:
        if candidate.suffix in (".xacro", ".urdf") and candidate.is_file():  # reading a named pipe would never end
            try:
                documents[candidate] = read_document(str(candidate))
            except LinkwrightError:
                continue
    return documents
