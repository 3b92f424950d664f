"""Words that Linkwright does not use.

The glossary matches the list of refused patterns, and the tool finds them.
"""

from __future__ import annotations

import re

import pytest

from tests.docs.pages import DOCS
from tests.repository_tools import load_tool

GLOSSARY = DOCS / "glossary.md"
TOOL = load_tool("plain_words")


def table_rows(text: str) -> list[list[str]]:
    """Return the cells of all rows of the tables with four columns."""
    all_rows = [
        [cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")
    ]
    return [row for row in all_rows if len(row) == 4 and not set(row[0]) <= set("- ")]


def test_words_ruled_out_by_glossary_are_refused():
    ruled_out = [
        word
        for *_, words in table_rows(GLOSSARY.read_text(encoding="utf-8"))
        for word in words.split(", ")
        if word not in ("", "not")
    ]
    assert "picture" in ruled_out
    refused, _ = TOOL.read_table()
    assert [
        word for word in ruled_out if not any(refusal.matches(f"It has a {word} here") for refusal in refused)
    ] == []


def test_both_glossaries_list_same_words():
    chinese = table_rows((DOCS / "zh" / "glossary.md").read_text(encoding="utf-8"))
    english = [row[0] for row in table_rows(GLOSSARY.read_text(encoding="utf-8")) if row[0] != "word"]
    assert [row[1] for row in chinese if row[1] != "英文"] == [
        word for word in english if word != "user, subscriber, node"
    ]


@pytest.mark.parametrize(
    ("name", "text", "line", "words"),
    [
        ("a.py", 'X = 1\n\n\ndef f():\n    """Return what was sent to somebody."""\n', 5, ["somebody", "what was"]),
        ("a.py", "X = 1  # a picture of it\n", 1, ["picture"]),
        ("a.py", 'phrase("the file is "\n       "no YAML")\n', 1, ["is no "]),
        ("a.ts", "/** The pages, each\n * drawn anew. */\n", 1, ["anew"]),
        ("a.ts", 'const title = "go on";\n', 1, ["go on"]),
        ("a.ts", "const title = `${name} is no robot`;\n", 1, ["is no "]),
    ],
)
def test_refused_words_are_reported_with_line(tmp_path, capsys, monkeypatch, name, text, line, words):
    monkeypatch.setattr(TOOL, "ROOT", tmp_path)
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert TOOL.main([str(tmp_path)]) == 1
    output = capsys.readouterr().out.splitlines()
    assert [re.match(rf"{name}:{line}: '(.*)'; write: .", row)[1] for row in output] == [word.strip() for word in words]


def test_plain_sentences_pass(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(TOOL, "ROOT", tmp_path)
    text = '"""Return the joint positions at a time.\n\nThere is no limit, and no longer any need for one.\n"""\n'
    (tmp_path / "a.py").write_text(text, encoding="utf-8")
    assert TOOL.main([str(tmp_path)]) == 0
    assert capsys.readouterr().out == ""


def test_accepted_words_pass_and_unused_exception_is_reported(tmp_path, capsys, monkeypatch):
    source = tmp_path / "src"
    source.mkdir()
    (source / "a.py").write_text('raise ValueError("this is no node")\n', encoding="utf-8")
    table = tmp_path / "table.toml"
    table.write_text(
        "[[refused]]\npattern = 'is no '\nplain = 'is not a'\n"
        "[[accepted]]\npath = 'a.py'\nwords = 'is no node'\nbecause = 'ROS prints it'\n",
        encoding="utf-8",
    )
    for name, value in {"ROOT": tmp_path, "REFUSED": table, "PACKAGE": source, "PAGE": tmp_path / "page"}.items():
        monkeypatch.setattr(TOOL, name, value)
    assert TOOL.main([]) == 0
    (source / "a.py").write_text('raise ValueError("this is not a node")\n', encoding="utf-8")
    assert TOOL.main([]) == 1
    assert capsys.readouterr().out == "a.py: no text needs the exception 'is no node'\n"
