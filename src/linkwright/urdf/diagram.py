"""Render Graphviz text as an image."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    did_you_mean,
    display_path,
    foreign,
    joined,
    missing_extra,
    phrase,
)
from linkwright.files.whole_files import write_whole_file

IMAGE_SUFFIXES = (".pdf", ".svg", ".png")


def render(dot_text: str, path: str | Path) -> None:
    """Render Graphviz text with dot to an image file.

    The extension of the file selects PDF, SVG or PNG.

    Raises:
        LinkwrightError: URDF201 for another extension, URDF202 if pygraphviz is not usable, or URDF203 if Graphviz
            fails or the file cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in IMAGE_SUFFIXES:
        hint = did_you_mean(suffix, IMAGE_SUFFIXES) or phrase("choose from {names}", names=joined(IMAGE_SUFFIXES))
        raise LinkwrightError(
            Diagnostic(
                "URDF201", phrase("cannot write an image of type '{ending}'", ending=suffix or path.name), hint=hint
            )
        )
    try:
        from pygraphviz import AGraph  # type: ignore[import-untyped]  # it ships no types
    except ModuleNotFoundError as error:
        raise missing_extra("URDF202", error) from None
    except ImportError as error:
        hint = phrase("install pygraphviz 2.0 or newer, whose wheels include Graphviz")
        raise LinkwrightError(
            Diagnostic("URDF202", phrase("Graphviz is not available: {error}", error=foreign(error)), hint=hint)
        ) from error
    try:
        graph = AGraph(string=dot_text)
        for node in graph.nodes_iter():
            # The dot command shows the name of a node without a label, but the Graphviz library would show nothing.
            if not node.attr["label"]:
                node.attr["label"] = r"\N"
        diagram = graph.draw(format=suffix[1:], prog="dot")
        write_whole_file(path, diagram)
    except OSError as error:
        raise LinkwrightError(
            Diagnostic(
                "URDF203",
                phrase(
                    "cannot write '{path}': {reason}",
                    path=display_path(path),
                    reason=foreign(error.strerror or error),
                ),
            )
        ) from error
    except Exception as error:
        raise LinkwrightError(
            Diagnostic("URDF203", phrase("Graphviz could not draw the diagram: {error}", error=foreign(error)))
        ) from error
