"""The ROS domains of tests."""

from __future__ import annotations

import subprocess
import sys

from tests.domains import own_domain

LOCKING = "import sys; from linkwright.learning.checks.domains import lock_domain; print(lock_domain(int(sys.argv[1])))"


def test_check_of_a_lesson_does_not_get_the_domain_of_a_test():
    words = [sys.executable, "-c", LOCKING, str(own_domain())]
    assert subprocess.run(words, capture_output=True, text=True, check=True).stdout == "False\n"
