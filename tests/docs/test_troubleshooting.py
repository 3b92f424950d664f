"""The messages on the troubleshooting pages, compared with the program's messages."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.docs.pages import read_blocks
from tests.repository_tools import load_tool

TOOL = load_tool("documented_output")


@pytest.mark.skipif(sys.version_info < (3, 11), reason="Python 3.10 has no columns for launch files")
@pytest.mark.parametrize("page", TOOL.PAGES, ids=["en", "zh"])
def test_shown_output_is_current(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert text == TOOL.refresh_page(text, TOOL.get_language(page)), "run tools/documented_output.py"


def test_both_languages_show_same_cases() -> None:
    english, chinese = map(read_blocks, TOOL.PAGES)
    assert [block.language for block in english].count("text") >= 6
    for english_block, chinese_block in zip(english, chinese, strict=True):
        if english_block.language == "text":
            assert language_independent(chinese_block.text) == language_independent(english_block.text)
            assert chinese_block.text.startswith("错误[")
        else:
            assert chinese_block == english_block


def language_independent(output: str) -> list[str]:
    """Return the language-independent part of an output.

    This part has codes, locations, excerpts with carets, and the number of notes and hints.
    """
    output = re.sub(r"^(\d+) (?:errors?, |个错误，)(\d+) (?:warnings?|个警告)$", r"\1 \2", output, flags=re.MULTILINE)
    lines = [re.sub(r"^\S+(\[\w+\]).*", r"\1", line) for line in output.splitlines()]
    return [re.sub(r"^   = .*?( \(\S+\))?$", r"=\1", line) for line in lines]


def test_stale_page_is_found_and_fixed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "# Page\n\n## Case\n\n"
        '```xml title="r.urdf"\n<robot name="r">\n```\n\n'
        "```bash\nlinkwright check r.urdf\n```\n\n"
        "```text\nold\n```\n\nThe end.\n",
        encoding="utf-8",
    )
    monkeypatch.setattr(TOOL, "PAGES", [page])
    assert TOOL.main(["--check"]) == 1
    assert TOOL.main([]) == 0
    text = page.read_text(encoding="utf-8")
    assert "```text\nerror[XML" in text
    assert text.endswith("```\n\nThe end.\n")
    assert TOOL.main(["--check"]) == 0


def test_command_without_failure_is_rejected() -> None:
    with pytest.raises(RuntimeError, match="exited with 0"):
        TOOL.run_command(["--version"], [])
