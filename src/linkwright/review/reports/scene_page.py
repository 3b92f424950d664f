"""Write the 3D scenes of a report into frames that are created when a user opens them.

The page contains the drawing program once, compressed. Each frame has an origin of its own (`sandbox`), and the
policy of an exported page: its program can fetch nothing.
"""

from __future__ import annotations

import gzip
from base64 import b64encode
from collections.abc import Sequence
from html import escape

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import localized
from linkwright.review.changes import RobotScene, Subject

SCENE_STYLE = """
.scene { margin: 8px 0 12px; } .scene summary { cursor: pointer; width: fit-content; }
.scene iframe { width: 100%; height: min(620px, 85vh); margin: 8px 0 0;
  border: 1px solid var(--line); border-radius: 6px; }
"""

SCENE_SCRIPT = """
const unpack = async (element) => {
  const bytes = Uint8Array.from(atob(element.textContent), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
};
for (const scene of document.querySelectorAll("details.scene")) {
  scene.addEventListener("toggle", async () => {
    if (!scene.open || scene.dataset.isDrawn) return;
    scene.dataset.isDrawn = "yes";
    const frame = document.createElement("iframe");
    frame.setAttribute("sandbox", "allow-scripts");
    frame.title = scene.querySelector("summary").textContent;
    const [start, end] = (await unpack(document.getElementById("viewer"))).split("\\0");
    frame.srcdoc = start + (await unpack(scene.querySelector("script"))) + end;
    scene.append(frame);
  });
}
"""

_MAX_BYTES = 40_000_000
"""The maximum size of all scenes of a page. Further scenes are left out."""


class Scenes:
    """The scenes of a page.

    Args:
        subjects: the subjects of the report.
    """

    def __init__(self, subjects: Sequence[Subject]) -> None:
        self._shown_scene_ids: set[int] = set()
        size = 0
        for subject in subjects:
            if subject.scene is not None and subject.scene.data and size + len(subject.scene.data) <= _MAX_BYTES:
                size += len(subject.scene.data)
                self._shown_scene_ids.add(id(subject.scene))

    @property
    def script(self) -> str:
        """The elements with the programs; empty if the page has no scene.

        Raises:
            LinkwrightError: VIEW202, the page of this installation was not built.
        """
        if not self._shown_scene_ids:
            return ""
        from linkwright.panels.export.html import split_page

        title = localized(phrase("both versions in 3D"))
        viewer = gzip.compress("\0".join(split_page(title)).encode(), mtime=0)
        return f"{_create_data_script(viewer, 'viewer')}<script>{SCENE_SCRIPT}</script>"

    def create_element(self, scene: RobotScene | None) -> str:
        """Return the element of a scene, or the reason why there is none.

        The result is empty if no scene was requested.
        """
        if scene is None:
            return ""
        if scene.reason is not None:
            return f"<p class='soft'>{_escape_text(scene.reason)}</p>"
        if id(scene) not in self._shown_scene_ids:
            reason = phrase(
                "the scene in 3D is left out: the scenes before it already have {size:.0f} MB", size=_MAX_BYTES / 1e6
            )
            return f"<p class='soft'>{_escape_text(reason)}</p>"
        title = _escape_text(phrase("both versions in 3D"))
        return f"<details class='scene'><summary>{title}</summary>{_create_data_script(scene.data)}</details>"


def _create_data_script(data: bytes, name: str = "") -> str:
    attribute = f" id='{name}'" if name else ""
    return f"<script type='application/gzip'{attribute}>{b64encode(data).decode()}</script>"


def _escape_text(text: Phrase) -> str:
    return escape(localized(text))
