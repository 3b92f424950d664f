"""Documents that attack the reader."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.xmltree import parse


def refusal(text: str) -> Diagnostic:
    with pytest.raises(LinkwrightError) as caught:
        parse(text, "x")
    return caught.value.diagnostics[0]


def test_billion_laughs_is_rejected() -> None:
    entities = '<!ENTITY e0 "ha">' + "".join(f'<!ENTITY e{n + 1} "{f"&e{n};" * 10}">' for n in range(10))
    diagnostic = refusal(f"<!DOCTYPE r [{entities}]><r>&e10;</r>")
    assert diagnostic.code == "XML209"
    assert "expand to more than" in diagnostic.message


def test_quadratic_blowup_is_rejected() -> None:
    diagnostic = refusal(f'<!DOCTYPE r [<!ENTITY e "{"x" * 50_000}">]><r>{"&e;" * 1_000}</r>')
    assert diagnostic.code == "XML209"


def test_long_chain_of_entities_is_rejected() -> None:
    entities = '<!ENTITY e0 "x">' + "".join(f'<!ENTITY e{n + 1} "&e{n};">' for n in range(3_000))
    assert refusal(f"<!DOCTYPE r [{entities}]><r>&e3000;</r>").code.startswith("XML")


def test_recursive_entities_are_rejected() -> None:
    assert refusal('<!DOCTYPE r [<!ENTITY a "&b;"><!ENTITY b "&a;">]><r>&a;</r>').code.startswith("XML")


def test_external_entities_are_rejected(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("secret", encoding="utf-8")
    diagnostic = refusal(f'<!DOCTYPE r [<!ENTITY e SYSTEM "file://{secret}">]>\n<r>\n&e;</r>')
    assert diagnostic.code == "XML209"
    assert diagnostic.span is not None
    assert (diagnostic.span.line, diagnostic.span.column) == (3, 1)


def test_entities_of_external_doctype_are_rejected() -> None:
    assert refusal('<!DOCTYPE r SYSTEM "http://example.invalid/x.dtd"><r>&e;</r>').code == "XML209"


def test_ordinary_entities_are_expanded() -> None:
    entities = "".join(f'<!ENTITY e{n} "{n}">' for n in range(100))
    root = parse(f"<!DOCTYPE r [{entities}]><r>{''.join(f'&e{n};' for n in range(100))}</r>", "x").root
    assert root.text() == "".join(map(str, range(100)))
