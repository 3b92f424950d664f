"""The lines of a review about names that a lifecycle node creates in another callback."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
SOURCE = """CallbackReturn Arm::on_configure(const State & state) {{
  p_ = create_publisher<std_msgs::msg::Bool>("ready", 10);
  {configure}
}}
CallbackReturn Arm::on_activate(const State &) {{
  {activate}
}}
void Arm::start() {{
  {start}
}}
"""
SERVICE = 's_ = create_service<std_srvs::srv::Trigger>("stop", f);'


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("activate", "configure", ["service 'stop': created in on_activate -> on_configure"]),
        ("configure", "activate", ["service 'stop': created in on_configure -> on_activate"]),
        ("start", "activate", []),
    ],
)
def test_a_service_that_moves_to_another_callback_is_told(repository, compare, old, new, expected):
    places = dict.fromkeys(("configure", "activate", "start"), "")
    repository.commit({**MANIFEST, "arm/a.cpp": SOURCE.format(**{**places, old: SERVICE})})
    repository.write({"arm/a.cpp": SOURCE.format(**{**places, new: SERVICE})})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert [line for line in lines if "created in" in line] == expected
