"""The expansion of a description as a virtual document."""

from __future__ import annotations

from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.lsp.requests.expansions import expansion_uri, parse_expansion_uri
from tests.lsp.conftest import MAIN, MANIFEST, PARTS
from tests.lsp.test_hints import FILE, PARTS_FILE, position_after


async def request_content(editor, uri: str) -> str:
    content = await editor.client.workspace_text_document_content_async(types.TextDocumentContentParams(uri))
    return content.text


def test_expansion_uri_contains_description_and_arguments(tmp_path: Path):
    file = tmp_path / "机 器.urdf.xacro"
    file.touch()
    arguments = {"side": "left & right", "path": "/a/b"}
    assert parse_expansion_uri(expansion_uri(file.resolve(), arguments)) == (file.resolve(), arguments)
    assert parse_expansion_uri(file.as_uri()) is None


async def test_editor_without_virtual_documents_gets_no_expansion(editor):
    editor.open(FILE)
    parameters = types.ImplementationParams(editor.document(FILE), position_after(MAIN, '<link name="base"'))
    assert not await editor.client.text_document_implementation_async(parameters)


async def test_manifest_has_no_expansion(editor_with_pages):
    editor = editor_with_pages
    editor.open("package.xml")
    parameters = types.ImplementationParams(editor.document("package.xml"), position_after(MANIFEST, "<export>"))
    assert not await editor.client.text_document_implementation_async(parameters)


async def test_implementation_request_links_element_and_expansions(editor_with_pages):
    editor = editor_with_pages
    text = MAIN.replace("</robot>", '  <xacro:bar name="lower" length="0.3"/>\n</robot>')
    editor.open(FILE, text)
    editor.open(PARTS_FILE)
    place = position_after(PARTS, "<axis")
    implementations = await editor.client.text_document_implementation_async(
        types.ImplementationParams(editor.document(PARTS_FILE), place)
    )
    assert len(implementations) == 2
    uri = implementations[0].uri
    expansion = await request_content(editor, uri)
    lines = expansion.splitlines()
    assert [lines[location.range.start.line].strip() for location in implementations] == ['<axis xyz="0 0 1"/>'] * 2
    assert '<link name="lower"/>' in expansion
    (source,) = await editor.client.text_document_definition_async(
        types.DefinitionParams(types.TextDocumentIdentifier(uri), implementations[1].range.start)
    )
    assert source.uri == editor.uri(PARTS_FILE)
    assert source.range.start.line == place.line


async def test_expansion_of_invalid_description_is_its_error(editor):
    editor.open(FILE, MAIN.replace("xacro:bar", "xacro:baz"))
    uri = editor.uri(FILE).replace("file:", "linkwright-expansion:")
    with pytest.raises(JsonRpcException, match="there is no macro 'baz'"):
        await request_content(editor, uri)
