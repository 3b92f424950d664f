"""The Chinese translation of common messages of other programs."""

from __future__ import annotations

import re
from xml.parsers import expat

import pytest
import yaml

from linkwright.diagnostics import LinkwrightError, foreign
from linkwright.diagnostics.translation import translate_phrase
from linkwright.launch.frontend.yaml import load

YAML_MISTAKES = {
    "a tab": "a:\n\tb: 1\n",
    "a tab in a later line": "a:\n  b: 1\n\tc: 2\n",
    "an indentation": "a:\n  b: 1\n c: 2\n",
    "an indentation below a value": "a: 1\n  b: 2\n",
    "no colon": "a:\n  b 1\n  c: 2\n",
    "no space after a colon": "a:\n  b:1\n  c: 2\n",
    "an open quote": 'a: "x\nb: 1\n',
    "a text after a quote": 'a: "x" y\n',
    "an open bracket": "a: [1, 2\nb: 3\n",
    "an open brace": "a: {x: 1\nb: 3\n",
    "a list that ends": "a:\n  - 1\n  b: 2\n",
    "a list in the line of its key": "a: - 1\n",
    "two commas": "a: [1, , 3]\n",
    "a percent sign": "a: %x\n",
    "an at sign": "a: @x\n",
    "a star": "a: *x\n",
    "a backslash": 'a: "\\q"\n',
    "a tag": "a: !x!y 1\n",
    "a second document": "a: 1\n...\nb\n---\n",
    "a control character": "a: \x01\n",
    "a list as a key": "? [a]\n: 1\n",
}
XML_MISTAKES = {
    "a tag that is not closed": "<robot><link></robot>",
    "no end": "<robot><link/>",
    "two roots": "<robot/><robot/>",
    "an attribute without quotes": "<robot name=r/>",
    "an attribute twice": "<robot name='a' name='b'/>",
    "an ampersand": "<robot name='a&nbsp;b'/>",
    "a prefix": "<robot><xacro:include/></robot>",
    "a line before the declaration": "\n<?xml version='1.0'?><robot/>",
    "an open tag": "<robot name='a'",
}


def translate(text: str) -> str:
    """Return the translation without the quoted parts."""
    return re.sub("“[^”]*”", "", translate_phrase(foreign(text), "zh"))


@pytest.mark.parametrize("loader", [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)])
@pytest.mark.parametrize("text", YAML_MISTAKES.values(), ids=YAML_MISTAKES)
def test_yaml_errors_are_translated(text: str, loader: type) -> None:
    with pytest.raises(yaml.YAMLError) as raised:
        yaml.load(text, Loader=loader)
    error = raised.value
    for foreign_text in (
        getattr(error, "problem", None) or getattr(error, "reason", None),
        getattr(error, "context", None),
    ):
        assert foreign_text is None or not re.search("[a-z]", translate(foreign_text)), (
            foreign_text,
            translate(foreign_text),
        )


@pytest.mark.parametrize("text", XML_MISTAKES.values(), ids=XML_MISTAKES)
def test_xml_errors_are_translated(text: str) -> None:
    parser = expat.ParserCreate(namespace_separator=" ")
    with pytest.raises(expat.ExpatError) as raised:
        parser.Parse(text, True)
    foreign_text = expat.ErrorString(raised.value.code)
    assert not re.search("[a-z]", translate(foreign_text).replace("xml", "")), (foreign_text, translate(foreign_text))


def test_quoted_parts_are_kept_and_unknown_texts_are_unchanged() -> None:
    assert (
        translate_phrase(foreign("found undefined alias 'speed'"), "zh")
        == "别名“speed”没有定义；以“*”开头的值请加上引号"
    )
    assert translate_phrase(foreign("expected ',' or ']', but got ':'"), "zh") == "缺少应有的“,”或“]”（遇到“:”）"
    for text in ("it isn't 'known'", "'a' is 'b'", "it isn't", ""):
        assert translate_phrase(foreign(text), "zh") == text
        assert translate_phrase(foreign(text), "en") == text


def test_launch_file_yaml_error_is_translated() -> None:
    with pytest.raises(LinkwrightError) as raised:
        load("launch:\n- node:\n    pkg: a\n   exec: b\n", "a.launch.yaml")
    (finding,) = raised.value.diagnostics
    assert not re.search("[a-z]", re.sub("“[^”]*”|YAML", "", translate_phrase(finding.message, "zh")))
    assert finding.span is not None
    assert finding.span.line == 4
