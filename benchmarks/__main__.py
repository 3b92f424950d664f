"""``python -m benchmarks [--write] [NAME ...]``: run all measurements, or those named (`xacro`, `urdf`, `graph`, ...).

With ``--write`` the figures go to ``docs/benchmarks.md`` and its Chinese sister too.
"""

from __future__ import annotations

import importlib
import io
import platform
import sys
from contextlib import redirect_stdout
from pathlib import Path

from benchmarks import report
from benchmarks.measure import show
from benchmarks.robots import has_corpus


def main() -> int:
    """Run them one after another, each in this process, each printing its table."""
    here = Path(__file__).parent
    known = sorted(path.stem.removeprefix("bench_") for path in here.glob("bench_*.py"))
    names = [word for word in sys.argv[1:] if word != "--write"] or known
    unknown = sorted(set(names) - set(known))
    if unknown:
        print(f"no measurement called {', '.join(unknown)}; there are {', '.join(known)}", file=sys.stderr)
        return 2
    print(f"Python {platform.python_version()}, {platform.system()} {platform.machine()}")
    for name in names:
        print(f"\n== {name}")
        _run(name, keep="--write" in sys.argv)
    if "--write" in sys.argv:
        for path in report.write():
            print(f"Written: {path}")
    return 0


def _run(name: str, *, keep: bool) -> None:
    bench = importlib.import_module(f"benchmarks.bench_{name}")
    if hasattr(bench, "rows"):
        rows = bench.rows()
        show(rows)
        if keep:
            report.keep(name, rows, corpus=has_corpus())
        return
    printed = io.StringIO()
    with redirect_stdout(printed if keep else sys.stdout):
        bench.main()
    if keep:
        print(printed.getvalue(), end="")
        report.keep(name, printed.getvalue(), corpus=has_corpus())


if __name__ == "__main__":
    raise SystemExit(main())
