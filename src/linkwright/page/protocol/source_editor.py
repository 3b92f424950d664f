"""The editor of source files: files of the workspace, and messages of the language server.

Paths are absolute. Texts have the line end LF, regardless of the line ends in the file.
"""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.page.protocol.description import DiagnosticItem
from linkwright.page.protocol.message import PageMessage, ServerMessage


class OpenEditor(PageMessage):
    """A request to edit the workspace that contains a file of a description or of a finding."""

    file: str


class EditorOpened(ServerMessage):
    """The workspace that the page may edit. Response to `OpenEditor`.

    `folder` is its folder, and `uri` the folder's URI for the language server. `refusal_reason` is the reason why no
    file can be edited, or empty.
    """

    folder: str
    uri: str
    refusal_reason: str


class RequestSourceFile(PageMessage):
    """A request for a file, and for its changes from now on."""

    path: str


class CloseSourceFile(PageMessage):
    """A notice that the page no longer needs the changes to a file."""

    path: str


class SourceFile(ServerMessage):
    """A file on the disk.

    It is sent as the response to `RequestSourceFile`, and again when another program changes the file.

    `version` counts the contents that were sent to the page. `text` is None if the file cannot be read.
    `refusal_reason` is the reason why the file cannot be read or must not be written, or empty. `is_new` is True if the
    file does not exist yet; `WriteSourceFile` then creates it.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("path",)

    path: str
    uri: str
    version: int
    text: str | None
    refusal_reason: str
    is_new: bool


class WriteSourceFile(PageMessage):
    """A request to write a file, unless the file has changed since this `version` was sent."""

    number: int
    path: str
    version: int
    text: str


class ShowUnsavedText(PageMessage):
    """A request to show the page's descriptions with the unsaved text of an edited file.

    `number` increases with each text of the page. `text` is None to use the file on the disk again.
    """

    number: int
    path: str
    text: str | None


class UnsavedTextShown(ServerMessage):
    """The result of `ShowUnsavedText` with this number.

    `outcome` is ``shown``, ``errors`` if the last robot without errors stays, or ``elsewhere`` if no shown description
    contains the file and follows unsaved texts.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    path: str
    outcome: Literal["shown", "errors", "elsewhere"]


class UnsavedTextEdited(ServerMessage):
    """The new text of a file after an edit in the scene, for the page that has the file open.

    `base` is the `ShowUnsavedText.number` of the text that was edited, or 0 for the text on the disk. `text` is the
    complete new text, with LF line ends.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("path", "base")

    path: str
    base: int
    text: str


class CreateSourceFile(PageMessage):
    """A request to create an empty file, together with the folders above it."""

    number: int
    path: str


class SourceFileWritten(ServerMessage):
    """The result of `WriteSourceFile` or `CreateSourceFile` with this number.

    `version` is the new version of the file. `refusal` is the reason why the file was not written, or None.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    path: str
    version: int
    refusal: DiagnosticItem | None


class RequestSourceFolder(PageMessage):
    """A request for the names in a folder of the workspace."""

    path: str


class SourceFolder(ServerMessage):
    """The names of the subfolders and text files in a folder. Response to `RequestSourceFolder`."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("path",)

    path: str
    folders: list[str]
    files: list[str]


class LanguageServerInput(PageMessage):
    """A message of the Language Server Protocol to the page's language server, as JSON."""

    content: str


class LanguageServerOutput(ServerMessage):
    """A message of the Language Server Protocol from the page's language server, as JSON.

    `number` counts the messages. No message replaces another.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    content: str


class LanguageServerEnded(ServerMessage):
    """A notice that the page's language server ended unexpectedly.

    The next `OpenEditor` starts another one.
    """
