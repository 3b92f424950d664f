"""``python -m linkwright.nodes PACKAGE EXECUTABLE ARGUMENTS``: see `linkwright.nodes.process`."""

from __future__ import annotations

import sys

from linkwright.nodes.process import main

if len(sys.argv) < 3:
    print("usage: python -m linkwright.nodes PACKAGE EXECUTABLE [ARGUMENTS ...]", file=sys.stderr)
    sys.exit(2)
sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
