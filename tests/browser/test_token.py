"""The token of a page.

It is in the printed address, and then in the browser's storage for this host and port.
"""

from __future__ import annotations

import http.server
import threading
from urllib.parse import urlsplit

import pytest

from tests.browser.conftest import TIMEOUT_S, until, wait_until_equal
from tests.browser.live import configuration

pytestmark = pytest.mark.browser

GRID = configuration("- {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}")


@pytest.fixture
def viewer(start_viewer):
    return start_viewer(GRID)


@pytest.fixture
def context(browser):
    """Return a browser without any data."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, locale="en-US")
    context.set_default_timeout(1000 * TIMEOUT_S)
    yield context
    context.close()


@pytest.fixture
def other_server():
    """Run another server on this host, and record the requests of browsers."""
    requests = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            requests.append(str(self.headers))
            self.send_response(200)
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.HTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_address[1]}/", requests
    server.shutdown()
    server.server_close()
    thread.join()


def url_without_query(viewer) -> str:
    return viewer.url.partition("?")[0]


def wait_until_admitted(page) -> None:
    until(page, "lw.displays.length === 1")
    assert page.locator(".door").is_hidden()


def test_token_leaves_address_bar_and_is_shared_by_all_tabs(viewer, context):
    page = context.new_page()
    page.goto(viewer.url)
    wait_until_admitted(page)
    wait_until_equal(lambda: page.url, url_without_query(viewer))
    page.reload()
    wait_until_admitted(page)
    second = context.new_page()
    second.goto(page.url)
    wait_until_admitted(second)
    # The request for separate displays stays in the address, and nothing else does.
    second.get_by_role("group", name="Displays").get_by_text("Own").click()
    wait_until_equal(lambda: second.url, f"{url_without_query(viewer)}?displays=own")
    wait_until_admitted(second)
    # An outdated token in an address does not lock the browser out.
    second.goto(f"{url_without_query(viewer)}?token=of-an-earlier-run")
    wait_until_admitted(second)
    wait_until_equal(lambda: second.url, url_without_query(viewer))


def test_token_is_not_sent_to_other_server_on_same_host(viewer, context, other_server):
    url, requests = other_server
    page = context.new_page()
    page.goto(viewer.url)
    wait_until_admitted(page)
    page.goto(url)
    address = urlsplit(viewer.url)
    assert requests
    # The browser may also request an icon for that server's own page.
    for request in requests:
        for secret in ("cookie:", address.netloc, address.query.partition("=")[2].lower()):
            assert secret not in request.lower()
    assert context.cookies() == []
    assert page.evaluate("() => Object.keys(localStorage)") == []
    page.go_back()
    wait_until_admitted(page)


def test_browser_without_token_shows_form_that_accepts_it(viewer, context):
    page = context.new_page()
    page.goto(url_without_query(viewer))
    door = page.locator(".door")
    door.wait_for()
    assert "prints the address" in door.inner_text()
    assert f"{url_without_query(viewer)}?token=" in door.inner_text()
    field = page.get_by_label("Address or token")
    field.fill("hello")
    field.press("Enter")
    wait_until_equal(door.locator(".problem").inner_text, "This text contains no token.")
    field.fill(f"{url_without_query(viewer)}?token={'x' * 32}")
    field.press("Enter")
    door.get_by_text("This token is not valid", exact=False).wait_for()
    field.fill(viewer.url)
    page.get_by_role("button", name="Open", exact=True).click()
    door.wait_for(state="hidden")
    wait_until_admitted(page)
    assert page.url == url_without_query(viewer)
    assert page.evaluate("() => document.getElementById('app').inert") is False


def test_share_menu_copies_link(viewer, context):
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.goto(viewer.url)
    wait_until_admitted(page)
    page.get_by_role("button", name="Share", exact=True).click()
    page.get_by_role("menuitem", name="Copy link").click()
    page.get_by_text("Link copied").wait_for()
    assert page.evaluate("() => navigator.clipboard.readText()") == viewer.url
