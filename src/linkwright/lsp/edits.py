"""Convert edits to the protocol, with the versions of the open texts."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from os.path import commonprefix
from pathlib import Path

from lsprotocol import types

from linkwright.language.proof import Edit
from linkwright.lsp.server import LinkwrightServer


def to_workspace_edit(server: LinkwrightServer, edits: Iterable[Edit]) -> types.WorkspaceEdit:
    """Convert edits for the editor, with the versions of the open files.

    The editor rejects the edits if a file has another version.
    """
    changes: list[types.TextDocumentEdit | types.CreateFile | types.RenameFile | types.DeleteFile] = []
    for file, file_edits in groupby(sorted(edits), key=lambda edit: edit.file):
        positions = server.positions(file)
        if positions is not None:
            uri = server.uri_of(file)
            document = server.workspace.text_documents.get(uri)
            version = None if document is None else document.version
            changes.append(
                types.TextDocumentEdit(
                    types.OptionalVersionedTextDocumentIdentifier(uri, version),
                    [types.TextEdit(positions.range(edit.start, edit.end), edit.text) for edit in file_edits],
                )
            )
    return types.WorkspaceEdit(document_changes=changes)


def make_replacement(file: Path, old: str, new: str) -> Edit:
    """Return the edit that replaces the differing part of a text."""
    start = len(commonprefix([old, new]))  # noqa: RUF071 - it compares characters
    end = len(commonprefix([old[start:][::-1], new[start:][::-1]]))  # noqa: RUF071 - it compares characters
    return Edit(file, start, len(old) - end, new[start : len(new) - end])


def new_file_edit(uri: str, text: str) -> types.WorkspaceEdit:
    """Return the edit that creates a file with a text.

    Args:
        uri: the URI of the file, which does not exist.
        text: the content of the new file.
    """
    start = types.Range(types.Position(0, 0), types.Position(0, 0))
    insertion = types.TextDocumentEdit(
        types.OptionalVersionedTextDocumentIdentifier(uri, None), [types.TextEdit(start, text)]
    )
    return types.WorkspaceEdit(document_changes=[types.CreateFile(uri), insertion])
