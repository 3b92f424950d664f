"""What a release is made of, as CycloneDX has it: Python packages by cyclonedx-py, and those of npm in the page.

`cyclonedx-py` lists the environment in which everything of a release is installed; this adds what the page brings
along, which its lock file tells, and takes out what is only about the machine that it was made on.
"""

from __future__ import annotations

import base64
import json
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

import build_page

_LOCAL = "file:"


def complete(listed: str) -> str:
    """The whole bill, from that of an environment in which Linkwright is installed.

    Raises:
        SystemExit: when Linkwright is not in it.
    """
    bill: dict[str, Any] = json.loads(listed)
    components: list[dict[str, Any]] = bill["components"]
    ours = [component for component in components if component["name"] == "linkwright"]
    if not ours:
        raise SystemExit("the bill of materials is that of an environment without Linkwright")
    (root,) = ours
    for component in components:
        links = [link for link in component.pop("externalReferences", ()) if not link["url"].startswith(_LOCAL)]
        if links:
            component["externalReferences"] = links
    page = [_npm_component(name, package) for name, package in build_page.bundled().items()]
    others = [component for component in components if component is not root]
    bill["components"] = sorted([*others, *page], key=_reference)
    bill["metadata"]["component"] = {**root, "type": "application"}
    (depending,) = [each for each in bill["dependencies"] if each["ref"] == root["bom-ref"]]
    depending["dependsOn"] = sorted({*depending.get("dependsOn", ()), *map(_reference, page)})
    bill["dependencies"] = sorted(
        [*bill["dependencies"], *({"ref": _reference(each)} for each in page)], key=_reference
    )
    return json.dumps(bill, indent=2, ensure_ascii=False) + "\n"


def check(path: Path) -> list[str]:
    """Hold a bill against the schema of CycloneDX; which packages say nothing about their license.

    Raises:
        SystemExit: when it does not fit.
    """
    from cyclonedx.schema import SchemaVersion  # only the environment of `make release` has it
    from cyclonedx.validation.json import JsonStrictValidator

    text = path.read_text(encoding="utf-8")
    bill = json.loads(text)
    version = SchemaVersion.from_version(bill["specVersion"])
    if wrong := JsonStrictValidator(version).validate_str(text):
        raise SystemExit(f"{path} is no bill of CycloneDX {version.to_version()}: {wrong}")
    return [component["name"] for component in bill["components"] if not component.get("licenses")]


def _reference(each: dict[str, Any]) -> str:
    """The name that a component, or what one depends on, has in the bill."""
    return str(each.get("bom-ref") or each["ref"])


def _npm_component(name: str, package: dict[str, str]) -> dict[str, Any]:
    algorithm, _, digest = package["integrity"].partition("-")
    return {
        "bom-ref": f"npm-{name}=={package['version']}",
        "type": "library",
        "name": name,
        "version": package["version"],
        "description": "bundled in the page",
        "hashes": [{"alg": algorithm.upper().replace("SHA", "SHA-"), "content": base64.b64decode(digest).hex()}],
        "licenses": [{"license": {"id": package["license"], "acknowledgement": "declared"}}],  # codespell:ignore
        "purl": f"pkg:npm/{name.replace('@', '%40')}@{package['version']}",
    }
