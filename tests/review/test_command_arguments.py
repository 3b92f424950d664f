"""The lines of a review about arguments of the command line that Python programs read by their indexes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PATH = "arm/scripts/arm.py"
PROGRAM = """import sys
import rclpy

AT_MODULE


def main():
    rclpy.init(args=sys.argv)
    IN_MAIN
    node = rclpy.create_node("arm")


if __name__ == "__main__":
    main()
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (("", "pass"), ("host = sys.argv[1]", "pass"),
         "reads argument 1 of the command line now: `host = sys.argv[1]`"),
        (("", "pass"), ("", "port = int(sys.argv[2])"),
         "reads argument 2 of the command line now: `port = int(sys.argv[2])`"),
        (("host = sys.argv[1]", "pass"), ("host = sys.argv[1]", "connect(sys.argv[2])"),
         "reads argument 2 of the command line now: `connect(sys.argv[2])`"),
        (("host = sys.argv[2]", "pass"), ("host = sys.argv[1]", "pass"), None),
        (("", "pass"), ("name = sys.argv[0]", "pass"), None),
        (("", "pass"), ("host = sys.argv[1] if len(sys.argv) > 1 else ''", "pass"), None),
        (("", "pass"), ("if len(sys.argv) < 2: sys.exit(1)", "host = sys.argv[1]"), None),
        (("host = read(sys.argv)", "pass"), ("host = sys.argv[1]", "pass"), None),
        (("", "pass"), ("def f(): return sys.argv[1]", "pass"), None),
    ],
)  # fmt: skip
def test_argument_without_which_a_program_fails_is_told(repository, compare, old, new, expected):
    old_text, new_text = (
        PROGRAM.replace("AT_MODULE", at_module).replace("IN_MAIN", in_main) for at_module, in_main in (old, new)
    )
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old_text})
    repository.write({PATH: new_text})
    assert [line for line in breaking(compare(repository)) if "argument " in line] == ([expected] if expected else [])
