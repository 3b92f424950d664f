"""Descriptions of schema rules in words, for hover texts and documentation."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, joined, phrase, term
from linkwright.schema.rules import AttributeRule, ElementRule, Version


def describe_element(rule: ElementRule) -> Phrase:
    """Return a description of an element in Markdown: its meaning, attributes and children."""
    tag = joined([f"`<{rule.tag}>`", *_version_facts(rule.since)])
    heading = phrase("{name}: {meaning}", name=tag, meaning=term(rule.meaning))
    lines = [phrase("- {line}", line=describe_attribute(attribute)) for attribute in rule.attributes]
    if rule.text is not None:
        meaning, facts = term(rule.text.meaning), joined(_list_facts(rule.text))
        lines.append(phrase("- the text inside: {meaning} ({facts})", meaning=meaning, facts=facts))
    value_children = [] if rule.choice else [child for child in rule.children if child.is_value]
    lines += [phrase("- {line}", line=_describe_value(child)) for child in value_children]
    other_children = (child for child in rule.children if child not in value_children)
    child_texts = [
        _with_count(child.tag, is_repeated=child.is_repeated, required=child.required) for child in other_children
    ]
    child_texts += [_with_count(rule.tag, is_repeated=True, required=False)] if rule.is_recursive else []
    if child_texts:
        elements = joined(child_texts)
        lines.append(
            phrase("- contains one of {elements}", elements=elements)
            if rule.choice
            else phrase("- contains {elements}", elements=elements)
        )
    return joined([heading, "", *lines], "\n") if lines else heading


def describe_attribute(attribute: AttributeRule) -> Phrase:
    """Return a line of Markdown about an attribute: meaning, type, unit, default, versions."""
    return phrase(
        "{name}: {meaning} ({facts})",
        name=f"`{attribute.name}`",
        meaning=term(attribute.meaning),
        facts=joined(_list_facts(attribute)),
    )


def _describe_value(rule: ElementRule) -> Phrase:
    """Return a line of Markdown about an element with a single value, as for an attribute."""
    assert rule.text is not None
    facts = _list_facts(rule.text)
    if rule.is_repeated:
        facts.append(phrase("any number"))
    name = f"`<{rule.tag}>`"
    return phrase("{name}: {meaning} ({facts})", name=name, meaning=term(rule.meaning), facts=joined(facts))


def _list_facts(attribute: AttributeRule) -> list[Phrase]:
    kind = term(attribute.type.name)
    facts = [phrase("{type} in {unit}", type=kind, unit=term(attribute.unit)) if attribute.unit else kind]
    if attribute.required:
        facts.append(
            phrase("required before version {version}", version=_version_text(attribute.until))
            if attribute.until
            else phrase("required")
        )
    elif attribute.default:
        facts.append(phrase("{default} when absent", default=f"`{attribute.default}`"))
    return [*facts, *_version_facts(attribute.since)]


def _version_facts(version: Version) -> list[Phrase]:
    return [phrase("since version {version}", version=_version_text(version))] if version > (1, 0) else []


def _with_count(tag: str, *, is_repeated: bool, required: bool) -> Phrase:
    name = f"`<{tag}>`"
    if is_repeated:
        return phrase("{name} (any number)", name=name)
    return phrase("{name} (required)", name=name) if required else Phrase(name)


def _version_text(version: Version) -> str:
    return ".".join(map(str, version))
