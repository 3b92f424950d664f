"""The memory of a server over a long time.

``benchmarks/soak_editor.py`` does this for an hour.
"""

from __future__ import annotations

import psutil
import pytest
from lsprotocol import types

from tests.lsp.conftest import MAIN, connect_editor

FILE = "urdf/arm.urdf.xacro"


async def type_calls(editor, first: int, last: int) -> None:
    """Type calls of macros that do not exist, one name after the other."""
    for number in range(first, last):
        editor.change(FILE, MAIN.replace("xacro:bar", f"xacro:bar{number}") + f"<!-- {number} -->\n" * 200)
        if number % 5 == 0:
            await editor.until(FILE, "XAC401")
    editor.change(FILE, MAIN)
    await editor.until(FILE)


@pytest.mark.slow
async def test_memory_does_not_grow_with_number_of_edits(package):
    async with connect_editor(package, types.ClientCapabilities(), None, "--stdio") as editor:
        editor.open(FILE)
        await editor.until(FILE)
        server = psutil.Process(editor.server_id)
        await type_calls(editor, 0, 300)
        before = server.memory_info().rss
        await type_calls(editor, 300, 1500)
        assert (server.memory_info().rss - before) / 1e6 < 10
