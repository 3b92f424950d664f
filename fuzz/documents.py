"""Documents of the xacro language, made from choices: a main file, a second one to include, and a YAML file."""

from __future__ import annotations

from typing import NamedTuple

from fuzz.choices import Choices
from fuzz.expressions import NAMES, expression

HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
MACROS = ["m", "k", "ns.m", "inner", "call", "other", "ns.other", "xacro:m"]
LITERALS = [
    "1",
    "",
    "a",
    "true",
    "False",
    "0.5",
    "007",
    "'5'",
    " 5 ",
    "1_0",
    "nan",
    "1e2",
    "a b",
    "é",
    "日本",
    "-0",
    "TRUE",
]
SUBSTITUTIONS = [
    *("arg name", "arg n", "arg", "find pkg", "find missing", "optenv A b c", "optenv", "env LINKWRIGHT_UNSET", "cwd"),
    *("dirname", "eval 1+1", "eval n", "anon x", "", "arg ${name}", "find  pkg", "eval __x", "arg undeclared"),
]
PARAMETERS = [
    *(
        "a",
        "a b",
        "a:=1",
        "a:=^",
        "a:=^|2",
        "*a",
        "**a",
        "*b **n",
        "a:=${n+1} b",
        "a=1 b:='x y'",
        "a:=$(arg name) b:=''",
    ),
    *("a a", "a:=", "a := 1", "a:=^|${n}", "a:='", "a:=$(find pkg)/b", "a:=[] b:=(1)", 'a:="x y"', "ns m", "é:=1"),
]
CHARACTERS = [
    "text",
    "",
    " ",
    "\n",
    "\n\n",
    "$",
    "$$",
    "$${a}",
    "$5",
    "&amp;",
    "&lt;",
    "&#228;",
    "é",
    "]]&gt;",
    "\t",
    "\r\n",
]


class Files(NamedTuple):
    """The files of one description."""

    main: str
    other: str
    data: str


def files(choices: Choices) -> Files:
    """Return a description of up to three files."""
    main = _document(choices)
    other = _document(choices) if choices.left else f"{HEAD}/>"
    return Files(main, other, yaml_text(choices))


def text(choices: Choices) -> str:
    """Return the text of an attribute: expressions and substitutions among plain text."""
    parts = []
    for _ in range(1 + choices.number(3)):
        kind = choices.number(6)
        if kind == 0:
            parts.append(choices.pick(LITERALS))
        elif kind == 1:
            parts.append(f"$({choices.pick(SUBSTITUTIONS)})")
        elif kind == 2:
            parts.append(_escaped(choices.pick(CHARACTERS).replace("&amp;", "&").replace("&lt;", "<")))
        else:
            parts.append(_escaped("${" + expression(choices) + "}"))
    return "".join(parts)


def yaml_text(choices: Choices) -> str:
    """Return a small YAML file."""
    keys = ["a", "b", "p", "q"][: choices.number(5)]
    return "\n".join(f"{key}: {_yaml_value(choices, 0)}" for key in keys)


def _yaml_value(choices: Choices, depth: int) -> str:
    kind = choices.number(8) if depth < 4 else 0
    if kind == 1:
        return f"[{', '.join(_yaml_value(choices, depth + 1) for _ in range(choices.number(4)))}]"
    if kind == 2:
        pairs = (f"{key}: {_yaml_value(choices, depth + 1)}" for key in ["x", "keys", "1", "get"][: choices.number(5)])
        return f"{{{', '.join(pairs)}}}"
    if kind == 3:
        tag = choices.pick(
            ["!degrees", "!radians", "!inches", "!meters", "!x", "!!python/object:a.b", "!!int", "!!set"]
        )
        return f"{tag} {choices.pick(['90', 'pi/2', '1+', 'undefined', '1e999', '[1]', 'a: b', '{1: 2}'])}"
    if kind == 4:
        return choices.pick(["&a [1]", "*a", "&a {<<: *a}", "*undefined", "|\n  block", ">-\n  folded", "&a [*a]"])
    return choices.pick(["1", "yes", "012", "1e3", "2001-01-01", "~", "a", "'q'", "1_000", "0x1F", ".inf", "1:30", "é"])


def _document(choices: Choices) -> str:
    start = choices.pick(["", '<?xml version="1.0"?>\n', "<!-- a comment -->", "<!DOCTYPE robot>", "\n", "\ufeff"])
    if choices.chance(10):
        start = '<!DOCTYPE robot [<!ENTITY a "b"><!ENTITY c "&a;&a;">]>'
    name = f' name="{text(choices)}"' if choices.chance(4) else ' name="r"'
    body = "".join(_node(choices, 0) for _ in range(1 + choices.number(8)))
    end = choices.pick(["</robot>", "</robot>\n<!-- end -->", "</robot>", "", "</robt>"])
    if choices.chance(20):
        return f"{start}<robot{name}>{body}{end}"
    return f"{start}{HEAD}{name}>{body}{end}"


def _node(choices: Choices, depth: int) -> str:
    if depth > 5 or choices.left == 0:
        return "<link/>"
    make = choices.pick(_NODES)
    return make(choices, depth + 1)


def _inside(choices: Choices, depth: int) -> str:
    return "".join(_node(choices, depth) for _ in range(choices.number(4)))


