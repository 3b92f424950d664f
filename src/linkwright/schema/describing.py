"""What a rule says, in words: for hover texts and for documentation."""

from __future__ import annotations

from linkwright.schema.rules import AttributeRule, ElementRule, Version


def describe_element(rule: ElementRule) -> str:
    """An element in Markdown: what it is, what it must and may carry and contain."""
    since = f", since version {_shown(rule.since)}" if rule.since > (1, 0) else ""
    lines = [f"`<{rule.tag}>`{since}: {rule.meaning}", ""]
    lines += [f"- {describe_attribute(attribute)}" for attribute in rule.attributes]
    if rule.text is not None:
        lines.append(f"- the text inside: {rule.text.meaning} ({', '.join(_facts(rule.text))})")
    inner = [f"`<{child.tag}>`{_times(child)}" for child in rule.children]
    inner += [f"`<{rule.tag}>` (any number)"] if rule.nests else []
    if inner:
        lines.append(f"- contains {'one of ' if rule.choice else ''}{', '.join(inner)}")
    return "\n".join(lines).rstrip()


def describe_attribute(attribute: AttributeRule) -> str:
    """An attribute in one line of Markdown: meaning, type, unit, default, versions."""
    return f"`{attribute.name}`: {attribute.meaning} ({', '.join(_facts(attribute))})"


def _facts(attribute: AttributeRule) -> list[str]:
    facts = [attribute.type.name + (f" in {attribute.unit}" if attribute.unit else "")]
    if attribute.required:
        facts.append(f"required before version {_shown(attribute.until)}" if attribute.until else "required")
    elif attribute.default:
        facts.append(f"`{attribute.default}` when absent")
    if attribute.since > (1, 0):
        facts.append(f"since version {_shown(attribute.since)}")
    return facts


def _times(rule: ElementRule) -> str:
    if rule.many:
        return " (any number)"
    return " (required)" if rule.required else ""


def _shown(version: Version) -> str:
    return ".".join(map(str, version))
