"""Entry point of ``python -m linkwright.node_program PACKAGE EXECUTABLE ARGUMENTS``.

See `linkwright.nodes.process`. This module is outside the package of the nodes, so that Ctrl-C ends it quietly while
that package is being loaded.
"""

import sys

from linkwright.process.interruption import end_on_interrupt

if __name__ == "__main__":
    end_on_interrupt()
    if len(sys.argv) < 3:
        print("usage: python -m linkwright.node_program PACKAGE EXECUTABLE [ARGUMENTS ...]", file=sys.stderr)
        sys.exit(2)
    from linkwright.nodes.process import main

    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
