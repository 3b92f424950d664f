"""What the Python module ``xacro`` offers to launch files: a model expanded by a function call."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from linkwright.launch.engine.descriptions import Descriptions, XacroCall, current_descriptions
from linkwright.workspace import current_finder


class XacroDocument:
    """A model file, and what it expands to.

    The texts it gives are those that live reload and source positions are kept for.

    Args:
        path: the model file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._text: str | None = None

    def expand(self, mappings: Mapping[str, Any] | None) -> None:
        """Expand it.

        Raises:
            DescriptionError: what is wrong with the model.
        """
        arguments = tuple((name, str(value)) for name, value in (mappings or {}).items())
        descriptions = current_descriptions() or Descriptions(current_finder())
        self._text = descriptions.expand(XacroCall(self._path, arguments))

    def toxml(self, *_: Any, **__: Any) -> str:
        """The text: expanded, or that of the file as long as it is not."""
        return self._path.read_text(encoding="utf-8") if self._text is None else self._text

    def toprettyxml(self, *_: Any, **__: Any) -> str:
        """The same; the text is indented by two blanks whatever is asked for."""
        return self.toxml()


def process_file(input_file_name: str | Path, *, mappings: Mapping[str, Any] | None = None, **_: Any) -> XacroDocument:
    """Expand a model file.

    Args:
        input_file_name: the file.
        mappings: name -> value of the xacro arguments.

    Raises:
        DescriptionError: what is wrong with the model.
    """
    document = parse(input_file_name)
    document.expand(mappings)
    return document


def process(input_file_name: str | Path, *, mappings: Mapping[str, Any] | None = None, **_: Any) -> str:
    """The text that a model file expands to; see `process_file`."""
    return process_file(input_file_name, mappings=mappings).toxml()


def parse(inp: Any, filename: str | Path | None = None) -> XacroDocument:
    """A model file, to be expanded by `process_doc`.

    Args:
        inp: the file, open or by its path.
        filename: its path, if `inp` does not know it.

    Raises:
        TypeError: no path can be told from it.
    """
    if filename is None:
        filename = inp if isinstance(inp, (str, Path)) else getattr(inp, "name", None)
    if not isinstance(filename, (str, Path)):
        raise TypeError(f"expected a file or its path, got {inp!r} of type {type(inp).__name__}")
    return XacroDocument(Path.cwd() / filename)


def process_doc(doc: XacroDocument, *, mappings: Mapping[str, Any] | None = None, **_: Any) -> None:
    """Expand what `parse` gave, in place.

    Raises:
        DescriptionError: what is wrong with the model.
    """
    doc.expand(mappings)
