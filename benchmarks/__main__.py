"""``python -m benchmarks [NAME ...]``: run all measurements, or those named (`xacro`, `urdf`, `graph`, ...)."""

from __future__ import annotations

import importlib
import platform
import sys
from pathlib import Path


def main() -> int:
    """Run them one after another, each in this process, each printing its table."""
    here = Path(__file__).parent
    known = sorted(path.stem.removeprefix("bench_") for path in here.glob("bench_*.py"))
    names = sys.argv[1:] or known
    unknown = sorted(set(names) - set(known))
    if unknown:
        print(f"no measurement called {', '.join(unknown)}; there are {', '.join(known)}", file=sys.stderr)
        return 2
    print(f"Python {platform.python_version()}, {platform.system()} {platform.machine()}")
    for name in names:
        print(f"\n== {name}")
        importlib.import_module(f"benchmarks.bench_{name}").main()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
