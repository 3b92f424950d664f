"""A description with required arguments: the page asks for them, and then shows the robot."""

from __future__ import annotations

import pytest

from tests.browser.conftest import until
from tests.hosting.test_argument_form import box_file as box_file  # a fixture

pytestmark = pytest.mark.browser


def test_argument_form_accepts_keyboard_choice_and_shows_robot(start_fresh, open_page, box_file):
    page = open_page(start_fresh("view", str(box_file)), wait=False)
    form = page.get_by_role("form", name="Arguments of the description")
    form.wait_for()
    model = form.get_by_label("model", exact=True)
    values = {model.input_value()}
    page.keyboard.press("ArrowDown")  # the choice has the focus
    values.add(model.input_value())
    assert values == {"small", "large"}
    model.fill("huge")
    page.keyboard.press("Enter")
    page.get_by_text("huge").first.wait_for()  # the error names the value, and the form is shown again
    form.get_by_label("model", exact=True).fill("large")
    page.keyboard.press("Enter")
    until(page, "lw.robot?.links === 1")
    form.wait_for(state="hidden")
