"""``python -m linkwright.cli.tools NAME ARGUMENTS``: one of the commands of ROS 2."""

from __future__ import annotations

import sys

from linkwright.cli.tools.programs import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
