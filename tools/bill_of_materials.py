"""Write the bill of materials of a release in CycloneDX: packages of Python and of npm.

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


def complete_bill(environment_bill: str) -> str:
    """Return the complete bill, given the bill of an environment with Linkwright.

    Raises:
        SystemExit: the bill does not contain Linkwright.
    """
    bill: dict[str, Any] = json.loads(environment_bill)
    components: list[dict[str, Any]] = bill["components"]
    linkwright_components = [component for component in components if component["name"] == "linkwright"]
    if not linkwright_components:
        raise SystemExit("the bill of materials is that of an environment without Linkwright")
    (root,) = linkwright_components
    for component in components:
        links = [link for link in component.pop("externalReferences", ()) if not link["url"].startswith(_LOCAL)]
        if links:
            component["externalReferences"] = links
    page_components = [
        _make_npm_component(name, package) for name, package in build_page.list_bundled_packages().items()
    ]
    other_components = [component for component in components if component is not root]
    bill["components"] = sorted([*other_components, *page_components], key=_get_reference)
    bill["metadata"]["component"] = {**root, "type": "application"}
    (root_dependency,) = [dependency for dependency in bill["dependencies"] if dependency["ref"] == root["bom-ref"]]
    root_dependency["dependsOn"] = sorted(
        {*root_dependency.get("dependsOn", ()), *map(_get_reference, page_components)}
    )
    bill["dependencies"] = sorted(
        [*bill["dependencies"], *({"ref": _get_reference(component)} for component in page_components)],
        key=_get_reference,
    )
    return json.dumps(bill, indent=2, ensure_ascii=False) + "\n"


def validate_bill(path: Path) -> list[str]:
    """Validate a bill with the schema of CycloneDX, and return the packages without a license.

    Raises:
        SystemExit: the bill does not match the schema.
    """
    from cyclonedx.schema import SchemaVersion  # only the environment of `make release` has it
    from cyclonedx.validation.json import JsonStrictValidator

    text = path.read_text(encoding="utf-8")
    bill = json.loads(text)
    version = SchemaVersion.from_version(bill["specVersion"])
    if schema_error := JsonStrictValidator(version).validate_str(text):
        raise SystemExit(f"{path} is not a CycloneDX {version.to_version()} bill of materials: {schema_error}")
    return [component["name"] for component in bill["components"] if not component.get("licenses")]


def _get_reference(component: dict[str, Any]) -> str:
    """Return the name of a component, or of a dependency of a component, in the bill."""
    return str(component.get("bom-ref") or component["ref"])


def _make_npm_component(name: str, package: dict[str, str]) -> dict[str, Any]:
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
