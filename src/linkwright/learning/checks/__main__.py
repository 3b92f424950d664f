"""The program that runs the checks of a step (see `linkwright.learning.checks.running.check_command`)."""

import sys

from linkwright.learning.checks.running import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
