"""Generate the source of functions that read elements, from their rules.

For ``<mass>`` of URDF it is, except for the names of the values:

    def read(element, owner, report):
        given = element.attributes
        before = report.count
        try:
            value = (read_value(given['value']),)
        except (KeyError, ValueError):
            return explain(element, owner, report)
        ...

and for ``<inertial>``, which has children, it begins like this:

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

from collections.abc import Iterator

from linkwright.schema.rules import AttributeRule, ElementRule, Version

_REMEMBERED = 4096
"""The memory of a kind of element is cleared after this many different elements."""


def is_remembered(rule: ElementRule) -> bool:
    """Return whether elements of a rule are cached by their attributes: if they only have these, and not just names."""
    only_attributes = not (rule.children or rule.nests or rule.located or rule.text is not None)
    return only_attributes and any(attribute.type.read is not str for attribute in rule.attributes)


def flat_source(rule: ElementRule, version: Version) -> str:
    """Return the source of ``read(element, owner, report)`` for elements without children.

    An element with a mistake is left to ``explain``; the result of one without findings is stored in ``memory``.
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
    made = f"({', '.join(values)},)" if rule.is_inline else f"make({', '.join(values)})"
    lines += ["try:", f"    value = {made}", "except (KeyError, ValueError):"]
    lines.append("    return explain(element, owner, report)")
    if rule.check is not None:
        lines.append("value = check(value, element, owner, report)")
    if is_remembered(rule):
        lines += ["if report.count == before:", f"    if len(memory) >= {_REMEMBERED}:", "        memory.clear()"]
        lines.append("    memory[key or (*given, *given.values())] = value")
    return _function([*lines, "return value"], "key=()")


def nested_source(rule: ElementRule, version: Version) -> str:
    """The text of ``read(element, owner, report)`` for elements of a rule in files of a version."""
    attributes = [(f"attribute{index}", attribute) for index, attribute in enumerate(rule.attributes)]
    children = [(f"child{index}", child) for index, child in enumerate(rule.children) if child.since <= version]
    lines = ["given = element.attributes"]
    for name, attribute in attributes:
        lines += _attribute(name, attribute, version)
    if rule.owns:
        lines.append("owner = element")
    lines += [f"{name} = {'[]' if child.many else 'None'}" for name, child in children]
    lines += ["nested = []"] if rule.nests else []
    lines += ["for child in element.children:", "    if not isinstance(child, Element):", "        continue"]
    lines.append("    tag, inner = child.tag, child.attributes")
    for name, child in children:
        lines += [f"    {line}" for line in _child(name, child)]
    if rule.nests:
        lines += [f"    if tag == {rule.tag!r}:", "        nested.append(read(child, owner, report))"]
    for name, child in children:
        if child.required:
            lines += [f"if {name} is None:", f"    report.missing_child(element, rule, {name}_rule, owner)"]
            lines.append(f"    {name} = UNREADABLE")
    lines += _unreadable(rule, [name for name, _ in attributes], children)
    fields = [f"{attribute.target}={name}" for name, attribute in attributes]
    fields += [field for name, child in children for field in _fields(name, child)]
    fields += [f"{rule.target}=tuple(nested)"] if rule.nests else []
    fields += ["element=element"] if rule.located else []
    lines.append(f"value = make({', '.join(fields)})")
    lines.append("return value" if rule.check is None else "return check(value, element, owner, report)")
    return _function(lines)


def _function(lines: list[str], *more: str) -> str:
    return f"def read({', '.join(('element', 'owner', 'report', *more))}):\n" + "".join(
        f"    {line}\n" for line in lines
    )


def _attribute(name: str, attribute: AttributeRule, version: Version) -> Iterator[str]:
    statement = f"{name} = read_value(element, rule, {name}_rule, version, owner, report)"
    if attribute.is_required(version) and attribute.since <= version:
        yield "try:"
        yield f"    {name} = {name}_read(given[{attribute.name!r}])"
        yield "except (KeyError, ValueError):"
        yield f"    {statement}"
    else:
        yield f"{name} = {statement[len(name) + 3 :]} if {attribute.name!r} in given else {name}_absent"


def _child(name: str, child: ElementRule) -> Iterator[str]:
    read = f"{name}_read(child, owner, report)"
    if is_remembered(child):
        read = f"{name}_memory.get(key := (*inner, *inner.values())) or {name}_read(child, owner, report, key)"
    yield f"if tag == {child.tag!r}:"
    if child.many:
        yield f"    {name}.append({read})"
    else:
        yield f"    if {name} is None:"
        yield f"        {name} = {read}"
    yield "    continue"


def _unreadable(rule: ElementRule, attributes: list[str], children: list[tuple[str, ElementRule]]) -> Iterator[str]:
    """The generated code for an element with unreadable parts."""
    singles = [*attributes, *(name for name, child in children if not child.many)]
    if rule.keeps:
        for name in singles:
            yield f"if {name} is UNREADABLE:"
            yield f"    {name} = {name}_absent" if name in attributes else f"    {name} = None"
        return
    tests = [f"{name} is UNREADABLE" for name in singles]
    tests += [f"any(each is UNREADABLE for each in {name})" for name, child in children if child.many]
    tests += ["any(each is UNREADABLE for each in nested)"] if rule.nests else []
    yield f"if {' or '.join(tests)}:"
    yield "    return UNREADABLE"


def _fields(name: str, child: ElementRule) -> Iterator[str]:
    """The generated arguments for a child."""
    if child.is_inline:
        for place, attribute in enumerate(child.values):
            yield f"{attribute.target}=({name}_absent if {name} is None else {name})[{place}]"
    elif child.many:
        yield f"{child.target}=tuple({name})"
    else:
        yield f"{child.target}={name}_absent if {name} is None else {name}"
