"""Read elements by their rules.

The functions that read elements are generated and compiled once for each version of a language.

An element that has only attributes is read once for each set of values, because ``<origin xyz="0 0 0"/>`` occurs
hundreds of times in a robot. Readers are generated from the rules, as Jinja generates functions from templates, because
loops over tables take 1.5 times as long as handwritten code.

Except for the names of the values, the source generated for ``<mass>`` of URDF is:

    def read(element, owner, report):
        given = element.attributes
        before = report.count
        try:
            value = (read_value(given['value']),)
        except (KeyError, ValueError):
            return explain(element, owner, report)
        ...

The source for ``<inertial>``, which has children, begins as follows:

    def read(element, owner, report):
        given = element.attributes
        child0 = child1 = child2 = None
        for child in element.children:
            if not isinstance(child, Element):
                continue
            tag, inner = child.tag, child.attributes
            if tag == 'origin':
                if child0 is None:
                    key = (*inner, *inner.values())
                    child0 = child0_memory.get(key) or child0_read(child, owner, report, key)
                continue
            ...

The caller defines the names that are not local, such as ``child0_read``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any, Final, Protocol
from linkwright.schema.rules import AttributeRule, ElementRule, Version
from linkwright.xmltree import Element

_MAX_CACHED = 4096
"""The memory of a kind of element is cleared after this many different elements."""


def is_cached(rule: ElementRule) -> bool:
    """Return whether elements of a rule are cached by their attributes.

    Such elements have only attributes, and at least one of these is not a plain text.
    """
    only_attributes = not (rule.children or rule.is_recursive or rule.passes_element or rule.text is not None)
    return only_attributes and any(attribute.type.read is not str for attribute in rule.attributes)


def flat_source(rule: ElementRule, version: Version) -> str:
    """Return the source of ``read(element, owner, report)`` for elements without children.

    The generated function passes an element with an error to ``explain``, and stores a result without findings in
    ``memory``.
    """
    lines = ["given = element.attributes", "before = report.count"]
    values = []
    for index, attribute in enumerate(rule.attributes):
        value = f"attribute{index}_read(given[{attribute.name!r}])"
        if attribute.since > version:
            lines += [f"if {attribute.name!r} in given:", "    return explain(element, owner, report)"]
            value = f"attribute{index}_absent"
        elif not attribute.is_required(version):
            value += f" if {attribute.name!r} in given else attribute{index}_absent"
        values.append(value if rule.is_inline else f"{attribute.target}={value}")
    construction = f"({', '.join(values)},)" if rule.is_inline else f"make({', '.join(values)})"
    lines += ["try:", f"    value = {construction}", "except (KeyError, ValueError):"]
    lines.append("    return explain(element, owner, report)")
    if rule.check is not None:
        lines.append("value = check(value, element, owner, report)")
    if is_cached(rule):
        lines += ["if report.count == before:", f"    if len(memory) >= {_MAX_CACHED}:", "        memory.clear()"]
        lines.append("    memory[key or (*given, *given.values())] = value")
    return _function_source([*lines, "return value"], "key=()")


def nested_source(rule: ElementRule, version: Version) -> str:
    """Return the source of ``read(element, owner, report)`` for elements with children."""
    attributes = [(f"attribute{index}", attribute) for index, attribute in enumerate(rule.attributes)]
    children = [(f"child{index}", child) for index, child in enumerate(rule.children) if child.since <= version]
    lines = ["given = element.attributes"]
    for name, attribute in attributes:
        lines += _attribute_lines(name, attribute, version)
    if rule.is_owner:
        lines.append("owner = element")
    lines += [f"{name} = {'[]' if child.is_repeated else 'None'}" for name, child in children]
    lines += ["nested = []"] if rule.is_recursive else []
    lines += ["for child in element.children:", "    if not isinstance(child, Element):", "        continue"]
    lines.append("    tag, inner = child.tag, child.attributes")
    for name, child in children:
        lines += [f"    {line}" for line in _child_lines(name, child)]
    if rule.is_recursive:
        lines += [f"    if tag == {rule.tag!r}:", "        nested.append(read(child, owner, report))"]
    for name, child in children:
        if child.required:
            lines += [f"if {name} is None:", f"    report.missing_child(element, rule, {name}_rule, owner)"]
            lines.append(f"    {name} = UNREADABLE")
    lines += _unreadable_lines(rule, [name for name, _ in attributes], children)
    fields = [f"{attribute.target}={name}" for name, attribute in attributes]
    fields += [field for name, child in children for field in _fields(name, child)]
    fields += [f"{rule.target}=tuple(nested)"] if rule.is_recursive else []
    fields += ["element=element"] if rule.passes_element else []
    lines.append(f"value = make({', '.join(fields)})")
    lines.append("return value" if rule.check is None else "return check(value, element, owner, report)")
    return _function_source(lines)


def _function_source(lines: list[str], *extra_arguments: str) -> str:
    return f"def read({', '.join(('element', 'owner', 'report', *extra_arguments))}):\n" + "".join(
        f"    {line}\n" for line in lines
    )


def _attribute_lines(name: str, attribute: AttributeRule, version: Version) -> Iterator[str]:
    statement = f"{name} = read_value(element, rule, {name}_rule, version, owner, report)"
    if attribute.is_required(version) and attribute.since <= version:
        yield "try:"
        yield f"    {name} = {name}_read(given[{attribute.name!r}])"
        yield "except (KeyError, ValueError):"
        yield f"    {statement}"
    else:
        yield f"{name} = {statement[len(name) + 3 :]} if {attribute.name!r} in given else {name}_absent"


def _child_lines(name: str, child: ElementRule) -> Iterator[str]:
    read = f"{name}_read(child, owner, report)"
    if is_cached(child):
        read = f"{name}_memory.get(key := (*inner, *inner.values())) or {name}_read(child, owner, report, key)"
    yield f"if tag == {child.tag!r}:"
    if child.is_repeated:
        yield f"    {name}.append({read})"
    else:
        yield f"    if {name} is None:"
        yield f"        {name} = {read}"
    yield "    continue"


def _unreadable_lines(
    rule: ElementRule, attributes: list[str], children: list[tuple[str, ElementRule]]
) -> Iterator[str]:
    """Yield the lines of generated code that handle unreadable parts of an element."""
    singles = [*attributes, *(name for name, child in children if not child.is_repeated)]
    if rule.keeps_element:
        for name in singles:
            yield f"if {name} is UNREADABLE:"
            yield f"    {name} = {name}_absent" if name in attributes else f"    {name} = None"
        return
    tests = [f"{name} is UNREADABLE" for name in singles]
    tests += [f"any(value is UNREADABLE for value in {name})" for name, child in children if child.is_repeated]
    tests += ["any(value is UNREADABLE for value in nested)"] if rule.is_recursive else []
    yield f"if {' or '.join(tests)}:"
    yield "    return UNREADABLE"


def _fields(name: str, child: ElementRule) -> Iterator[str]:
    """Yield the keyword arguments in the generated code for a child."""
    if child.is_inline:
        for index, attribute in enumerate(child.values):
            yield f"{attribute.target}=({name}_absent if {name} is None else {name})[{index}]"
    elif child.is_repeated:
        yield f"{child.target}=tuple({name})"
    else:
        yield f"{child.target}={name}_absent if {name} is None else {name}"


UNREADABLE: Final = type("Unreadable", (), {"__repr__": lambda _: "UNREADABLE"})()
"""The value of an unreadable attribute or element, whose error has been reported."""


class Report(Protocol):
    """The receiver of a reader's findings, which formulates messages for an XML language.

    `owner` is the link or joint that contains an element; messages use it to describe the element's location.

    Attributes:
        count: the number of findings.
    """

    count: int

    def missing_attribute(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report that a required attribute, or the text inside the element, is missing."""

    def malformed(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> Any:
        """Report a malformed value, and return the value to use instead, or `UNREADABLE`.

        The malformed value is an attribute's value, or the text inside the element.
        """

    def too_new(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report that an attribute is ignored because a later version of the language added it."""

    def missing_child(self, element: Element, rule: ElementRule, child: ElementRule, owner: Element) -> None:
        """Report that a required child is missing."""

    def empty_choice(self, element: Element, rule: ElementRule, owner: Element) -> None:
        """Report that an element has none of its alternative required children."""

    def unknown_choice(self, child: Element, rule: ElementRule, owner: Element) -> None:
        """Report a child that is not allowed in this version of the language."""


Read = Callable[[Element, Element, Report], Any]
"""A function that returns the object of an element, given its owner and a report, or `UNREADABLE`."""


_Memory = dict[tuple[str, ...], Any]


class ElementReader(NamedTuple):
    """The reader of the elements of a rule.

    Attributes:
        read: the function that returns the object of an element, or `UNREADABLE`. For an element whose values are
            fields of the parent's object, it returns the tuple of these values.
        memory: the cached results of `read` without findings, by the names and values of the attributes; always empty
            for elements with a text or children.
    """

    read: Read
    memory: _Memory


_memories: list[_Memory] = []


def forget() -> None:
    """Clear the cached results of all readers, for benchmarks."""
    for memory in _memories:
        memory.clear()


@cache
def reader_of(rule: ElementRule, version: Version) -> ElementReader:
    """Return the reader for elements of a rule in files of a version."""
    if rule.choice:
        return _choice_reader(rule, version)
    if rule.children or rule.is_recursive or rule.passes_element:
        return _nested_reader(rule, version)
    return _flat_reader(rule, version)


def _flat_reader(rule: ElementRule, version: Version) -> ElementReader:
    """Return the reader of elements with attributes or a text, and no children."""
    values = rule.values
    make, check = rule.make, rule.check

    def explain(element: Element, owner: Element, report: Report) -> Any:
        results = [_read_value(element, rule, value, version, owner, report) for value in values]
        if any(item is UNREADABLE for item in results):
            return UNREADABLE
        fields = zip((value.target for value in values), results, strict=True)
        value = tuple(results) if make is None else make(**dict(fields))
        return value if check is None else check(value, element, owner, report)

    if rule.text is not None:
        return ElementReader(explain, {})
    memory: _Memory = {}
    _memories.append(memory)
    scope = {**_scope(rule, version), "explain": explain, "memory": memory}
    return ElementReader(_compile_reader(flat_source(rule, version), rule, scope), memory)


def _choice_reader(rule: ElementRule, version: Version) -> ElementReader:
    """Return the reader of elements whose first child decides their kind."""
    table = {child.tag: child for child in rule.children if child.since <= version}
    check = rule.check

    def read(element: Element, owner: Element, report: Report) -> Any:
        for child in element.children:
            if isinstance(child, Element):
                child_rule = table.get(child.tag)
                if child_rule is None:
                    report.unknown_choice(child, rule, owner)
                    return UNREADABLE
                read_child, memory = reader_of(child_rule, version)
                attributes = child.attributes
                value = memory.get((*attributes, *attributes.values())) or read_child(child, owner, report)
                return value if check is None or value is UNREADABLE else check(value, child, owner, report)
        report.empty_choice(element, rule, owner)
        return UNREADABLE

    return ElementReader(read, {})


def _nested_reader(rule: ElementRule, version: Version) -> ElementReader:
    """Return the reader of elements that have children, or whose object stores its element."""
    scope = _scope(rule, version)
    for index, child in enumerate(rule.children):
        if child.since <= version:
            scope[f"child{index}_rule"], scope[f"child{index}_absent"] = child, child.default
            scope[f"child{index}_read"] = _lazy_reader(f"child{index}", child, version, scope)
            scope[f"child{index}_memory"] = {}
    return ElementReader(_compile_reader(nested_source(rule, version), rule, scope), {})


def _lazy_reader(name: str, rule: ElementRule, version: Version, scope: dict[str, Any]) -> Read:
    """Return a reader that compiles and replaces itself when it reads its first element.

    Most robots use only half of the language.
    """

    def read(*arguments: Any) -> Any:
        scope[f"{name}_read"], scope[f"{name}_memory"] = reader_of(rule, version)
        return scope[f"{name}_read"](*arguments)

    return read


def _scope(rule: ElementRule, version: Version) -> dict[str, Any]:
    """Return the names that the generated source of a reader uses, with their values."""
    scope: dict[str, Any] = {
        "Element": Element,
        "UNREADABLE": UNREADABLE,
        "read_value": _read_value,
        "rule": rule,
        "version": version,
        "make": rule.make,
        "check": rule.check,
    }
    for index, attribute in enumerate(rule.attributes):
        scope[f"attribute{index}_rule"] = attribute
        scope[f"attribute{index}_read"] = attribute.type.read
        scope[f"attribute{index}_absent"] = attribute.absent_value(version)
    return scope


def _compile_reader(source: str, rule: ElementRule, scope: dict[str, Any]) -> Read:
    exec(compile(source, f"<reader of {rule.tag}>", "exec"), scope)  # noqa: S102 - only from rules, not from files
    read: Read = scope["read"]
    return read


def _read_value(
    element: Element, rule: ElementRule, attribute: AttributeRule, version: Version, owner: Element, report: Report
) -> Any:
    """Return one value of an element, and report its errors."""
    text = element.attributes.get(attribute.name) if attribute is not rule.text else element.text().strip() or None
    if attribute.since > version:
        if text is not None:
            report.too_new(element, rule, attribute, owner)
        return attribute.absent_value(version)
    if text is None:
        if not attribute.is_required(version):
            return attribute.absent_value(version)
        report.missing_attribute(element, rule, attribute, owner)
        return UNREADABLE
    try:
        return attribute.type.read(text)
    except ValueError:
        return report.malformed(element, rule, attribute, owner)
