"""The lines of a review about conditions under which functions newly fail."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """void Arm::configure() {{
  getParam("rate", rate_);
  getParam("ids", ids_);
  {}
  start();
}}
"""
PYTHON = """class Arm:
    def configure(self):
        self.rate = self.get_parameter("rate").value
        {}
        self.start()
"""
THROW = 'throw std::runtime_error("rate");'
STOPS = "values of {} for which this holds stop the program"


def review_failures(repository, compare, path, old, new):
    """Return the lines about new failures with the reasons why they are breaking."""
    template = PYTHON if path.endswith(".py") else CPP
    repository.commit({**MANIFEST, path: template.format(old)})
    repository.write({path: template.format(new)})
    changes = [change for subject in compare(repository).subjects for change in subject.changes]
    lines = [(str(change.sentence), change.reason and str(change.reason)) for change in changes]
    return [(text, reason) for text, reason in lines if " now if " in text]


@pytest.mark.parametrize(
    ("old", "new", "condition", "reason"),
    [
        ("", f"if (rate_ < 0) {THROW}", "throws an error now if rate_ < 0", STOPS.format("'rate'")),
        (
            "",
            f"if (ids_.size() > rate_) {{ log(); {THROW} }}",
            "throws an error now if ids_.size() > rate_",
            STOPS.format("'ids', 'rate'"),
        ),
        ("", "if (rate_ < 0) exit(1);", "exits now if rate_ < 0", STOPS.format("'rate'")),
        ("", f"if (rate_ < count_) {THROW}", "throws an error now if rate_ < count_", None),
        ("", f"if (!isReady()) {THROW}", "throws an error now if !isReady()", None),
        ("if (rate_ < 0) { stop(); }", f"if (rate_ < 0) {{ stop(); }} if (!on_) {THROW}",
         "throws an error now if !on_", None),
        ("if (rate_ < 0) return;", f"if (rate_ < 0) {THROW}", None, None),
        (f"if (rate_ < 0) {THROW}", f"if (rate_ < 1) {THROW}", None, None),
        (f"if (rate_ < 0 || rate_ > 9) {THROW}", f"if (rates_[0] < 0 || rates_[0] > 9) {THROW}", None, None),
        ("", THROW, None, None),
        ("", 'if (rate_ < 0) ROS_WARN("rate");', None, None),
        ("", "if (rate_ < 0) { /* throw an error */ }", None, None),
    ],
)  # fmt: skip
def test_new_failure_in_cpp(repository, compare, old, new, condition, reason):
    found = review_failures(repository, compare, "arm/src/arm.cpp", old, new)
    assert found == ([(f"'Arm::configure()' {condition}", reason)] if condition else [])


@pytest.mark.parametrize(
    ("new", "condition", "reason"),
    [
        ("if self.rate < 0: raise ValueError('rate')", "throws an error now if self.rate < 0", STOPS.format("'rate'")),
        ("if not self.is_ready(): sys.exit(1)", "exits now if not self.is_ready()", None),
        ("if self.rate < 0: self.warn('raise the rate')", None, None),
    ],
)
def test_new_failure_in_python(repository, compare, new, condition, reason):
    found = review_failures(repository, compare, "arm/arm/arm.py", "pass", new)
    assert found == ([(f"'Arm.configure()' {condition}", reason)] if condition else [])


def test_a_new_function_that_fails_is_no_new_failure(repository, compare):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": CPP.format("")})
    repository.write({"arm/src/arm.cpp": CPP.format("") + f"void Arm::check() {{ if (rate_ < 0) {THROW} }}\n"})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert not any(" now if " in line for line in lines)


MAIN = """int main(int argc, char ** argv) {{
  start(argc, argv);
  {}
  return 0;
}}
"""
OTHER_ARGUMENTS = "callers that pass other arguments get an error"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", "if (argc < 3) return -1;", [("'main()' exits now if argc < 3", OTHER_ARGUMENTS)]),
        ("open(argv[2]);", "if (argc < 3) return -1; open(argv[2]);", [("'main()' exits now if argc < 3", None)]),
        ("", "if (!open()) { log(); return EXIT_FAILURE; }", [("'main()' exits now if !open()", None)]),
        ("", "if (stop()) return 0;", []),
        ("if (argc < 3) return -1;", "if (argc < 4) return -1;", []),
    ],
)
def test_a_result_of_main_that_is_an_error_ends_the_program(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/main.cpp": MAIN.format(old)})
    repository.write({"arm/src/main.cpp": MAIN.format(new)})
    changes = [change for subject in compare(repository).subjects for change in subject.changes]
    lines = [(str(change.sentence), change.reason and str(change.reason)) for change in changes]
    assert [line for line in lines if " now if " in line[0]] == expected
