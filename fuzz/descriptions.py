"""Descriptions that mostly make sense, made from choices, for comparison with the other engine.

What the grammar of `fuzz.documents` makes is mostly wrong, which is right for finding crashes; to find differences,
most names must be defined and most values of a fitting kind.
"""

from __future__ import annotations

from fuzz.choices import Choices
from fuzz.samples import CONDITIONS, EXPRESSIONS, GAPS, NAMES, SUBSTITUTIONS, VALUES

HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">'
_OPERATORS = ["+", "*", "==", "and", "or", "-", "%", "if a else"]
_BLOCK_MACRO = (
    '<xacro:macro name="blk" params="p *one **two"><w><xacro:insert_block name="one"/>'
    '<xacro:insert_block name="two"/></w></xacro:macro>'
)


def description(choices: Choices) -> tuple[dict[str, str], dict[str, str]]:
    """Return files by name, the first of them main.xacro, and the arguments."""
    maker = _Maker(choices)
    start = choices.pick(
        ["", '<?xml version="1.0"?>\n', '<?xml version="1.0" encoding="UTF-8"?>\n<!-- top -->\n', "<!-- top -->"]
    )
    prelude = maker.prelude()
    body = "".join(maker.gap() + maker.node(0) for _ in range(1 + choices.pick([0, 0, 1, 1, 2, 3, 6])))
    end = choices.pick(["", "\n", "\n<!-- after -->\n", "<?pi x?>"])
    main = f"{start}{HEAD}{prelude}{body}{maker.gap()}</robot>{end}"
    other = HEAD + "".join(maker.gap() + maker.node(2) for _ in range(choices.number(5))) + "</robot>"
    inner = "<robot>" + "".join(maker.gap() + maker.node(4) for _ in range(choices.number(3))) + "</robot>"
    files = {
        "main.xacro": main,
        "other.xacro": other,
        "sub/inner.xacro": inner.replace("<robot>", HEAD),
        "pkg/part.xacro": f'{HEAD}<xacro:macro name="part" params="v:=1"><part v="${{v}}"/></xacro:macro></robot>',
        "data.yaml": "p: 1\nq: {r: yes, s: 1e3, t: !degrees 90}\nl: [1, 2.50, 'x', ~, 012]\nkeys: k\n",
    }
    given = (
        {}
        if choices.chance(2)
        else {"s": choices.pick(["v", "1", "true", "a b", "é", "${1+1}", "$(find pkg)", "", "'q'"])}
    )
    return files, given


