"""Find the uses of lost interfaces and fields in C++ sources."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from linkwright.messages.definitions.interfaces import to_snake_case
from linkwright.review.sources.headers.lost_types import blank_comments
from linkwright.review.sources.interface_uses.definitions import WHOLE, InterfaceUse, LostInterface

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_POINTER = r"(?:::(?:Const|Shared|Unique)?(?:Const|Shared|Unique)?Ptr)?"
_NAME = r"\s*>?\s*(?:const\s*)?[&*]*\s*(?P<variable>[A-Za-z_]\w*)\s*(?P<end>[;,)={(])"


def find_cpp_uses(text: str, interface: LostInterface) -> Iterator[InterfaceUse]:
    """Yield the places where a source uses something that an interface lost.

    An object is followed in the block that declares it; an argument in the body of its function.
    """
    if interface.is_removed:
        yield from _find_includes(text, interface)
        return
    code = blank_comments(text)
    prefix = rf"\b{re.escape(interface.package)}::(?:{interface.kind}::)?{re.escape(interface.name)}"
    inner = "|".join(interface.inner_parts)
    part_pattern = rf"(?:(?:::)?(?P<part>{inner}))?" if inner else r"(?P<part>)"
    for match in re.finditer(rf"{prefix}{part_pattern}(?:::(?P<constant>[A-Z]\w*)\b(?!\s*::))?", code):
        if interface.kind == "msg" and match["constant"] in interface.lost_from("") & interface.constants:
            yield _make_use(interface, match["constant"], code, match.start())
    for match in re.finditer(rf"{prefix}{part_pattern}{_POINTER}{_NAME}", code):
        part = interface.inner_parts[match["part"]] if match["part"] else WHOLE if inner else ""
        end = _find_scope_end(code, match)
        scope = code[match.end("variable") : end]
        variable = match["variable"]
        if re.search(rf"[\w>&*]\s+[&*]*(?<!return ){variable}\s*[;=,)]", scope.replace("return", "      ")):
            continue  # another variable of the same name
        parts = {part: ""} if part != WHOLE else {name: rf"{name.strip()}\s*\.\s*" for name in interface.names}
        for name, access in parts.items():
            for lost in sorted(interface.lost_from(name)):
                pattern = rf"(?<![\w.>]){variable}\)?\s*(?:\.|->)\s*{access}{re.escape(lost)}\b(?!\s*\()"
                use = re.search(pattern, scope)
                if use is not None:
                    yield _make_use(interface, f"{name}{lost}", code, match.end("variable") + use.start())


def find_members(text: str, interface: LostInterface) -> set[str]:
    """Return the members of classes in a header whose type is a message. Their names end with an underscore."""
    if interface.is_removed or interface.inner_parts:
        return set()
    prefix = rf"\b{re.escape(interface.package)}::(?:{interface.kind}::)?{re.escape(interface.name)}"
    pattern = rf"{prefix}{_POINTER}\s*>?\s+(?P<variable>[A-Za-z]\w*_)\s*[;={{]"
    return {match["variable"] for match in re.finditer(pattern, blank_comments(text))}


def find_member_uses(text: str, interface: LostInterface, members: Collection[str]) -> Iterator[InterfaceUse]:
    """Yield the places where a source uses what an interface lost of members that an included header declares."""
    code = blank_comments(text)
    for member in sorted(members):
        if re.search(rf"[\w>&*]\s+[&*]*(?<!return ){member}\s*[;=,){{]", code.replace("return", "      ")):
            continue  # another variable of the same name
        for lost in sorted(interface.lost_from("")):
            use = re.search(rf"(?<![\w.>])(?:this\s*->\s*)?{member}\s*(?:\.|->)\s*{re.escape(lost)}\b(?!\s*\()", code)
            if use is not None:
                yield _make_use(interface, lost, code, use.start())


def _find_includes(text: str, interface: LostInterface) -> Iterator[InterfaceUse]:
    """Yield the first include of a header of a removed interface."""
    code = _COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    classes = {name for module in ("msg", "srv") for name in interface.find_classes(module)}
    headers = [f"{name}.h" for name in sorted(classes)]
    headers += [f"{interface.kind}/{to_snake_case(interface.name)}{suffix}" for suffix in (".hpp", ".h")]
    names = "|".join(map(re.escape, headers))
    path = rf"{re.escape(interface.package)}/(?:{names})"
    pattern = re.compile(rf'^[ \t]*#[ \t]*include[ \t]*["<]{path}[">]', re.MULTILINE)
    match = pattern.search(code)
    if match is not None and "__has_include" not in code:
        yield _make_use(interface, "", code, match.start())


def _find_scope_end(code: str, declaration: re.Match[str]) -> int:
    """Return the end of the block in which a declared variable is known."""
    start = declaration.end("variable")
    if declaration["end"] in ",)":
        start = min(index for index in (code.find("{", start), len(code)) if index >= 0)
        semicolon = code.find(";", declaration.end("variable"), start)
        if semicolon >= 0:
            return semicolon  # only the declaration of a function
        start += 1
    depth = 1
    for match in re.compile(r"[{}]").finditer(code, start):
        depth += 1 if match[0] == "{" else -1
        if not depth:
            return match.start()
    return len(code)


def _make_use(interface: LostInterface, name: str, code: str, start: int) -> InterfaceUse:
    line_start = code.rfind("\n", 0, start) + 1
    return InterfaceUse(interface, name, code.count("\n", 0, start) + 1, start - line_start + 1)
