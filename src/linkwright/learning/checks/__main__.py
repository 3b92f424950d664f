"""The program that runs the checks of a step.

See `linkwright.learning.checks.check_process.make_check_command`.
"""

import sys

from linkwright.learning.checks.check_process import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
