"""The page for the code of a finding, and the hover over a code in a suppression comment."""

from __future__ import annotations

import pytest
from lsprotocol import types

from tests.lsp.conftest import MAIN, OPENS_PAGES, connect_editor

FILE = "urdf/arm.urdf.xacro"
BROKEN = MAIN.replace('  <link name="base"/>', '  <link name="base"/>\n  <xacro:nothing/>')


async def test_finding_code_links_to_rule_page(package):
    async with connect_editor(package, OPENS_PAGES) as editor:
        editor.open(FILE, BROKEN)
        (finding,) = await editor.until(FILE, "XAC401")
        parameters = types.TextDocumentContentParams(finding.code_description.href)
        page = await editor.client.workspace_text_document_content_async(parameters)
        assert page.text.startswith("# XAC401: ")


async def test_editor_without_virtual_documents_gets_no_link(editor):
    editor.open(FILE, BROKEN)
    (finding,) = await editor.until(FILE, "XAC401")
    assert finding.code_description is None


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (FILE, MAIN.replace("  <link", "  <!-- linkwright: ignore LW104 (as built) -->\n  <link", 1)),
        ("CMakeLists.txt", "project(arm)\n# linkwright: ignore LW104\nament_package()\n"),
    ],
)
async def test_hover_of_suppressed_code_shows_rule(editor, name, text):
    editor.open(name, text)
    offset = text.index("LW104") + 2
    place = types.Position(text.count("\n", 0, offset), offset - text.rfind("\n", 0, offset) - 1)
    hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(name), place))
    assert hover.contents.value.startswith("# LW104: ")
    assert "## Why" in hover.contents.value
