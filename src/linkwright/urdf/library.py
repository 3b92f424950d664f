"""Descriptions by path or text: loading one, and sharing one between everything that reads the same text."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Union

from linkwright.diagnostics import LinkwrightError
from linkwright.urdf.model import Robot
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.urdf.reader import Reading, read
from linkwright.xmltree import Document, Element
from linkwright.xmltree.collection import seldom_collected
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright.workspace import PackageFinder
    from linkwright.xacro.story import Story

Packages = Union[Mapping[str, str | Path], "PackageFinder", None]

Teller = Callable[[Element], "Story"]

TEXT_NAME = "<robot_description>"
_KEPT_TEXTS = 32


def load(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
) -> Robot:
    """The robot of a URDF or xacro file or text.

    A link part that urdfdom would drop with an error message is dropped here too, silently; `examine` tells.

    Args:
        path_or_text: a path, or a text, which is known by its ``<``.
        arguments: values for the file's ``<xacro:arg>``.
        packages: for ``$(find)``: package name -> share folder, or a finder.

    Raises:
        LinkwrightError: it cannot be read or expanded, or urdfdom would refuse the model; with all findings.
    """
    with seldom_collected():
        reading = examine(path_or_text, arguments=arguments, packages=packages)
    if reading.robot is None:
        raise LinkwrightError(*reading.diagnostics)
    return reading.robot


def examine(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
) -> Reading:
    """The robot of a URDF or xacro file or text with all findings about it; arguments as for `load`.

    A file is expanded when it is xacro: it declares the ``xacro`` prefix or has the ending ``.xacro``. A plain URDF
    file is read as urdfdom reads it.

    Raises:
        LinkwrightError: it is not XML, or it cannot be expanded.
    """
    is_text = isinstance(path_or_text, str) and "<" in path_or_text
    name = TEXT_NAME if is_text else str(path_or_text)
    document = parse_as_urdfdom(str(path_or_text) if is_text else read_bytes(path_or_text), name)
    if not (arguments or name.endswith(".xacro") or _is_xacro(document.root)):
        return read(document)
    from linkwright.xacro import expand

    text = document.source.text if is_text and document.source else None
    expansion = expand(name, arguments, packages=packages, text=text)
    reading = read(expansion.document)
    return Reading(reading.robot, (*expansion.diagnostics, *reading.diagnostics))


class DescriptionLibrary:
    """The readings of the description texts that are about, so that each text is read once.

    The launcher remembers the document a text was expanded to; the nodes and the viewer, which get the bare text from
    a parameter or topic, then know where everything was written.
    """

    def __init__(self) -> None:
        self._readings: OrderedDict[str, Reading] = OrderedDict()
        self._tellers: dict[str, Teller] = {}
        self._files: dict[str, tuple[Path, ...]] = {}

    def remember(self, text: str, document: Document, tell: Teller | None = None, files: Iterable[Path] = ()) -> None:
        """Say that a description text is a document's, whose elements know where they were written.

        Args:
            text: the description.
            document: what it is the text of.
            tell: what tells the story of an element of the document (`linkwright.xacro.Expansion.story`).
            files: what the document was made from, the main file first.
        """
        self._keep(text, read(document))
        self._files[text] = tuple(files)
        if tell is not None:
            self._tellers[text] = tell

    def files(self, text: str) -> tuple[Path, ...]:
        """What a remembered description was made from, the main file first; empty where nobody said so."""
        return self._files.get(text, ())

    def story(self, text: str, element: Element) -> Story | None:
        """How an element of a remembered description came to be; None for a text that nobody tells about.

        Raises:
            LinkwrightError: XAC802, its files are no longer what they were.
        """
        tell = self._tellers.get(text)
        return None if tell is None else tell(element)

    def read(self, text: str) -> Reading:
        """The reading of a description text; one that is not XML has no robot and says why."""
        reading = self._readings.get(text)
        if reading is not None:
            self._readings.move_to_end(text)
            return reading
        try:
            reading = read(parse_as_urdfdom(text, TEXT_NAME))
        except LinkwrightError as error:
            reading = Reading(None, error.diagnostics)
        self._keep(text, reading)
        return reading

    def _keep(self, text: str, reading: Reading) -> None:
        self._readings[text] = reading
        self._readings.move_to_end(text)
        if len(self._readings) > _KEPT_TEXTS:
            forgotten, _ = self._readings.popitem(last=False)
            self._tellers.pop(forgotten, None)
            self._files.pop(forgotten, None)


def _is_xacro(root: Element) -> bool:
    return "xmlns:xacro" in root.attributes or root.tag.startswith("xacro:")
