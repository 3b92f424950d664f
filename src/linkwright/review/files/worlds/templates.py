"""Read the XML of SDF models and worlds that are Jinja or empy templates."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.review.files.worlds.template_macros import find_macro_names, read_call
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

TEMPLATE_SUFFIXES = tuple(
    f".{kind}.{engine}" for kind in ("sdf", "world") for engine in ("jinja", "jinja2", "j2", "em", "template")
)
_STATEMENT = re.compile(r"\{%.*?%\}|\{#.*?#\}|@\[.*?\]@?(?=\s*$)|^\s*@#.*?$", re.DOTALL | re.MULTILINE)
_SET = re.compile(r"\{%[-+]?\s*set\s+(?P<name>[\w.]+)\s*=(?!=)\s*(?P<value>.*?)\s*[-+]?%\}", re.DOTALL)
_MACRO = re.compile(r"\{%[-+]?\s*macro\s+(?P<name>\w+)\s*\((?P<parameters>.*)\)\s*[-+]?%\}", re.DOTALL)
_END_OF_MACRO = re.compile(r"\{%[-+]?\s*endmacro\b[^%]*%\}")
_ANY_MACRO = re.compile(r"\{%[-+]?\s*macro\b")
_EXPRESSION = re.compile(r"\{\{(?P<content>.*?)\}\}", re.DOTALL)
_CALL = re.compile(r"(?<=>)(?P<before>\s*)\{\{-?(?P<content>[^{}]*?)-?\}\}(?=\s*(?:<|\{\{|\Z))", re.DOTALL)
"""An expression between tags, which may call a macro."""
_OPENING_TAG = re.compile(r"<(?!macro\b)(?P<name>[\w.-]+)[^<>]*(?<!/)>")
_DECLARATION = re.compile(r"<\?xml\b[^>]*>")
_STRING = re.compile(r"'(?:[^'\\]|\\.)*'|\"(?P<text>[^\"'\\]*)\"")
_ESCAPES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"}
_ROOTS = ("sdf", "gazebo")
"""The root tags of SDF files. The second tag is from versions before the name SDF."""


def is_template(path: str) -> bool:
    """Return whether a path is a template for SDF."""
    return PurePosixPath(path).name.endswith(TEMPLATE_SUFFIXES)


def read_template(file: str) -> list[Element]:
    """Return the elements of a template. Expressions remain as text.

    The result has the elements of all branches. A macro is an element ``<macro name="..." parameters="...">`` around
    its elements, and a variable that a statement sets is an element ``<set name="...">`` with the value. A call of a
    macro is an element ``<call name="...">`` with the arguments as children. The other statements and the XML
    declaration are left out. Line numbers match the file.

    Raises:
        LinkwrightError: the template is not XML without its statements, or the file cannot be read.
    """
    text = read_bytes(file).decode("utf-8", errors="replace")
    macro_names = find_macro_names(text)
    text = _replace_calls(_DECLARATION.sub(_blank_out, _replace_statements(text)), macro_names)
    text = _EXPRESSION.sub(_escape_expression, text)
    try:
        roots = list(parse_as_gazebo(f"<template>{text}</template>", file)[0].root.elements())
    except LinkwrightError:
        roots = [parse_as_gazebo(text, file)[0].root]
    return [child for element in roots for child in _unwrap_root(element)]


def may_be_equal(old: str | None, new: str | None) -> bool:
    """Return whether an expression that replaces a text, or vice versa, can equal it."""
    return old is not None and new is not None and old.count("{{") != new.count("{{")


def _unwrap_root(element: Element) -> Iterator[Element]:
    yield from element.elements() if element.tag in _ROOTS else (element,)


def _replace_statements(text: str) -> str:
    """Return a template with elements instead of macros and set variables.

    Other statements are blanked out, and so are statements in tags and comments.
    """
    markup = _EXPRESSION.sub(_blank_out, _STATEMENT.sub(_blank_out, text))
    open_macros: list[bool] = []

    def replace_statement(match: re.Match[str]) -> str:
        statement = match[0]
        is_between_tags = markup.rfind("<", 0, match.start()) <= markup.rfind(">", 0, match.start())
        result = ""
        if _END_OF_MACRO.fullmatch(statement):
            result = "</macro>" if open_macros and open_macros.pop() else ""
        elif _ANY_MACRO.match(statement):
            macro = _MACRO.fullmatch(statement) if is_between_tags else None
            open_macros.append(macro is not None)
            if macro is not None:
                parameters = _escape(_use_single_quotes(" ".join(macro["parameters"].split())))
                result = f'<macro name="{macro["name"]}" parameters="{parameters}">'
        elif is_between_tags and (variable := _SET.fullmatch(statement)):
            result = f'<set name="{variable["name"]}">{_escape(_use_single_quotes(variable["value"]))}</set>'
        return result + "\n" * (statement.count("\n") - result.count("\n")) if result else _blank_out(match)

    return _STATEMENT.sub(replace_statement, text)


def _replace_calls(text: str, macro_names: Collection[str]) -> str:
    """Return a template with elements in place of calls of macros between tags, also after another call."""
    previous = ""
    while text != previous:
        previous, text = text, _CALL.sub(lambda match: _replace_call(match, macro_names), text)
    return text


def _replace_call(match: re.Match[str], macro_names: Collection[str]) -> str:
    """Return an expression alone between tags as an element, if it calls a macro.

    The whole content of an element is its value.
    """
    tag = _OPENING_TAG.match(match.string, match.string.rfind("<", 0, match.start()))
    is_value = tag is not None and match.string[match.end() : match.end() + 200].lstrip().startswith(
        f"</{tag['name']}>"
    )
    call = None if is_value else read_call(_use_single_quotes(match["content"]), macro_names)
    if call is None:
        return match[0]
    name, arguments = call
    values = "".join(f"<{parameter}>{_escape(value)}</{parameter}>" for parameter, value in arguments)
    lines = "\n" * (match[0].count("\n") - match["before"].count("\n"))
    return f'{match["before"]}<call name="{name}">{values}</call>{lines}'


def _use_single_quotes(expression: str) -> str:
    """Return an expression with single quotes around its strings."""
    return _STRING.sub(lambda match: match[0] if match["text"] is None else f"'{match['text']}'", expression)


def _blank_out(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match[0])


def _escape_expression(match: re.Match[str]) -> str:
    return f"{{{{{_escape(_use_single_quotes(match['content']))}}}}}"


def _escape(text: str) -> str:
    return "".join(_ESCAPES.get(character, character) for character in text)
