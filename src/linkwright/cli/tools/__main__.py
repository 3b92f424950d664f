"""``python -m linkwright.cli.tools NAME ARGUMENTS``: runs one of the commands of ROS 2."""

from __future__ import annotations

import sys

from linkwright.process.interruption import end_on_interrupt

if __name__ == "__main__":
    end_on_interrupt()
    from linkwright.cli.tools.programs import main

    sys.exit(main(sys.argv[1], sys.argv[2:]))
