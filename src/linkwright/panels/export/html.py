"""Writes a robot as one HTML file that contains all scripts, styles, meshes and textures.

The page fetches no other files.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import html
import json
from pathlib import Path

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.page.files import without_secrets
from linkwright.page.protocol.message import encode
from linkwright.page.protocol.robot import RobotScene
from linkwright.page.server import PAGE_FOLDER
from linkwright.panels.export.snapshot import FileSet, Snapshot, find_mesh_addresses

_PROGRAM = f"Linkwright {__version__}"
_PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<meta name="generator" content="{program}">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<div id="app"></div>
<noscript>The robot is drawn with JavaScript and WebGL.</noscript>
<script type="application/json" id="recorded">{recorded}</script>
<script>{script}</script>
</body>
</html>
"""


def write_html(snapshot: Snapshot) -> bytes:
    """Return the HTML page of a snapshot.

    Raises:
        LinkwrightError: VIEW202, the page of this installation was not built.
    """
    return recording_to_json(snapshot).join(split_page(snapshot.name)).encode()


def split_page(title: str) -> tuple[str, str]:
    """Return the parts of the page before and after the recorded messages.

    With both, one program can show several snapshots.

    Args:
        title: the title of the page.

    Raises:
        LinkwrightError: VIEW202, the page of this installation was not built.
    """
    folder = PAGE_FOLDER / "export"
    try:
        script = _read_script(folder)
        style = (folder / "export.css").read_text(encoding="utf-8")
    except OSError:
        hint = phrase("run `make page` in a checkout of Linkwright")
        raise LinkwrightError(
            Diagnostic(
                "VIEW202",
                phrase("robots cannot be exported as HTML, because the page for exports was not built"),
                hint=hint,
            )
        ) from None
    script = script.replace("</script", "<\\/script").replace("<!--", "<\\!--")
    head_template, end_template = _PAGE.split("{recorded}")
    style = style.replace("</style", "<\\/style")
    head = head_template.format(
        policy=_make_security_policy(script), program=_PROGRAM, title=html.escape(title), style=style
    )
    return head, end_template.format(script=script)


def _read_script(folder: Path) -> str:
    compressed_script = folder / "export.js.gz"  # `npm run build` alone does not create this file.
    if compressed_script.is_file():
        return gzip.decompress(compressed_script.read_bytes()).decode()
    return (folder / "export.js").read_text(encoding="utf-8")


def _make_security_policy(script: str) -> str:
    """Return a content security policy that allows only this script and embedded content."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; img-src data: blob:; "
        "connect-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'"
    )


def recording_to_json(snapshot: Snapshot) -> str:
    """Return messages, binary frames and files for the page, as JSON to embed in HTML."""
    robots = [message for message in snapshot.messages if isinstance(message, RobotScene)]
    files = FileSet(snapshot.meshes).collect([*find_mesh_addresses(robots), *snapshot.marker_meshes])
    messages = ",".join(encode(message) for message in snapshot.messages)
    other_values = {
        "program": _PROGRAM,
        "display": snapshot.scene.display,
        "awaits_size": snapshot.awaits_size,
        "spacing": snapshot.spacing,
        "frames": [base64.b64encode(frame).decode() for frame in snapshot.frames],
        "files": {address: base64.b64encode(data).decode() for address, data in files.items()},
    }
    text = without_secrets(f'{{"messages":[{messages}],{json.dumps(other_values)[1:]}')
    return text.replace("<", "\\u003c")