def _element(choices: Choices, depth: int) -> str:
    tag = choices.pick(["link", "joint", "origin", "xs:a", "a"])
    declared = ' xmlns:xs="u"' if tag == "xs:a" and choices.chance(2) else ""
    attributes = "".join(f' {name}="{text(choices)}"' for name in ["name", "v", "xyz"][: choices.number(4)])
    return f"<{tag}{declared}{attributes}>{_inside(choices, depth)}</{tag}>"


def _characters(choices: Choices, _depth: int) -> str:
    return choices.pick(CHARACTERS) if choices.chance(2) else text(choices)


def _comment(choices: Choices, _depth: int) -> str:
    inside = choices.pick(
        [" c ", "xacro:eval-comments", " xacro:eval-comments:off ", " ${n} ", " ${ ", "a\nb", " -", "x-"]
    )
    return choices.pick(["", "\n", "\n\n"]) + f"<!--{inside}-->"


def _property(choices: Choices, depth: int) -> str:
    name = choices.pick(NAMES) if not choices.chance(10) else text(choices)
    extra = choices.pick(
        [
            "",
            "",
            "",
            ' lazy_eval="false"',
            ' scope="parent"',
            ' scope="global"',
            ' remove="true"',
            ' x="1"',
            ' scope="?"',
        ]
    )
    kind = choices.number(6)
    if kind == 0:
        return f'<xacro:property name="{name}"{extra}>{_inside(choices, depth)}</xacro:property>'
    attribute = "default" if kind == 1 else "value"
    return f'<xacro:property name="{name}" {attribute}="{text(choices)}"{extra}/>'


def _argument(choices: Choices, _depth: int) -> str:
    return f'<xacro:arg name="{choices.pick(["name", "n", "a", "é", ""])}" default="{text(choices)}"/>'


def _macro(choices: Choices, depth: int) -> str:
    parameters = " ".join(choices.pick(PARAMETERS) for _ in range(choices.number(3)))
    declared = choices.pick(["", "", "", ' xmlns:xs="v"', ' odd="${n}"'])
    parameters = parameters.replace('"', "&quot;")
    name = choices.pick(MACROS)
    return f'<xacro:macro name="{name}" params="{parameters}"{declared}>{_inside(choices, depth)}</xacro:macro>'


def _call(choices: Choices, depth: int) -> str:
    names = ["a", "b", "n", "ns", "a:b"][: choices.number(4)]
    attributes = "".join(f' {name}="{text(choices)}"' for name in names)
    if choices.chance(6):
        return f'<xacro:call macro="{text(choices)}"{attributes}>{_inside(choices, depth)}</xacro:call>'
    tag = f"xacro:{choices.pick(MACROS[:-1])}"
    return f"<{tag}{attributes}>{_inside(choices, depth)}</{tag}>"


def _condition(choices: Choices, depth: int) -> str:
    tag = choices.pick(["xacro:if", "xacro:unless"])
    return f'<{tag} value="{text(choices)}">{_inside(choices, depth)}</{tag}>'


def _include(choices: Choices, _depth: int) -> str:
    name = choices.pick(
        ["other.xacro", "missing.xacro", "*.xacro", "./other.xacro", "$(find pkg)/other.xacro", "none*", ""]
    )
    extra = choices.pick(["", "", ' ns="ns"', ' optional="true"', ' optional="x"', ' ns="${name}"', ' ns="pi"'])
    return f'<xacro:include filename="{name}"{extra}/>'


def _block(choices: Choices, _depth: int) -> str:
    return f'<xacro:insert_block name="{choices.pick(NAMES)}"/>'


def _made_element(choices: Choices, depth: int) -> str:
    return f'<xacro:element xacro:name="{text(choices)}" v="1">{_inside(choices, depth)}</xacro:element>'


def _made_attribute(choices: Choices, _depth: int) -> str:
    return f'<xacro:attribute name="{choices.pick(["v", "", "a b", "xmlns:q", "${name}"])}" value="{text(choices)}"/>'


def _odd(choices: Choices, _depth: int) -> str:
    return choices.pick(
        [
            *(
                "<![CDATA[${n} <a>]]>",
                "<?pi ${n}?>",
                "<xacro:undefined/>",
                "<xacro:include/>",
                "<xacro:property/>",
                "&a;",
            ),
            *(
                "&c;",
                "&undefined;",
                "<a><b></a>",
                '<a v="1" v="2"/>',
                "<a v=1/>",
                "<xacro:if/>",
                "<xacro:",
                "\x00",
                "&",
            ),
            *('<xacro:property name="data" value="${xacro.load_yaml(\'data.yaml\')}"/>', "<property/>", "<q:x/>"),
        ]
    )


def _loop(choices: Choices, depth: int) -> str:
    name = choices.pick(["loop", "k"])
    return (
        f'<xacro:macro name="{name}" params="items:=^"><xacro:if value="${{items}}">'
        '<xacro:property name="x" value="${items.pop(0)}"/>'
        f"{_inside(choices, depth)}<xacro:{name}/></xacro:if></xacro:macro>"
        f'<xacro:property name="items" value="${{[1, 2, {choices.number(9)}]}}"/><xacro:{name}/>'
    )


_NODES = [
    *(
        _element,
        _element,
        _characters,
        _comment,
        _property,
        _property,
        _property,
        _argument,
        _macro,
        _macro,
        _call,
        _call,
    ),
    *(_condition, _include, _block, _made_element, _made_attribute, _odd, _loop),
]


def _escaped(written: str) -> str:
    return written.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
