"""Run all measurements, or the named ones, such as ``xacro`` and ``dds``.

Usage: ``python -m benchmarks [--list] [--write] [NAME ...]``

With ``--list``, only their names and subjects are printed. With ``--write``, the figures are also written to
``docs/benchmarks.md`` and its Chinese version.
"""

from __future__ import annotations

import ast
import importlib
import platform
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks import report
from benchmarks.measure import Measured, show
from benchmarks.robots import has_corpus


def main() -> int:
    """Run the measurements in this process, one after another, and print a table for each."""
    folder = Path(__file__).parent
    known = sorted(path.stem.removeprefix("bench_") for path in folder.glob("bench_*.py"))
    names = [word for word in sys.argv[1:] if word not in ("--write", "--list")] or known
    unknown = sorted(set(names) - set(known))
    if unknown:
        print(f"no measurement called {', '.join(unknown)}; there are {', '.join(known)}", file=sys.stderr)
        return 2
    if "--list" in sys.argv:
        for name in names:
            docstring = ast.get_docstring(ast.parse((folder / f"bench_{name}.py").read_text(encoding="utf-8"))) or ""
            print(f"{name:12} {docstring.partition(chr(10))[0]}")
        return 0
    print(f"Python {platform.python_version()}, {platform.system()} {platform.machine()}")
    results: dict[str, Sequence[Measured]] = {}
    for name in names:
        print(f"\n== {name}")
        results[name] = importlib.import_module(f"benchmarks.bench_{name}").rows()
        show(results[name])
    if "--write" in sys.argv:
        for path in report.write(
            {name: rows for name, rows in results.items() if name in report.TITLES}, corpus=has_corpus()
        ):
            print(f"Written: {path}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
