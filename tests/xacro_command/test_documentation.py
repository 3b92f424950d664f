"""The examples of the page about xacro, compared with the program's output."""

from __future__ import annotations

import io
import shlex
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from tests.docs.pages import DOCS, Block, read_blocks

PAGES = [DOCS / "xacro.md", DOCS / "zh" / "xacro.md"]


def printed(block: Block, run) -> tuple[str, str]:
    """Return a block's standard output and standard error."""
    if block.language == "python":
        out = io.StringIO()
        with redirect_stdout(out):
            exec(compile(block.text, "page", "exec"), {})
        return out.getvalue(), ""
    _, verb, *words = shlex.split(block.text)
    assert verb == "xacro"
    result = run(*words)
    assert result.status == 0, result.err
    return result.out, result.err


@pytest.mark.parametrize("page", PAGES, ids=["en", "zh"])
def test_shown_outputs_are_current(page, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = read_blocks(page)
    files = [block for block in found if block.language == "xml"]
    for block in files:
        Path(block.title).write_text(block.text, encoding="utf-8")
    shown = 0
    for block, following in zip(found, [*found[1:], None], strict=True):
        if block.language not in ("bash", "python"):
            continue
        out, err = printed(block, run)
        if following is not None and following.language == "text":
            assert following.text == (err if following.title else out)
            shown += 1
    assert len(files) == 2
    assert shown == 4
