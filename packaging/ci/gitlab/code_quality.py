"""Write the breaking changes and findings of a review in SARIF as a report on code quality for GitLab.

    code_quality.py report.sarif code-quality.json

Source: GitLab's documentation, "Code Quality report format". A result without a line, such as a removed joint, is left
out, because GitLab needs a place; the comment names it.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import unquote

_SEVERITIES = {"error": "major", "warning": "minor"}
"""The severities for levels of SARIF; others are ``info``."""


def entries(sarif: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the entries of the report. An entry keeps its fingerprint when lines above it change."""
    counts: Counter[tuple[str, ...]] = Counter()
    for result in sarif["runs"][0]["results"]:
        for location in result.get("locations", ()):
            place = location["physicalLocation"]
            path, line = unquote(place["artifactLocation"]["uri"]), place["region"]["startLine"]
            key = (result["ruleId"], path, result["message"]["text"])
            counts[key] += 1
            yield {
                "description": result["message"]["text"],
                "check_name": result["ruleId"],
                "fingerprint": hashlib.sha256(json.dumps([*key, counts[key]]).encode()).hexdigest(),
                "severity": _SEVERITIES.get(result.get("level", "warning"), "info"),
                "location": {"path": path, "lines": {"begin": line}},
            }


if __name__ == "__main__":
    source, target = map(Path, sys.argv[1:])
    report = list(entries(json.loads(source.read_text(encoding="utf-8"))))
    target.write_text(json.dumps(report, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
