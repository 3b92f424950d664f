"""Write the bill of materials of a release in the format of CycloneDX: packages of Python and of npm.

`cyclonedx-py` lists the environment in which a release is installed. This program adds the npm packages in the page,
from its lock file, and removes the details of the machine.
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
    """Return the complete bill, given the bill of an environment in which Linkwright is installed.

    Raises:
        SystemExit: the bill does not contain Linkwright.
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
    (depending,) = [entry for entry in bill["dependencies"] if entry["ref"] == root["bom-ref"]]
    depending["dependsOn"] = sorted({*depending.get("dependsOn", ()), *map(_reference, page)})
    bill["dependencies"] = sorted(
        [*bill["dependencies"], *({"ref": _reference(entry)} for entry in page)], key=_reference
    )
    return json.dumps(bill, indent=2, ensure_ascii=False) + "\n"


def check(path: Path) -> list[str]:
    """Validate a bill with the schema of CycloneDX, and return the packages without a license.

    Raises:
        SystemExit: the bill does not match the schema.
    """
    from cyclonedx.schema import SchemaVersion  # only the environment of `make release` has it
    from cyclonedx.validation.json import JsonStrictValidator

    text = path.read_text(encoding="utf-8")
    bill = json.loads(text)
    version = SchemaVersion.from_version(bill["specVersion"])
    if wrong := JsonStrictValidator(version).validate_str(text):
        raise SystemExit(f"{path} is no bill of CycloneDX {version.to_version()}: {wrong}")
    return [component["name"] for component in bill["components"] if not component.get("licenses")]


def _reference(entry: dict[str, Any]) -> str:
    """Return the name of a component, or of a dependency of a component, in the bill."""
    return str(entry.get("bom-ref") or entry["ref"])


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