class _Maker:
    def __init__(self, choices: Choices) -> None:
        self.choices = choices
        self.pick = choices.pick

    def prelude(self) -> str:
        parts = [
            '<xacro:arg name="n" default="3"/>',
            f'<xacro:arg name="s" default="{self.pick(["text", "1.50", "${1+1}", "true"])}"/>',
            '<xacro:arg name="flag" default="true"/>',
            f'<xacro:property name="a" value="{self.pick(["1"] * 40 + VALUES)}"/>',
            f'<xacro:property name="b" value="{self.pick(["2.0"] * 40 + VALUES)}"/>',
            f'<xacro:property name="c" value="{self.text() if self.choices.chance(3) else "text"}"/>',
            '<xacro:property name="lst" value="${[3,1,2]}"/>',
            '<xacro:property name="data" value="${xacro.load_yaml(\'data.yaml\')}"/>',
            '<xacro:macro name="m" params="x y:=2 z:=^|7"><m x="${x}" y="${y}" z="${z}"/></xacro:macro>',
            _BLOCK_MACRO,
            '<xacro:include filename="$(find pkg)/part.xacro" ns="ns"/>',
        ]
        return "".join(self.gap() + part for part in parts if not self.choices.chance(100))

    def gap(self) -> str:
        gap = self.pick(GAPS)
        if self.choices.chance(5):
            gap += (
                f"<!--{self.pick([' c ', '${a}', 'xacro:eval-comments', ' xacro:eval-comments:off', '${', '$$x'])}-->"
                + self.pick(GAPS)
            )
        return gap

    def text(self) -> str:
        kind = self.choices.number(8)
        if kind <= 3:
            return "${" + self.expression() + "}"
        if kind == 4:
            return f"$({self.pick(SUBSTITUTIONS)})"
        if kind == 5:
            return self.pick(VALUES)
        joined = "".join(self.text() for _ in range(1 + self.choices.number(3)))
        return self.pick(
            [
                joined,
                f" {joined} ",
                f"a{joined}",
                "$$" + joined,
                "$" + joined,
                f"${{'$(arg n)' + {self.expression()}}}",
                "a&amp;b&lt;",
                "&quot;'",
                "&#10;x",
                "&#9;",
            ]
        )

    def expression(self) -> str:
        expression = self.pick(EXPRESSIONS)
        if self.choices.chance(5):
            expression = f"{expression} {self.pick(_OPERATORS)} {self.pick(EXPRESSIONS)}"
        return (
            expression.replace('"', "&quot;").replace("< ", "&lt; ").replace("<<", "&lt;&lt;").replace("a<b", "a&lt;b")
        )

    def node(self, depth: int) -> str:
        if depth > 5:
            return "<leaf/>"
        kinds = (
            *(self.element, self.element, self.element, self.property, self.property, self.macro, self.call, self.call),
            *(
                self.condition,
                self.condition,
                self.include,
                self.blocks,
                self.made,
                self.odd,
                self.characters,
                self.loop,
            ),
        )
        return self.pick(kinds)(depth + 1)

    def inside(self, depth: int) -> str:
        count = self.choices.number(4)
        return "".join(self.gap() + self.node(depth) for _ in range(count)) + (self.gap() if count else "")

    def element(self, depth: int) -> str:
        attributes = "".join(f' {name}="{self.text()}"' for name in ["v", "b", "a"][: self.choices.number(4)])
        return f"<e{attributes}>{self.inside(depth)}</e>" if self.choices.chance(2) else f"<e{attributes}/>"

    def characters(self, _depth: int) -> str:
        return self.pick(
            [
                "text",
                "${a}",
                " ${a} and ${b} ",
                "\n  t\n",
                "<![CDATA[${a}]]>",
                "a&amp;b",
                "x &gt; y",
                "<?pi ${a}?>",
                "$(arg n)",
            ]
        )

    def property(self, depth: int) -> str:
        name = self.pick([*NAMES, "pi", "e", "new", "p${1+1}", "é", "1x", "class", "a.b", "_u", "__d"])
        extra = self.pick(
            [
                "",
                "",
                "",
                "",
                ' lazy_eval="false"',
                ' scope="global"',
                ' scope="parent"',
                ' lazy_eval="true"',
                ' odd="1"',
            ]
        )
        kind = self.choices.number(10)
        if kind == 8:
            return f'<xacro:property name="{name}"{extra}>{self.inside(depth)}</xacro:property>'
        if kind == 9:
            return f'<xacro:property name="{name}" remove="{self.pick(["true", "false", "${1}", "0"])}"/>'
        return f'<xacro:property name="{name}" {"default" if kind == 7 else "value"}="{self.text()}"{extra}/>'

    def macro(self, depth: int) -> str:
        parameters = self.pick(
            [
                *(
                    "x",
                    "x y",
                    "x:=1 y",
                    "x:=${a} y:=${b}",
                    "x:=^ y:=^|3",
                    "x='a b' y:='c'",
                    "x y *one",
                    "x **one y:=''",
                    "x:=$(arg n)",
                ),
                *(
                    "x y:=[1,2]",
                    "x y:=${[1,2]}",
                    "x = 5 y",
                    "",
                    "x:=true y:=007",
                    "*one *two",
                    "x y:=a_b",
                    "x\n   y:=1",
                    "a:=^|5 x:=${a}",
                ),
                *("x y:='${a} b'", "x y:=${a}cm", "x:=a=b", "x, y", "x y:=^|", "x y:=1:2", "x x", "x:='it' y:='\"'"),
            ]
        )
        name, parameters = self.pick(["m", "k", "f"]), parameters.replace('"', "&quot;")
        return f'<xacro:macro name="{name}" params="{parameters}">{self.inside(depth)}</xacro:macro>'

    def call(self, depth: int) -> str:
        name = self.pick(["m", "m", "k", "f", "blk", "ns.part", "part", "inc.m"])
        attributes = "".join(f' {key}="{self.text()}"' for key in ["x", "y", "z"][: self.choices.number(4)])
        if name == "blk":
            attributes = ' p="1"'
        if name.endswith("part"):
            attributes = f' v="{self.text()}"' if self.choices.chance(2) else ""
        inside = self.inside(depth) if name == "blk" or self.choices.chance(6) else ""
        if self.choices.chance(8):
            return f'<xacro:call macro="{self.pick([name, "${" + repr(name) + "}"])}"{attributes}>{inside}</xacro:call>'
        return f"<xacro:{name}{attributes}>{inside}</xacro:{name}>"

    def condition(self, depth: int) -> str:
        tag = self.pick(["if", "unless"])
        return f'<xacro:{tag} value="{self.pick(CONDITIONS)}">{self.inside(depth)}</xacro:{tag}>'

    def include(self, _depth: int) -> str:
        return self.pick(
            [
                '<xacro:include filename="other.xacro"/>',
                '<xacro:include filename="other.xacro" ns="inc"/>',
                '<xacro:include filename="sub/inner.xacro"/>',
                '<xacro:include filename="sub/*.xacro"/>',
                '<xacro:include filename="none*.xacro"/>',
                '<xacro:include filename="missing.xacro" optional="true"/>',
                '<xacro:include filename="$(find pkg)/part.xacro"/>',
                '<xacro:include filename="missing.xacro"/>',
                "<xacro:include filename=\"${'sub'}/inner.xacro\" ns=\"${'q'}\"/>",
            ]
        )

    def blocks(self, _depth: int) -> str:
        return f'<xacro:insert_block name="{self.pick([*NAMES, "one", "two", "new"])}"/>'

    def made(self, depth: int) -> str:
        if self.choices.chance(2):
            return f'<e><xacro:attribute name="{self.pick(["v", "${str(a)}", "w"])}" value="x{self.text()}"/></e>'
        name = self.pick(["t", "${str(c)}", "xacro:if", "xacro:m"])
        return f'<xacro:element xacro:name="{name}" value="1" x="2">{self.inside(depth)}</xacro:element>'

    def odd(self, _depth: int) -> str:
        return self.pick(
            [
                *(
                    '<property name="a" value="1"/>',
                    '<xs:q xmlns:xs="u" v="${a}"/>',
                    '<e xacro:x="${a}" b="1"/>',
                    "<if>${a}</if>",
                ),
                *(
                    '<e xmlns:xacro="other"/>',
                    "<xacro:nothing/>",
                    '<e v="a\nb\tc"/>',
                    "<e>a\nb</e>",
                    "<e> </e>",
                    "<e>\n</e>",
                    "<e>${''}</e>",
                ),
            ]
        )

    def loop(self, depth: int) -> str:
        return (
            '<xacro:macro name="loop" params="items:=^"><xacro:if value="${items}">'
            '<xacro:property name="x" value="${items.pop(0)}"/><i v="${x}"/>'
            f"{self.inside(depth)}<xacro:loop/></xacro:if>"
            '</xacro:macro><xacro:property name="items" value="${[1, 2]}"/><xacro:loop/>'
        )
