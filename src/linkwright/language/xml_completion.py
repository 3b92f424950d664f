"""Completion in XML files: elements, attributes, values and macro calls."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind, definitions_of_kind, sorted_by_use
from linkwright.language.cursor import Cursor, CursorSyntax, cursor_at
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.format import Document
from linkwright.language.grammar import PREFIX, XACRO, has_xacro, root_of, rule_at
from linkwright.language.outline import Outline, OutlineElement
from linkwright.language.parameters import called_macro, macro_parameters
from linkwright.language.xml_values import complete_text, complete_value
from linkwright.schema import AttributeRule, ElementRule, describe_attribute, describe_element
from linkwright.xacro.macros import Parameter


def complete(document: Document, offset: int, names: Sequence[NameDefinition] = ()) -> list[Completion]:
    """Return the completions at an offset, the most likely first, each label once.

    Args:
        document: the text. The name of its file determines the language.
        offset: the character offset of the cursor.
        names: the names that the files of the description define.
    """
    completions: dict[str, Completion] = {}
    for item in _complete(document, offset, names):
        completions.setdefault(item.label, item)
    return list(completions.values())


def _complete(document: Document, offset: int, names: Sequence[NameDefinition]) -> Iterator[Completion]:
    root = root_of(document.file)
    if root is None:
        return
    cursor = cursor_at(document.text, offset)
    if cursor.syntax is CursorSyntax.TEXT and cursor.tags:
        rule = rule_at(root, cursor.tags, cursor.elements)
        yield from complete_text(document, cursor, rule, names)
        if cursor.typed.strip() or (rule is not None and rule.text is not None and not rule.child_rules):
            return
    if cursor.syntax is CursorSyntax.TAG or (cursor.syntax is CursorSyntax.TEXT and not cursor.typed.strip()):
        yield from _offer_elements(document, cursor, root, names)
    elif cursor.syntax is CursorSyntax.CLOSING_TAG and cursor.tags:
        yield Completion(cursor.tags[-1], ItemKind.ELEMENT, offset - len(cursor.typed))
    elif cursor.syntax is CursorSyntax.ATTRIBUTE:
        yield from _offer_attributes(cursor, root, names)
    elif cursor.syntax is CursorSyntax.VALUE:
        rule = None if cursor.tags[-1].startswith(PREFIX) else rule_at(root, cursor.tags, cursor.elements)
        yield from complete_value(document, cursor, rule, names)


# --- elements ---------------------------------------------------------------------------------------------------------


def _offer_elements(
    document: Document, cursor: Cursor, root: ElementRule, names: Sequence[NameDefinition]
) -> Iterator[Completion]:
    opens_tag = cursor.syntax is CursorSyntax.TEXT
    start = cursor.offset if opens_tag else cursor.offset - len(cursor.typed)
    mark = "<" if opens_tag else ""
    rule = rule_at(root, cursor.tags, cursor.elements)
    in_macro_alone = bool(cursor.tags) and rule is None and all(tag.startswith(PREFIX) for tag in cursor.tags[1:])
    if not cursor.tags:
        offered: Iterable[ElementRule] = [root]
    else:
        offered = (rule or (root if in_macro_alone else None) or ElementRule("", "")).child_rules.values()
    present = _list_present_elements(document.text, cursor) if cursor.tags else frozenset()
    free = [child for child in offered if child.is_repeated or child.tag not in present]
    for child in sorted(free, key=lambda child: not child.required):
        snippet = mark + _make_element_snippet(child)
        yield Completion(child.tag, ItemKind.ELEMENT, start, _format_unit(child), describe_element(child), snippet)
    if not cursor.tags or not has_xacro(root):
        return
    for macro in sorted_by_use(definitions_of_kind(names, NameKind.MACRO), document.text):
        label = PREFIX + macro.name
        described = f"`{macro.detail}`\n\n{macro.file.name}" if macro.detail else macro.file.name
        yield Completion(
            label, ItemKind.MACRO, start, _to_one_line(macro.detail), described, mark + _make_call_snippet(macro)
        )
    for tag in XACRO.values():
        yield Completion(
            tag.tag, ItemKind.ELEMENT, start, "xacro", describe_element(tag), mark + _make_element_snippet(tag)
        )


def _list_present_elements(text: str, cursor: Cursor) -> frozenset[str]:
    """Return the existing child elements around a cursor, without the one being typed."""
    children = Outline.of(text).elements
    parent: OutlineElement | None = None
    for element in cursor.elements:
        parent = next((candidate for candidate in children if candidate.tag.start == element.start), None)
        children = [] if parent is None else parent.children
    typed_start = cursor.token.start if cursor.token is not None else -1
    return frozenset(child.tag.name for child in children if child.tag.start != typed_start)


def _format_unit(rule: ElementRule) -> str:
    if rule.text is None:
        return ""
    return f"{rule.text.type.name}, {rule.text.unit}" if rule.text.unit else rule.text.type.name


def _to_one_line(text: str) -> str:
    return " ".join(text.split())


def _escape(text: str) -> str:
    return text.replace("\\", "\\\\").replace("$", "\\$").replace("}", "\\}")


def _make_element_snippet(rule: ElementRule) -> str:
    snippet_attributes = [attribute for attribute in rule.attributes if attribute.required or attribute.usually_written]
    attributes_text = "".join(
        f' {attribute.name}="${{{number}}}"' for number, attribute in enumerate(snippet_attributes, 1)
    )
    if rule.text is not None and not rule.children:
        default = f":{_escape(rule.text.default)}" if rule.text.default and len(rule.text.default) < 40 else ""
        return f"{rule.tag}{attributes_text}>${{{len(snippet_attributes) + 1}{default}}}</{rule.tag}>"
    has_content = bool(rule.child_rules) or rule.tag in ("xacro:macro", "xacro:if", "xacro:unless")
    return f"{rule.tag}{attributes_text}>$0</{rule.tag}>" if has_content else f"{rule.tag}{attributes_text}/>$0"


def _make_call_snippet(macro: NameDefinition) -> str:
    parameters = macro_parameters(macro)
    attributes_text = "".join(
        f' {parameter.name}="${{{number}}}"'
        for number, parameter in enumerate((parameter_ for parameter_ in parameters if _is_required(parameter_)), 1)
    )
    tag = PREFIX + macro.name
    return (
        f"{tag}{attributes_text}>$0</{tag}>"
        if any(macro_parameter.is_block for macro_parameter in parameters)
        else f"{tag}{attributes_text}/>$0"
    )


def _is_required(parameter: Parameter) -> bool:
    return not parameter.is_block and parameter.default is None and not parameter.forward


# --- attributes -------------------------------------------------------------------------------------------------------


def _offer_attributes(cursor: Cursor, root: ElementRule, names: Sequence[NameDefinition]) -> Iterator[Completion]:
    tag = cursor.tags[-1]
    start = cursor.offset - len(cursor.typed)
    present = {attribute.name for attribute in cursor.token.attributes()} if cursor.token else set()
    present.discard(cursor.attribute.name if cursor.attribute else "")
    suffix = "" if cursor.attribute is not None and cursor.attribute.value is not None else '="$1"$0'
    if tag.startswith(PREFIX) and tag not in XACRO:
        macro = called_macro(tag, names)
        parameters = () if macro is None else macro_parameters(macro)
        for parameter in sorted(parameters, key=lambda parameter: not _is_required(parameter)):
            if not parameter.is_block and parameter.name not in present and macro is not None:
                yield Completion(
                    parameter.name,
                    ItemKind.ATTRIBUTE,
                    start,
                    "" if parameter.default is None else f"= {parameter.default}",
                    describe_parameter(parameter, macro),
                    parameter.name + suffix,
                )
        return
    rule = XACRO.get(tag) or rule_at(root, cursor.tags, cursor.elements)
    free = [] if rule is None else [attribute for attribute in rule.attributes if attribute.name not in present]
    for attribute in sorted(free, key=lambda attribute: (not attribute.required, not attribute.usually_written)):
        yield _make_attribute_completion(attribute, start, suffix)


def describe_parameter(parameter: Parameter, macro: NameDefinition) -> str:
    """Return a description of a parameter of a macro, in Markdown."""
    default = f" ({localized(phrase('required'))})" if parameter.default is None else f" = `{parameter.default}`"
    return f"**{parameter.name}**{default}, {PREFIX}{macro.name}, {macro.file.name}"


def _make_attribute_completion(attribute: AttributeRule, start: int, suffix: str) -> Completion:
    detail = f"{attribute.type.name}, {attribute.unit}" if attribute.unit else attribute.type.name
    description = describe_attribute(attribute)
    return Completion(attribute.name, ItemKind.ATTRIBUTE, start, detail, description, attribute.name + suffix)
